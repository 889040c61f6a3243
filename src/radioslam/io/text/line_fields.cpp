#include "radioslam/io/text/line_fields.hpp"

#include <cmath>

#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr double kSmallestQuaternionNorm = 1e-6;
/// Largest deviation of the norm from 1 in a last line without line end, whose last number is probably
/// truncated.
constexpr double kTornQuaternionTolerance = 0.01;
constexpr std::size_t kShownCharacters = 40;

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// A field as shown in a message: shortened, without line breaks.
std::string shown(std::string_view field) {
  std::string s(field.substr(0, kShownCharacters));
  for (char& c : s)
    if (c == '\r') c = ' ';
  while (s.size() == kShownCharacters && !s.empty() && (static_cast<unsigned char>(s.back()) & 0x80) != 0)
    s.pop_back();
  return "'" + s + (field.size() > kShownCharacters ? "...'" : "'");
}

[[noreturn]] void fail_field(const TextLines& at, std::string_view what, std::string_view field,
                             const std::string& reason,
                             InputError::Kind kind = InputError::Kind::kUnreadable) {
  at.fail(std::string(what) + " " + shown(field) + " " + reason, kind);
}

double quaternion_norm(const Eigen::Vector4d& xyzw) {
  return std::hypot(std::hypot(xyzw.x(), xyzw.y()), std::hypot(xyzw.z(), xyzw.w()));
}

}  // namespace

double number_in(const TextLines& at, std::string_view field, std::string_view what, InputError::Kind kind) {
  const auto value = parse_number(field);
  if (!value) fail_field(at, what, field, "is not a finite number", kind);
  return *value;
}

double coordinate_in(const TextLines& at, std::string_view field, std::string_view what,
                     InputError::Kind kind) {
  const double value = number_in(at, field, what, kind);
  if (std::abs(value) > kMaxCoordinate_m)
    fail_field(at, what, field, "is not a plausible coordinate (more than 1e8 m)", InputError::Kind::kUnit);
  return value;
}

Stamp stamp_in(const TextLines& at, std::string_view field, std::string_view what) {
  const auto value = parse_stamp(field);
  if (!value) fail_field(at, what, field, "is not a time in seconds");
  return *value;
}

double sigma_in(const TextLines& at, std::string_view field, std::string_view what) {
  const double value = number_in(at, field, what);
  if (value < 0) fail_field(at, what, field, "is negative");
  return value;
}

std::string not_a_unit_quaternion(double norm) {
  return "the quaternion's norm is " + format_number(norm) + " instead of 1";
}

Eigen::Quaterniond quaternion_in(const TextLines& at, const Eigen::Vector4d& xyzw, double norm_tolerance) {
  constexpr auto kKind = InputError::Kind::kColumnOrder;
  const double norm = quaternion_norm(xyzw);
  if (norm < kSmallestQuaternionNorm) at.fail("the quaternion is zero", kKind);
  if (!std::isfinite(norm)) at.fail("the quaternion is too large to be normalised", kKind);
  if (std::abs(norm - 1) > norm_tolerance) at.fail(not_a_unit_quaternion(norm), kKind);
  return {xyzw.w() / norm, xyzw.x() / norm, xyzw.y() / norm, xyzw.z() / norm};
}

void LineFields::skip_blanks() {
  std::size_t i = 0;
  while (i < rest_.size() && is_blank(rest_[i])) ++i;
  rest_.remove_prefix(i);
}

std::string_view LineFields::next(std::string_view what) {
  if (rest_.empty()) {
    const std::string torn = at_->terminated() ? "" : " (the file ends in this line)";
    fail("the line ends before " + std::string(what) + torn);
  }
  std::size_t end = 0;
  while (end < rest_.size() && !is_blank(rest_[end])) ++end;
  const std::string_view field = rest_.substr(0, end);
  rest_.remove_prefix(end);
  skip_blanks();
  return field;
}

std::uint64_t LineFields::id(std::string_view what) {
  const std::string_view field = next(what);
  const auto value = parse_id(field);
  if (!value) fail_field(*at_, what, field, "is not a whole number from 0 to 2^64 - 1");
  return *value;
}

Eigen::Vector3d LineFields::position() {
  const double x = coordinate("x");
  const double y = coordinate("y");
  const double z = coordinate("z");
  return {x, y, z};
}

Eigen::Quaterniond LineFields::normalised_quaternion(double norm_tolerance) {
  const double x = number("qx");
  const double y = number("qy");
  const double z = number("qz");
  const double w = number("qw");
  const double norm = quaternion_norm({x, y, z, w});
  const bool may_be_torn = !at_->terminated() && empty() && norm >= kSmallestQuaternionNorm;
  if (may_be_torn && std::abs(norm - 1) > kTornQuaternionTolerance)
    fail("the line is truncated: the file ends in it, and its quaternion is not of unit length",
         InputError::Kind::kColumnOrder);
  return quaternion_in(*at_, {x, y, z, w}, norm_tolerance);
}

SE3 LineFields::pose() {
  const Eigen::Vector3d p = position();
  return {p, quaternion()};
}

void LineFields::end() const {
  if (!rest_.empty()) fail("too many fields: unexpected " + shown(rest_));
}

}  // namespace radioslam
