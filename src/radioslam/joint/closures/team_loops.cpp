#include "radioslam/joint/closures/team_loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

/// A closure's relative pose from the loop's end i, whichever way it was measured.
template <class Pose>
UncertainPose<Pose> oriented(const Closure& closure, const ClosureEnds& ends, PoseId from,
                             const ClosureAdmission& admitted) {
  const UncertainPose<Pose> measured{
      pose_as<Pose>(closure.T_i_j),
      inverse(information_as<Pose>(closure.information)) / admitted.information_scale};
  return ends.i == from ? measured : measured.inverse();
}

template <class Pose>
bool agree(const TeamLoop<Pose>& loop, const UncertainPose<Pose>& again) {
  const Cholesky<typename Pose::Jacobian> cholesky(loop.covariance + again.covariance);
  const typename Pose::Tangent error = (loop.T_i_j.inverse() * again.pose).log();
  return cholesky.succeeded() && cholesky.whitened(error).squaredNorm() <= kPoseChiSquared999<Pose>;
}

constexpr double kMinExtent_m = 1;

/// Extents of a segment's bounding box in its own frame.
template <class Pose>
typename Pose::Point extent(const JointGraph<Pose>& joint, const TrajectorySegment& segment) {
  typename Pose::Point low = joint.team.graph.poses[segment.first_pose].translation(), high = low;
  for (std::size_t k = segment.first_pose; k < segment.first_pose + segment.pose_count; ++k) {
    low = low.cwiseMin(joint.team.graph.poses[k].translation());
    high = high.cwiseMax(joint.team.graph.poses[k].translation());
  }
  return high - low;
}

/// Of the relative poses of two segments with this sum of extents.
template <class Pose>
double volume(const typename Pose::Point& extents) {
  using std::numbers::pi;
  const double rotations = Pose::kDim == 2 ? 2 * pi : 8 * pi * pi;
  return rotations * (extents.array() + kMinExtent_m).prod();
}

template <class Pose>
double gate_of(const typename Pose::Jacobian& covariance, double volume) {
  const typename Pose::Jacobian scaled = 2 * std::numbers::pi * covariance;
  const Cholesky<typename Pose::Jacobian> cholesky(scaled);
  const double log_root_det = cholesky.lower().diagonal().array().log().sum();
  return std::max(kPoseChiSquared99<Pose>, 2 * (std::log(volume) - log_root_det));
}

}  // namespace

template <class Pose>
std::vector<TeamLoop<Pose>> team_loops(const JointGraph<Pose>& joint, const std::vector<Closure>& closures,
                                       const std::vector<ClosureAdmission>& admissions) {
  const auto segment_of = segment_of_poses(joint.team);
  std::vector<typename Pose::Point> extents;
  for (const TrajectorySegment& segment : joint.team.segments) extents.push_back(extent(joint, segment));
  std::vector<TeamLoop<Pose>> loops;
  std::multimap<std::pair<PoseId, PoseId>, std::size_t> by_ends;
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const ClosureEnds ends = closure_ends(joint, closures[k]);
    if (!ends.valid() || ends.i == ends.j) continue;
    const ClosureAdmission admitted = admissions.empty() ? ClosureAdmission{} : admissions[k];
    const auto [begin, end] = by_ends.equal_range(std::minmax(ends.i, ends.j));
    auto same = begin;
    for (; same != end; ++same) {
      TeamLoop<Pose>& loop = loops[same->second];
      const auto again = oriented<Pose>(closures[k], ends, loop.i, admitted);
      if (!agree(loop, again)) continue;
      loop.closures.push_back(k);
      loop.admission = std::min(loop.admission, admitted.admission);
      const double share = 1 / static_cast<double>(loop.closures.size());
      loop.T_i_j = loop.T_i_j * Pose::exp(share * (loop.T_i_j.inverse() * again.pose).log());
      break;
    }
    if (same != end) continue;
    by_ends.emplace(std::minmax(ends.i, ends.j), loops.size());
    const auto measured = oriented<Pose>(closures[k], ends, ends.i, admitted);
    const std::size_t a = segment_of[ends.i.index()], b = segment_of[ends.j.index()];
    loops.push_back({ends.i,
                     ends.j,
                     a,
                     b,
                     measured.pose,
                     measured.covariance,
                     gate_of<Pose>(measured.covariance, volume<Pose>(extents[a] + extents[b])),
                     {k},
                     admitted.admission});
  }
  return loops;
}

template <class Pose>
RelativePoseFactor<Pose> loop_factor(const TeamLoop<Pose>& loop) {
  RelativePoseFactor<Pose> factor;
  factor.i = loop.i;
  factor.j = loop.j;
  factor.T_i_j = loop.T_i_j;
  factor.information = inverse(loop.covariance);
  return factor;
}

#define RADIOSLAM_TEAM_LOOPS(Pose)                                                                      \
  template std::vector<TeamLoop<Pose>> team_loops(const JointGraph<Pose>&, const std::vector<Closure>&, \
                                                  const std::vector<ClosureAdmission>&);                \
  template RelativePoseFactor<Pose> loop_factor(const TeamLoop<Pose>&);
RADIOSLAM_TEAM_LOOPS(SE2)
RADIOSLAM_TEAM_LOOPS(SE3)
#undef RADIOSLAM_TEAM_LOOPS

}  // namespace radioslam
