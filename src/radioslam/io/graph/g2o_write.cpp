#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <string_view>

#include "radioslam/base/check.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/graph/residuals.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/g2o_entries.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

/// Appends the parts of a g2o file's lines: tags, ids, numbers, points, poses and information matrices.
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

/// Builds the text entry by entry.
template <class Pose>
class G2oWriter {
 public:
  explicit G2oWriter(const G2oGraph<Pose>& file) : file_(file), graph_(file.graph) {
    RADIOSLAM_CHECK(file.pose_ids.size() == graph_.poses.size(), "one id per pose");
    RADIOSLAM_CHECK(file.point_ids.size() == graph_.points.size(), "one id per point");
  }

  std::string write() {
    write_vertices();
    write_fixed();
    if (Pose::kDim == 3 && !(graph_.pose_priors.empty() && graph_.relative_points.empty())) {
      out_.tag(Tags::kOffset);
      out_.id(0);
      out_.pose(Pose());
      out_.end_line();
    }
    for (const auto& factor : graph_.relative_poses) write_relative_pose(factor);
    for (const auto& factor : graph_.ranges) write_range(factor);
    for (const auto& factor : graph_.relative_points)
      if (has_a_tag(factor)) write_sighting(factor);
    for (const auto& factor : graph_.pose_priors) write_prior(factor);
    write_omissions();
    return out_.take();
  }

 private:
  using Tags = G2oTags<Pose>;

  void write_vertices() {
    for (std::size_t k = 0; k < graph_.poses.size(); ++k) {
      out_.tag(Tags::kVertex);
      out_.id(file_.pose_ids[k]);
      out_.pose(graph_.poses[k]);
      out_.end_line();
    }
    for (std::size_t k = 0; k < graph_.points.size(); ++k) {
      out_.tag(Tags::kPoint);
      out_.id(file_.point_ids[k]);
      out_.point(graph_.points[k]);
      out_.end_line();
    }
  }

  void write_fixed() {
    for (std::size_t k = 0; k < graph_.pose_fixed.size(); ++k) {
      if (!graph_.pose_fixed[k]) continue;
      out_.tag(kG2oFix);
      out_.id(file_.pose_ids[k]);
      out_.end_line();
    }
  }

  void write_relative_pose(const RelativePoseFactor<Pose>& factor) {
    Pose T_i_j = factor.T_i_j;
    if (factor.drift.valid())
      T_i_j = T_i_j * Pose::exp(factor.drift_jacobian * graph_.drifts[factor.drift.index()]);
    out_.tag(Tags::kEdge);
    out_.id(file_.pose_ids[factor.i.index()]);
    out_.id(file_.pose_ids[factor.j.index()]);
    out_.pose(T_i_j);
    out_.information(factor.information, factor.weight, graph_.chart);
    out_.end_line();
  }

  std::uint64_t id_of(const RangeEnd<Pose>& end) const {
    return end.pose.valid() ? file_.pose_ids[end.pose.index()] : file_.point_ids[end.point.index()];
  }

  void write_range(const RangeFactor<Pose>& factor) {
    if (factor.weight <= 0) return;
    out_.tag(kG2oRange);
    out_.id(id_of(factor.i));
    out_.id(id_of(factor.j));
    const double bias_m = factor.bias.valid() ? graph_.range_biases[factor.bias.index()] : 0;
    const double unit = length_unit(graph_, factor), sigma_m = factor.sigma_m / unit;
    out_.number((factor.range_m - bias_m) / unit);
    out_.number(factor.weight / (sigma_m * sigma_m));
    if (!factor.i.lever_arm.isZero(0) || !factor.j.lever_arm.isZero(0)) {
      out_.point(factor.i.lever_arm);
      out_.point(factor.j.lever_arm);
    }
    out_.end_line();
  }

  /// The format has no lever arm for such an edge.
  static bool has_a_tag(const RelativePointFactor<Pose>& factor) { return factor.j.lever_arm.isZero(0); }

  void write_sighting(const RelativePointFactor<Pose>& factor) {
    out_.tag(Tags::kSighting);
    out_.id(file_.pose_ids[factor.i.index()]);
    out_.id(id_of(factor.j));
    if (Pose::kDim == 3) out_.id(0);
    out_.point(factor.position);
    for (int row = 0; row < Pose::kDim; ++row)
      for (int column = row; column < Pose::kDim; ++column)
        out_.number(factor.weight * factor.information(row, column));
    out_.end_line();
  }

