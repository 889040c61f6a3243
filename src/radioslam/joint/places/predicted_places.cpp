#include "radioslam/joint/places/predicted_places.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace radioslam {
namespace {

constexpr double kMostDifferent =
    0.5;  // largest difference of descriptors that is compared with the prediction
constexpr double kDescriptorScale = 0.1;  // difference of descriptors as telling as one standard deviation

/// Per keyframe of robot b, those of robot a that it may be compared with.
class AllowedPairs {
 public:
  AllowedPairs(const std::vector<CandidateList::Group>& groups, RobotIndex a, RobotIndex b,
               std::size_t keyframes_b)
      : with_(keyframes_b) {
    for (const CandidateList::Group& group : groups)
      if (group.robot_i == a && group.robot_j == b)
        for (const CandidateList::Row& row : group.rows) with_[row.keyframe_j].push_back(row.keyframe_i);
  }
  bool contains(std::size_t i, std::size_t j) const {
    return std::binary_search(with_[j].begin(), with_[j].end(), static_cast<std::uint32_t>(i));
  }

 private:
  std::vector<std::vector<std::uint32_t>> with_;
};

}  // namespace

template <class Pose>
std::size_t PredictedPlaces<Pose>::expect(std::size_t a, std::size_t b,
                                          const std::vector<std::size_t>& strides) {
  const TeamAlignment<Pose>& alignment = input_.team.alignment;
  const AllowedPairs allowed(*input_.allowed, RobotIndex(a), RobotIndex(b),
                             input_.team.joint.robots[b].stamps.size());
  const std::vector<double>& weights = alignment.alternative_weights;
  const std::size_t others = predictions_.others();
  std::size_t turn = 0, pairs = 0;
  for (const std::size_t j : strides) {
    std::vector<std::size_t> with;
    for (std::size_t i = 0; i < robots_[a].size(); ++i)
      if (robots_[a].has_cloud(i) && allowed.contains(robots_[a].keyframes[i], robots_[b].keyframes[j]))
        with.push_back(i);
    pairs += with.size();
    if (with.empty()) continue;
    Proposal pair{a, b, 0, j, {}, false, 0, 0, alignment.weight};
    expected_.push_back(nearest_of(pair, with));
    if (others == 0 || params_.candidates == 1) continue;
    pair.alignment = 1 + turn++ % others;
    pair.alignment_weight = weights[pair.alignment - 1];
    expected_.push_back(nearest_of(pair, with));
  }
  return pairs;
}

template <class Pose>
std::size_t PredictedPlaces<Pose>::propose(const Attempts& tried, PlaceExchange& exchange,
                                           PlaceCounts& counts, std::vector<Proposal>& proposals) {
  const std::vector<bool> asked = asked_for(exchange);
  std::size_t left_out = 0;
  for (std::size_t k = 0; k < expected_.size(); ++k) {
    if (!asked[k]) {
      ++left_out;
      continue;
    }
    Proposal& pair = expected_[k].pair;
    exchange.send_descriptor(robots_, pair.a, pair.b, pair.j);
    choose_by_descriptors(expected_[k], counts);
    if (tried.has(pair)) continue;
    pair.alternatives = predictions_.by_others(robots_, pair);
    proposals.push_back(std::move(pair));
  }
  return left_out;
}

template <class Pose>
const std::vector<Pose>& PredictedPlaces<Pose>::poses_of(const Proposal& pair) const {
  return pair.alignment == 0 ? input_.team.joint.team.graph.poses
                             : input_.team.alignment.alternatives[pair.alignment - 1];
}

template <class Pose>
typename PredictedPlaces<Pose>::Expected PredictedPlaces<Pose>::nearest_of(
    Proposal pair, const std::vector<std::size_t>& partners) const {
  const Poses& poses = poses_of(pair);
  const SE3 at_j = predictions_.pose(poses, robots_[pair.b], pair.j);
  std::vector<double> distances_m;
  for (const std::size_t i : partners)
    distances_m.push_back(
        (predictions_.pose(poses, robots_[pair.a], i).translation() - at_j.translation()).norm());
  const auto nearest = std::min_element(distances_m.begin(), distances_m.end());
  pair.i = partners[static_cast<std::size_t>(nearest - distances_m.begin())];
  pair.T_i_j = predictions_.relative_pose(poses, robots_, pair);
  return {std::move(pair), partners, std::move(distances_m)};
}

/// Those whose descriptors were sent before, and of the others twice as many as can be registered, of
/// greatest worth.
template <class Pose>
std::vector<bool> PredictedPlaces<Pose>::asked_for(const PlaceExchange& exchange) const {
  if (!input_.budget || input_.budget->order != VerificationBudget::Order::kWorth)
    return std::vector<bool>(expected_.size(), true);
  std::vector<bool> asked(expected_.size(), false);
  std::vector<std::size_t> unknown;
  std::vector<Proposal> pairs;
  for (std::size_t k = 0; k < expected_.size(); ++k) {
    const Proposal& pair = expected_[k].pair;
    asked[k] = exchange.has_descriptor(pair.a, pair.b, pair.j);
    if (asked[k]) continue;
    unknown.push_back(k);
    pairs.push_back(pair);
  }
  VerificationBudget twice = *input_.budget;
  twice.registrations *= 2;
  for (const std::size_t n : indices_within(twice, pairs)) asked[unknown[n]] = true;
  return asked;
}

template <class Pose>
void PredictedPlaces<Pose>::choose_by_descriptors(Expected& expected, PlaceCounts& counts) const {
  auto& [pair, partners, distances_m] = expected;
  const ScanContext& of_j = robots_[pair.b].contexts->context(pair.j);
  const std::size_t nearest_i = pair.i;
  const double nearest_m = *std::min_element(distances_m.begin(), distances_m.end());
  const double sigma_m = horizontal_sigma(pair.T_i_j);
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t n = 0; n < partners.size(); ++n) {
    const double farther_m2 = distances_m[n] * distances_m[n] - nearest_m * nearest_m;
    const double prior = -farther_m2 / (2 * sigma_m * sigma_m);
    if (prior < -kMostDifferent / kDescriptorScale) continue;
    ++counts.compared;
    const double distance = compare(robots_[pair.a].contexts->context(partners[n]), of_j).distance;
    const double score = prior - distance / kDescriptorScale;
    if (score > best) best = score, pair.i = partners[n], pair.descriptor_distance = distance;
  }
  if (pair.i != nearest_i) pair.T_i_j = predictions_.relative_pose(poses_of(pair), robots_, pair);
}

template <class Pose>
std::vector<std::size_t> PredictedPlaces<Pose>::indices_within(const VerificationBudget& budget,
                                                               const std::vector<Proposal>& proposals) const {
  const auto predicted = predictions_.of_graph();
  return within_budget(budget, proposals, robots_, predicted ? &*predicted : nullptr, loops_);
}

template <class Pose>
std::vector<Proposal> PredictedPlaces<Pose>::within(const VerificationBudget& budget,
                                                    const std::vector<Proposal>& proposals) const {
  std::vector<Proposal> result;
  for (const std::size_t k : indices_within(budget, proposals)) result.push_back(proposals[k]);
  return result;
}

template class PredictedPlaces<SE2>;
template class PredictedPlaces<SE3>;

}  // namespace radioslam
