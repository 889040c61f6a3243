#include "radioslam/joint/places/place_predictions.hpp"

#include <algorithm>
#include <array>

#include "radioslam/joint/uncertainty/position_uncertainty.hpp"

namespace radioslam {
namespace {

constexpr double kSigmaHeight_m = 2, kSigmaTilt_rad = 0.2;  // of a body, which a plane leaves out

UncertainPose<SE3> in_space(const SE3& T, const SE3::Jacobian& covariance) { return {T, covariance}; }
UncertainPose<SE3> in_space(const SE3& T, const SE2::Jacobian& covariance) {
  UncertainPose<SE3> result{T};
  result.covariance.diagonal() << 0, 0, kSigmaHeight_m * kSigmaHeight_m, kSigmaTilt_rad * kSigmaTilt_rad,
      kSigmaTilt_rad * kSigmaTilt_rad, 0;
  const std::array<int, 3> kept{0, 1, 5};
  result.covariance(kept, kept) = covariance;
  return result;
}

}  // namespace

template <class Pose>
PlacePredictions<Pose>::PlacePredictions(const TeamEstimate<Pose>& team, const RadioAlignmentParams& params)
    : team_(team),
      marginals_(Marginals<Pose>::compute(graph_for_covariances(team.joint, params.mixture).team.graph)) {
  if (!team.alignment.segments.of_segment.empty()) temperature_ = params.beam.evidence_temperature;
}

template <class Pose>
std::size_t PlacePredictions<Pose>::others() const {
  const std::vector<double>& weights = team_.alignment.alternative_weights;
  return static_cast<std::size_t>(std::count_if(weights.begin(), weights.end(),
                                                [](double weight) { return weight >= kMinSearchedWeight; }));
}

template <class Pose>
UncertainPose<SE3> PlacePredictions<Pose>::relative_pose(const Poses& poses,
                                                         const std::vector<ScannedRobot>& robots,
                                                         const Proposal& pair) const {
  const ScannedRobot &a = robots[pair.a], &b = robots[pair.b];
  const typename Pose::Jacobian covariance =
      temperature_ * marginals_->relative_pose(a.nodes[pair.i], b.nodes[pair.j]);
  return in_space(pose(poses, a, pair.i).inverse() * pose(poses, b, pair.j), covariance);
}

template <class Pose>
std::vector<ExpectedPlace::Alternative> PlacePredictions<Pose>::by_others(
    const std::vector<ScannedRobot>& robots, const Proposal& pair) const {
  const TeamAlignment<Pose>& alignment = team_.alignment;
  std::vector<ExpectedPlace::Alternative> predicted;
  const auto add = [&](const Poses& poses, double weight) {
    predicted.push_back(
        {pose(poses, robots[pair.a], pair.i).inverse() * pose(poses, robots[pair.b], pair.j), weight});
  };
  if (pair.alignment != 0) add(team_.joint.team.graph.poses, alignment.weight);
  for (std::size_t k = 0; k < others(); ++k)
    if (pair.alignment != k + 1) add(alignment.alternatives[k], alignment.alternative_weights[k]);
  return predicted;
}

template <class Pose>
std::optional<PredictedPoses<Pose>> PlacePredictions<Pose>::of_graph() const {
  if (!marginals_) return std::nullopt;
  return PredictedPoses<Pose>{team_.joint.team.graph.poses, *marginals_, temperature_};
}

template class PlacePredictions<SE2>;
template class PlacePredictions<SE3>;

}  // namespace radioslam