  void write_prior(const PosePriorFactor<Pose>& factor) {
    out_.tag(Tags::kPrior);
    out_.id(file_.pose_ids[factor.i.index()]);
    if (Pose::kDim == 3) out_.id(0);
    out_.pose(factor.prior);
    out_.information(prior_information(factor), factor.weight, graph_.chart);
    out_.end_line();
  }

  /// The format has no prior of gravity alone: one without information about the vertical axis.
  static typename Pose::Jacobian prior_information(const PosePriorFactor<Pose>& factor) {
    typename Pose::Jacobian result = factor.information;
    if constexpr (Pose::kDim == 3)
      if (factor.gravity_only) {
        typename Pose::Jacobian across = Pose::Jacobian::Identity();
        const Eigen::Vector3d up = vertical_in_body(factor.prior);
        across.template bottomRightCorner<3, 3>() -= up * up.transpose();
        result = across * factor.information * across;
      }
    return result;
  }

  void write_omission(std::size_t count, std::string_view what) {
    if (count > 0) out_.comment("not written: " + std::to_string(count) + " " + std::string(what));
  }

  void write_omissions() {
    const auto robust = [](std::size_t sum, const auto& f) { return sum + (f.loss.kind != LossKind::kNone); };
    const auto count = [&](const auto& factors) {
      return std::accumulate(factors.begin(), factors.end(), std::size_t{0}, robust);
    };
    write_omission(count(graph_.relative_poses) + count(graph_.ranges) + count(graph_.relative_points) +
                       count(graph_.pose_priors),
                   "robust losses");
    write_omission(graph_.bearings.size(), "bearings");
    write_omission(
        static_cast<std::size_t>(std::count_if(graph_.relative_points.begin(), graph_.relative_points.end(),
                                               [](const auto& factor) { return !has_a_tag(factor); })),
        "relative points");
    write_omission(graph_.positions.size(), "positions");
    write_omission(graph_.drift_priors.size(), "drift priors");
    write_omission(graph_.range_bias_priors.size(), "range bias priors");
  }

  const G2oGraph<Pose>& file_;
  const PoseGraph<Pose>& graph_;
  G2oLineWriter<Pose> out_;
};

}  // namespace

template <class Pose>
G2oGraph<Pose> with_default_ids(PoseGraph<Pose> graph) {
  G2oGraph<Pose> file;
  file.pose_ids.resize(graph.poses.size());
  std::iota(file.pose_ids.begin(), file.pose_ids.end(), std::uint64_t{0});
  file.point_ids.resize(graph.points.size());
  std::iota(file.point_ids.begin(), file.point_ids.end(), std::uint64_t{graph.poses.size()});
  file.pose_has_value.assign(graph.poses.size(), true);
  file.graph = std::move(graph);
  return file;
}

template <class Pose>
G2oGraph<Pose> with_ids(PoseGraph<Pose> graph, const std::vector<std::uint64_t>& pose_ids,
                        const std::vector<std::uint64_t>& point_ids) {
  G2oGraph<Pose> file = with_default_ids(std::move(graph));
  if (pose_ids.empty() || pose_ids.size() != file.pose_ids.size()) return file;
  file.pose_ids = pose_ids;
  std::iota(file.point_ids.begin(), file.point_ids.end(),
            *std::max_element(pose_ids.begin(), pose_ids.end()) + 1);
  if (point_ids.size() == file.point_ids.size()) file.point_ids = point_ids;
  return file;
}

template <class Pose>
std::string format_g2o(const G2oGraph<Pose>& graph) {
  return G2oWriter<Pose>(graph).write();
}

template G2oGraph<SE2> with_default_ids(PoseGraph2);
template G2oGraph<SE3> with_default_ids(PoseGraph3);
template G2oGraph<SE2> with_ids(PoseGraph2, const std::vector<std::uint64_t>&,
                                const std::vector<std::uint64_t>&);
template G2oGraph<SE3> with_ids(PoseGraph3, const std::vector<std::uint64_t>&,
                                const std::vector<std::uint64_t>&);
template std::string format_g2o(const G2oGraph<SE2>&);
template std::string format_g2o(const G2oGraph<SE3>&);

}  // namespace radioslam
