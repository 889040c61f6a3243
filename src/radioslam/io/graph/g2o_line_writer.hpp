// Appends the parts of a g2o file's lines: tags, ids, numbers, points, poses and information matrices.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {

template <class Pose>
class G2oLineWriter {
 public:
  void tag(std::string_view name) { out_ += name; }
  void id(std::uint64_t value) { (out_ += ' ') += std::to_string(value); }
  void number(double value) { append_number(out_ += ' ', value); }
  void end_line() { out_ += '\n'; }
  void comment(std::string_view text) { (out_ += "# ").append(text) += '\n'; }

  void point(const typename Pose::Point& p) {
    for (int axis = 0; axis < Pose::kDim; ++axis) number(p(axis));
  }

  void pose(const Pose& value) {
    point(value.translation());
    if constexpr (Pose::kDim == 2) {
      number(value.angle());
    } else {
      for (int k = 0; k < 4; ++k) number(value.rotation().coeffs()(k));
    }
  }

  /// The upper triangle, row by row, of a pose's information in `chart`, converted to g2o's.
  void information(const typename Pose::Jacobian& matrix, double weight, PoseChart chart) {
    typename Pose::Tangent scale = Pose::Tangent::Ones();
    scale.template tail<Pose::kDof - Pose::kDim>().setConstant(rotation_per_g2o_rotation(chart));
    for (int row = 0; row < Pose::kDof; ++row)
      for (int column = row; column < Pose::kDof; ++column)
        number(weight * scale(row) * scale(column) * matrix(row, column));
  }

  std::string take() { return std::move(out_); }

 private:
  /// d(error in the graph's chart) / d(error in g2o's chart): in 3D, g2o uses the vector part of the
  /// quaternion, half of the rotation vector.
  static double rotation_per_g2o_rotation(PoseChart chart) {
    return Pose::kDim == 3 && chart == PoseChart::kLogarithm ? 2 : 1;
  }

  std::string out_;
};

}  // namespace radioslam
