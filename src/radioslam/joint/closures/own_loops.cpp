#include "radioslam/joint/closures/own_loops.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/graph/graduated.hpp"
#include "radioslam/graph/normal_equations.hpp"
#include "radioslam/joint/segment_odometry.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kRowsAtOnce = 16;  // blocks of rows of the inverse per solve

/// The trajectories by odometry and the closures of their scans, each in its own frame.
template <class Pose>
PoseGraph<Pose> trajectory_graph(const JointGraph<Pose>& joint, double odometry_scale = 1) {
  PoseGraph<Pose> graph;
  graph.poses = joint.team.graph.poses;
  graph.drifts = joint.team.graph.drifts;
  graph.drift_priors = joint.team.graph.drift_priors;
  for (std::size_t k = 0; k < joint.team.graph.relative_poses.size(); ++k) {
    const FactorSource source = joint.origins.relative_poses[k].source;
    if (source != FactorSource::kOdometry && source != FactorSource::kScanLoop) continue;
    graph.relative_poses.push_back(joint.team.graph.relative_poses[k]);
    if (source == FactorSource::kOdometry)
      graph.relative_poses.back().information /= odometry_scale * odometry_scale;
  }
  return graph;
}

/// A segment's poses with their joint covariance, for those at ends of loops.
template <class Pose>
class CorrectedChain final : public PoseChain<Pose> {
 public:
  using Jacobian = typename Pose::Jacobian;

  CorrectedChain(std::vector<Pose> poses, std::vector<std::ptrdiff_t> row_of_pose, Eigen::MatrixXd covariance)
      : poses_(std::move(poses)), row_of_pose_(std::move(row_of_pose)), covariance_(std::move(covariance)) {}

  std::size_t size() const override { return poses_.size(); }
  Pose increment(std::size_t i, std::size_t j) const override { return poses_[i].inverse() * poses_[j]; }
  Jacobian increment_covariance(std::size_t i, std::size_t j) const override {
    if (i == j) return Jacobian::Zero();
    // T_i_j Exp(xi_j - Ad(T_j_i) xi_i).
    const Jacobian by_i = -(poses_[j].inverse() * poses_[i]).adjoint();
    const Jacobian cross = by_i * block(i, j);
    return by_i * block(i, i) * by_i.transpose() + block(j, j) + cross + cross.transpose();
  }

 private:
  Jacobian block(std::size_t i, std::size_t j) const {
    RADIOSLAM_CHECK(row_of_pose_[i] >= 0 && row_of_pose_[j] >= 0, "covariances are of poses with loops");
    return covariance_.template block<Pose::kDof, Pose::kDof>(row_of_pose_[i], row_of_pose_[j]);
  }

  std::vector<Pose> poses_;
  std::vector<std::ptrdiff_t> row_of_pose_;  ///< into covariance_; -1: not at the end of a loop
  Eigen::MatrixXd covariance_;
};

/// The joint covariance of poses; zero where one is held.
template <class Pose>
Eigen::MatrixXd joint_covariance(const NormalEquations<Pose>& equations, const std::vector<PoseId>& poses) {
  constexpr Eigen::Index kDof = Pose::kDof;
  const auto rows = static_cast<Eigen::Index>(poses.size()) * kDof;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(rows, rows);
  const auto block = [&](std::size_t k) { return equations.blocks().of(variable(poses[k])); };
  parallel_for(poses.size(), kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin; first < end; first += kRowsAtOnce) {
      std::vector<std::size_t> blocks, members;
      for (std::size_t k = first; k < std::min(end, first + kRowsAtOnce); ++k)
        if (block(k) >= 0) blocks.push_back(static_cast<std::size_t>(block(k))), members.push_back(k);
      if (blocks.empty()) continue;
      const Eigen::MatrixXd solved = equations.cholesky().inverse_rows(blocks);
      for (std::size_t m = 0; m < members.size(); ++m)
        for (std::size_t k = 0; k < poses.size(); ++k) {
          if (block(k) < 0) continue;
          const auto offset =
              static_cast<Eigen::Index>(equations.matrix().offset(static_cast<std::size_t>(block(k))));
          covariance.block<kDof, kDof>(static_cast<Eigen::Index>(members[m]) * kDof,
                                       static_cast<Eigen::Index>(k) * kDof) =
              solved.block<kDof, kDof>(static_cast<Eigen::Index>(m) * kDof, offset);
        }
    }
  });
  return covariance;
}

}  // namespace

