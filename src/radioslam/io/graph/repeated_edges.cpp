#include "radioslam/io/graph/repeated_edges.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// Bound on the difference of two copies of an edge, which are rounded to typically six digits and whose
/// quaternions are normalised on reading.
constexpr double kRounding = 2e-5;
/// The same for matrices of information of four digits, and for those carried over to the other end.
constexpr double kInformationRounding = 1e-3, kCarriedRounding = 1e-2;
constexpr int kFewestDigits = 4;

/// A decimal number d.ddd * 10^exponent.
struct Decimal {
  int digits = 1, exponent = 0;
  int decimals() const { return digits - 1 - exponent; }
};

Decimal shortest_decimal(double value) {
  std::array<char, 32> text;
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), std::abs(value), std::chars_format::scientific)
          .ptr;
  const std::string_view all(text.data(), static_cast<std::size_t>(end - text.data()));
  const std::size_t e = all.find('e');
  Decimal decimal{e < 2 ? 1 : static_cast<int>(e) - 1, 0};
  const char* exponent = text.data() + e + (all[e + 1] == '+' ? 2 : 1);
  std::from_chars(exponent, end, decimal.exponent);
  return decimal;
}

/// Numbers of a measurement as they were printed; those of a quaternion are not as they were.
std::vector<double> printed_numbers(const SE2& pose) {
  return {pose.translation().x(), pose.translation().y(), pose.angle()};
}
std::vector<double> printed_numbers(const SE3& pose) {
  return {pose.translation().x(), pose.translation().y(), pose.translation().z()};
}

/// Largest error by rounding: of a component in m, and of the angle in rad.
struct PrintedError {
  double m = 0, rad = 0;
  auto operator<=>(const PrintedError&) const = default;
};

/// Programs print so many significant digits, or so many decimals.
template <class Pose>
PrintedError printed_error(const Pose& pose) {
  int digits = kFewestDigits, decimals = 0, largest = 0;
  for (const double value : printed_numbers(pose)) {
    if (value == 0) continue;
    const Decimal decimal = shortest_decimal(value);
    digits = std::max(digits, decimal.digits);
    decimals = std::max(decimals, decimal.decimals());
    largest = std::max(largest, decimal.exponent);
  }
  const auto error = [&](int exponent) {
    const int printed = std::min(decimals, digits - 1 - exponent);
    return 0.5 * std::pow(10.0, -std::max(printed, kFewestDigits - 1 - exponent));
  };
  constexpr int kTenths = -1;  // the exponent of a quaternion's numbers
  return {error(largest), Pose::kDim == 2 ? error(0) : 4 * error(kTenths)};
}

template <class Matrix>
bool are_close(const Matrix& a, const Matrix& b, double share) {
  return (a - b).norm() <= share * a.norm();
}

/// Whether the measurement is another one up to an error of each of its components.
template <class Pose>
bool are_close(const Pose& a, const Pose& b, const PrintedError& error) {
  const typename Pose::Tangent difference = (a.inverse() * b).log();
  const double m = difference.template head<Pose::kDim>().norm();
  const double rad = difference.template tail<Pose::kDof - Pose::kDim>().norm();
  const double rounding = kRounding * std::max(1.0, a.translation().norm());
  return m <= rounding + 2 * error.m && rad <= kRounding + error.rad;
}

}  // namespace

template <class Pose>
RelativePoseFactor<Pose> reversed(const RelativePoseFactor<Pose>& factor) {
  RelativePoseFactor<Pose> result = factor;
  result.i = factor.j;
  result.j = factor.i;
  result.T_i_j = factor.T_i_j.inverse();
  const typename Pose::Jacobian back = factor.T_i_j.inverse().adjoint();
  result.information = normal_matrix(back, factor.information);
  return result;
}

template <class Pose>
bool are_equal_edges(const RelativePoseFactor<Pose>& a, const RelativePoseFactor<Pose>& b) {
  const double length_m = std::max(1.0, a.T_i_j.translation().norm());
  return a.i == b.i && a.j == b.j && (a.T_i_j.inverse() * b.T_i_j).log().norm() < kRounding * length_m &&
         are_close(a.information, b.information, kRounding);
}

template <class Pose>
bool are_repeated_edges(const RelativePoseFactor<Pose>& a, const RelativePoseFactor<Pose>& b) {
  PrintedError error = printed_error(a.T_i_j);
  const PrintedError other = printed_error(b.T_i_j);
  if (a.i == b.i && a.j == b.j) {
    error = error == other ? PrintedError{} : PrintedError{error.m + other.m, error.rad + other.rad};
    return are_close(a.T_i_j, b.T_i_j, error) &&
           are_close(a.information, b.information, kInformationRounding);
  }
  if (a.i != b.j || a.j != b.i) return false;
  const RelativePoseFactor<Pose> back = reversed(b);
  error.rad += other.rad;
  error.m += other.m + error.rad * a.T_i_j.translation().norm() / 2;  // the other end turns with the angle
  return are_close(a.T_i_j, back.T_i_j, error) &&
         (are_close(a.information, b.information, kInformationRounding) ||
          are_close(a.information, back.information, kCarriedRounding));
}

#define RADIOSLAM_REPEATED_EDGES(Pose)                                                             \
  template RelativePoseFactor<Pose> reversed(const RelativePoseFactor<Pose>&);                     \
  template bool are_equal_edges(const RelativePoseFactor<Pose>&, const RelativePoseFactor<Pose>&); \
  template bool are_repeated_edges(const RelativePoseFactor<Pose>&, const RelativePoseFactor<Pose>&);
RADIOSLAM_REPEATED_EDGES(SE2)
RADIOSLAM_REPEATED_EDGES(SE3)
#undef RADIOSLAM_REPEATED_EDGES

}  // namespace radioslam
