// The fields of one line, read from left to right; each refusal names file, line and field.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// How far the norm of a recorded orientation may be from 1. Rounding to two decimals stays within it; a
/// slipped column or another number in place of one does not.
inline constexpr double kUnitQuaternionTolerance = 0.02;

/// What one field says, or a refusal. `what` is the field's name in the message.
double number_in(const TextLines& at, std::string_view field, std::string_view what);
double coordinate_in(const TextLines& at, std::string_view field, std::string_view what);
Stamp stamp_in(const TextLines& at, std::string_view field, std::string_view what);
/// Not negative.
double sigma_in(const TextLines& at, std::string_view field, std::string_view what);
/// Normalised; refused where its norm is further from 1 than the tolerance, or zero.
Eigen::Quaterniond quaternion_in(const TextLines& at, const Eigen::Vector4d& xyzw, double norm_tolerance);

/// The refusal of a quaternion that is no orientation.
std::string not_a_unit_quaternion(double norm);

/// Reads a line's fields, separated by blanks or tabs.
class LineFields {
 public:
  explicit LineFields(const TextLines& at) : at_(&at), rest_(at.line()) { skip_blanks(); }

  bool empty() const { return rest_.empty(); }
  /// The next field; refused if there is none.
  std::string_view next(std::string_view what);
  double number(std::string_view what) { return number_in(*at_, next(what), what); }
  double coordinate(std::string_view what) { return coordinate_in(*at_, next(what), what); }
  Stamp stamp(std::string_view what) { return stamp_in(*at_, next(what), what); }
  std::uint64_t id(std::string_view what);
  /// x y z of a position.
  Eigen::Vector3d position();
  /// qx qy qz qw, normalised; a zero quaternion is refused.
  Eigen::Quaterniond quaternion() { return normalised_quaternion(std::numeric_limits<double>::infinity()); }
  /// The same; refused as well where the norm is off by more than kUnitQuaternionTolerance.
  Eigen::Quaterniond unit_quaternion() { return normalised_quaternion(kUnitQuaternionTolerance); }
  /// x y z qx qy qz qw.
  SE3 pose();
  /// Refuses fields that are left.
  void end() const;

  [[noreturn]] void fail(const std::string& reason) const { at_->fail(reason); }

 private:
  void skip_blanks();
  Eigen::Quaterniond normalised_quaternion(double norm_tolerance);

  const TextLines* at_;
  std::string_view rest_;
};

}  // namespace radioslam
