#include "radioslam/joint/segment_odometry.hpp"

#include <utility>
#include <vector>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {

template <class Pose>
OdometryChain<Pose> odometry_chain(const JointGraph<Pose>& joint, const TrajectorySegment& segment,
                                   double odometry_scale) {
  const auto& factors = joint.team.graph.relative_poses;
  std::vector<Pose> poses{Pose()};
  std::vector<typename Pose::Jacobian> steps;
  for (std::size_t k = 0; k < factors.size() && poses.size() < segment.pose_count; ++k) {
    if (joint.origins.relative_poses[k].source != FactorSource::kOdometry ||
        factors[k].i.index() != segment.first_pose + poses.size() - 1)
      continue;
    poses.push_back(poses.back() * factors[k].T_i_j);
    steps.push_back(inverse(factors[k].information) * (odometry_scale * odometry_scale));
  }
  return {std::move(poses), steps};
}

template OdometryChain<SE2> odometry_chain(const JointGraph<SE2>&, const TrajectorySegment&, double);
template OdometryChain<SE3> odometry_chain(const JointGraph<SE3>&, const TrajectorySegment&, double);

}  // namespace radioslam
