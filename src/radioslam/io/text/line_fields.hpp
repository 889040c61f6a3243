// Reader of the fields of one line, from left to right; errors name file, line and field.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <string_view>

#include "radioslam/base/stamp.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Largest deviation of a recorded quaternion's norm from 1. Rounding to two decimals stays below it; shifted
/// columns do not.
inline constexpr double kUnitQuaternionTolerance = 0.02;

/// The value of one field; throws InputError of `kind` if it is malformed. `what` names the field in the
/// message.
double number_in(const TextLines& at, std::string_view field, std::string_view what,
                 InputError::Kind kind = InputError::Kind::kUnreadable);
double coordinate_in(const TextLines& at, std::string_view field, std::string_view what,
                     InputError::Kind kind = InputError::Kind::kUnreadable);
Stamp stamp_in(const TextLines& at, std::string_view field, std::string_view what);
/// A standard deviation; refuses negative values.
double sigma_in(const TextLines& at, std::string_view field, std::string_view what);
/// The normalised quaternion; refused if its norm is zero or differs from 1 by more than the tolerance.
Eigen::Quaterniond quaternion_in(const TextLines& at, const Eigen::Vector4d& xyzw, double norm_tolerance);

/// Error message for a quaternion that is not of unit length.
std::string not_a_unit_quaternion(double norm);

/// Reads the fields of a line, separated by blanks or tabs.
class LineFields {
 public:
  explicit LineFields(const TextLines& at) : at_(&at), rest_(at.line()) { skip_blanks(); }

  bool empty() const { return rest_.empty(); }
  /// The next field; refuses the end of the line.
  std::string_view next(std::string_view what);
  double number(std::string_view what) { return number_in(*at_, next(what), what); }
  double coordinate(std::string_view what) { return coordinate_in(*at_, next(what), what); }
  Stamp stamp(std::string_view what) { return stamp_in(*at_, next(what), what); }
  std::uint64_t id(std::string_view what);
  /// Position x y z.
  Eigen::Vector3d position();
  /// Quaternion qx qy qz qw, normalised; refuses the zero quaternion.
  Eigen::Quaterniond quaternion() { return normalised_quaternion(std::numeric_limits<double>::infinity()); }
  /// Like quaternion(), but also refuses a norm that differs from 1 by more than kUnitQuaternionTolerance.
  Eigen::Quaterniond unit_quaternion() { return normalised_quaternion(kUnitQuaternionTolerance); }
  /// Pose x y z qx qy qz qw.
  SE3 pose();
  /// Refuses remaining fields.
  void end() const;

  [[noreturn]] void fail(const std::string& reason,
                         InputError::Kind kind = InputError::Kind::kUnreadable) const {
    at_->fail(reason, kind);
  }

 private:
  void skip_blanks();
  Eigen::Quaterniond normalised_quaternion(double norm_tolerance);

  const TextLines* at_;
  std::string_view rest_;
};

// Reads the points and symmetric matrices of pose graph files field by field.

/// The coordinates of a point, as many as the pose's space has dimensions.
template <class Pose>
typename Pose::Point read_point_fields(LineFields& fields) {
  typename Pose::Point point;
  for (int axis = 0; axis < Pose::kDim; ++axis) point(axis) = fields.coordinate("coordinate");
  return point;
}

/// A symmetric matrix, given by its upper triangle row by row; `what` names its entries in error messages.
template <int N>
Eigen::Matrix<double, N, N> read_upper_triangle(LineFields& fields, std::string_view what) {
  Eigen::Matrix<double, N, N> m;
  for (int row = 0; row < N; ++row)
    for (int column = row; column < N; ++column) m(row, column) = m(column, row) = fields.number(what);
  return m;
}

}  // namespace radioslam