template <class Pose>
void correct_by_own_loops(JointGraph<Pose>& joint, std::vector<TeamLoop<Pose>>& loops,
                          const OptimizerParams& optimizer) {
  PoseGraph<Pose> graph = trajectory_graph(joint);
  std::vector<std::size_t> own;
  FactorMask mask;
  mask.relative_poses.assign(graph.relative_poses.size(), false);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    if (!loops[k].is_own()) continue;
    own.push_back(k);
    mask.relative_poses.push_back(true);
    RelativePoseFactor<Pose>& factor = graph.relative_poses.emplace_back(loop_factor(loops[k]));
    factor.loss = {LossKind::kNone, std::sqrt(loops[k].gate)};
  }
  if (own.empty()) return;
  const std::size_t first = graph.relative_poses.size() - own.size();
  const GraduatedSummary summary =
      optimize_graduated(graph, mask, GraduatedLoss::kTruncatedLeastSquares, GraduatedParams{}, optimizer);
  for (std::size_t k = 0; k < own.size(); ++k)
    loops[own[k]].accepted = summary.weights.relative_poses[first + k] > 0.5;
  joint.team.graph.poses = std::move(graph.poses);
  joint.team.graph.drifts = std::move(graph.drifts);
}

template <class Pose>
SegmentChains<Pose> segment_chains(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
                                   double odometry_scale) {
  PoseGraph<Pose> graph = trajectory_graph(joint, odometry_scale);
  const auto& segments = joint.team.segments;
  std::vector<bool> is_corrected(segments.size(), false), is_end(graph.poses.size(), false);
  const auto segment_of = segment_of_poses(joint.team);
  for (const std::size_t k : factors_of(joint.origins.relative_poses, FactorSource::kScanLoop))
    is_corrected[segment_of[joint.team.graph.relative_poses[k].i.index()]] = true;
  for (const TeamLoop<Pose>& loop : loops) {
    if (!loop.is_own()) is_end[loop.i.index()] = is_end[loop.j.index()] = true;
    if (!loop.is_own() || !loop.accepted) continue;
    is_corrected[loop.segment_i] = true;
    graph.relative_poses.push_back(loop_factor(loop));
  }
  NormalEquations<Pose> equations(graph);
  equations.linearise(graph);
  const bool has_covariances = equations.factorize(0) == Factorization::kDone;
  SegmentChains<Pose> chains;
  for (std::size_t s = 0; s < segments.size(); ++s) {
    const TrajectorySegment& segment = segments[s];
    if (!is_corrected[s] || !has_covariances) {
      chains.push_back(std::make_unique<OdometryChain<Pose>>(odometry_chain(joint, segment, odometry_scale)));
      continue;
    }
    std::vector<PoseId> ends;
    std::vector<std::ptrdiff_t> row_of_pose(segment.pose_count, -1);
    for (std::size_t k = 0; k < segment.pose_count; ++k) {
      if (!is_end[segment.first_pose + k]) continue;
      row_of_pose[k] = static_cast<std::ptrdiff_t>(ends.size()) * Pose::kDof;
      ends.push_back(PoseId(segment.first_pose + k));
    }
    const auto begin = graph.poses.begin() + static_cast<std::ptrdiff_t>(segment.first_pose);
    chains.push_back(std::make_unique<CorrectedChain<Pose>>(
        std::vector<Pose>(begin, begin + static_cast<std::ptrdiff_t>(segment.pose_count)),
        std::move(row_of_pose), joint_covariance(equations, ends)));
  }
  return chains;
}

#define RADIOSLAM_OWN_LOOPS(Pose)                                                                          \
  template void correct_by_own_loops(JointGraph<Pose>&, std::vector<TeamLoop<Pose>>&,                      \
                                     const OptimizerParams&);                                              \
  template SegmentChains<Pose> segment_chains(const JointGraph<Pose>&, const std::vector<TeamLoop<Pose>>&, \
                                              double);
RADIOSLAM_OWN_LOOPS(SE2)
RADIOSLAM_OWN_LOOPS(SE3)
#undef RADIOSLAM_OWN_LOOPS

}  // namespace radioslam
