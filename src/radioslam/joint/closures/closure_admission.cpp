#include "radioslam/joint/closures/closure_admission.hpp"

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kMinInformation = 0.5;  // share that angles must leave

/// Squared Mahalanobis norm of a closure under the joint estimate.
template <class Pose>
double statistic_of(const JointGraph<Pose>& joint, const RadioCovariance<Pose>& radio, const Closure& closure,
                    const ClosureEnds& ends) {
  const auto& poses = joint.team.graph.poses;
  const Pose T_i_j = poses[ends.i.index()].inverse() * poses[ends.j.index()];
  const typename Pose::Jacobian covariance =
      radio.relative_pose(ends.i, ends.j) + covariance_of<Pose>(closure);
  return Cholesky<typename Pose::Jacobian>(covariance)
      .whitened((pose_as<Pose>(closure.T_i_j).inverse() * T_i_j).log())
      .squaredNorm();
}

}  // namespace

template <class Pose>
std::vector<ClosureAdmission> admit_closures(const JointGraph<Pose>& joint,
                                             const TeamAlignment<Pose>& alignment,
                                             const std::vector<Closure>& closures,
                                             const CandidateList* candidates,
                                             const std::optional<RadioCovariance<Pose>>& radio,
                                             const AoaMatchWeights* angles) {
  std::vector<ClosureAdmission> admitted(closures.size());
  for (std::size_t k = 0; k < closures.size(); ++k) {
    const Closure& closure = closures[k];
    const ClosureEnds ends = closure_ends(joint, closure);
    if (!ends.valid() || closure.robot_i == closure.robot_j) continue;
    if (angles) {
      const double scale = angles->template information_scale<Pose>(closure).value_or(1);
      if (scale < kMinInformation) {
        admitted[k] = {Admission::kExcluded, "the angles of arrival disagree"};
        continue;
      }
      admitted[k].information_scale = scale;
    }
    if (!candidates || !connected_without_matches(alignment, closure.robot_i, closure.robot_j)) continue;
    if (!candidates->contains(closure.robot_i, keyframe_stamp(joint, closure.robot_i, closure.stamp_i),
                              closure.robot_j, keyframe_stamp(joint, closure.robot_j, closure.stamp_j)))
      admitted[k] = {Admission::kSetAside, "the views cannot overlap", admitted[k].information_scale};
    else if (radio && statistic_of(joint, *radio, closure, ends) > kPoseChiSquared999<Pose>)
      admitted[k] = {Admission::kSetAside, "its relative pose contradicts the radio",
                     admitted[k].information_scale};
  }
  return admitted;
}

template <class Pose>
std::vector<KeyframePair> keyframes_of(const JointGraph<Pose>& joint, const std::vector<Closure>& closures) {
  std::vector<KeyframePair> pairs;
  for (const Closure& closure : closures)
    if (closure.robot_i != closure.robot_j && closure_ends(joint, closure).valid())
      pairs.push_back({closure.robot_i, keyframe_stamp(joint, closure.robot_i, closure.stamp_i),
                       closure.robot_j, keyframe_stamp(joint, closure.robot_j, closure.stamp_j)});
  return pairs;
}

#define RADIOSLAM_CLOSURE_ADMISSION(Pose)                                                         \
  template std::vector<ClosureAdmission> admit_closures(                                          \
      const JointGraph<Pose>&, const TeamAlignment<Pose>&, const std::vector<Closure>&,           \
      const CandidateList*, const std::optional<RadioCovariance<Pose>>&, const AoaMatchWeights*); \
  template std::vector<KeyframePair> keyframes_of(const JointGraph<Pose>&, const std::vector<Closure>&);
RADIOSLAM_CLOSURE_ADMISSION(SE2)
RADIOSLAM_CLOSURE_ADMISSION(SE3)
#undef RADIOSLAM_CLOSURE_ADMISSION

}  // namespace radioslam
