// Reads the points and symmetric matrices of pose graph files field by field.
#pragma once

#include <Eigen/Core>
#include <string_view>

#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {

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
