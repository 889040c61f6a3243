#include "radioslam/joint/segment_odometry.hpp"

#include <algorithm>
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

template <class Pose>
std::vector<bool> ordinary_steps(const JointGraph<Pose>& joint) {
  constexpr double kMostOverMedian = 100;
  const auto& factors = joint.team.graph.relative_poses;
  std::vector<bool> ordinary(factors.size(), false);
  std::vector<std::size_t> steps;
  std::vector<typename Pose::Tangent> variances;
  for (std::size_t k = 0; k < factors.size(); ++k) {
    if (joint.origins.relative_poses[k].source != FactorSource::kOdometry) continue;
    steps.push_back(k);
    variances.push_back(inverse(factors[k].information).diagonal());
    ordinary[k] = true;
  }
  if (steps.empty()) return ordinary;
  std::vector<double> of_all(steps.size());
  for (Eigen::Index d = 0; d < Pose::kDof; ++d) {
    std::transform(variances.begin(), variances.end(), of_all.begin(), [d](const auto& of) { return of[d]; });
    const auto median = of_all.begin() + static_cast<std::ptrdiff_t>(of_all.size() / 2);
    std::nth_element(of_all.begin(), median, of_all.end());
    for (std::size_t n = 0; n < steps.size(); ++n)
      if (variances[n][d] > kMostOverMedian * *median) ordinary[steps[n]] = false;
  }
  return ordinary;
}

template OdometryChain<SE2> odometry_chain(const JointGraph<SE2>&, const TrajectorySegment&, double);
template OdometryChain<SE3> odometry_chain(const JointGraph<SE3>&, const TrajectorySegment&, double);
template std::vector<bool> ordinary_steps(const JointGraph<SE2>&);
template std::vector<bool> ordinary_steps(const JointGraph<SE3>&);

}  // namespace radioslam
