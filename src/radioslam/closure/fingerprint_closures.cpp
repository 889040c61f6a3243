#include "radioslam/closure/fingerprint_closures.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace radioslam {
namespace {

/// The largest predicted distance that makes the pair a closure; nothing where odometry knows better.
std::optional<double> distance_limit(const RadioMeasurements& radio, std::size_t i, std::size_t j,
                                     double trusted_way_m, const FingerprintClosureParams& params) {
  if (radio.nodes[i].robot != radio.nodes[j].robot) return params.between_distance_m;
  const double way = std::abs(radio.at(j).walked_m - radio.at(i).walked_m);
  if (way <= trusted_way_m) return std::nullopt;
  return params.within_distance_m;
}

/// All pairs of a fingerprint carry its own error, so its n pairs together weigh as `independent` ones.
void share_evidence(std::vector<FingerprintClosure>& closures, std::size_t nodes, double independent) {
  std::vector<double> pairs(nodes, 0);
  for (const auto& closure : closures) {
    ++pairs[closure.node_i];
    ++pairs[closure.node_j];
  }
  for (auto& closure : closures)
    closure.weight = std::min(1.0, 2 * independent / (pairs[closure.node_i] + pairs[closure.node_j]));
}

/// One of `stands_for` far pairs.
FingerprintClosure far_closure(const SimilarPair& pair, const DecayModel& model, const LayoutParams& layout,
                               double stands_for) {
  const double similarity = static_cast<double>(pair.similarity), distance = model.distance_m(similarity);
  const double sigma = std::hypot(layout.sigma_m, layout.sigma_relative * distance);
  return {pair.i, pair.j, similarity, {distance, sigma, 0, distance, sigma}, layout.pair_weight * stands_for,
          true};
}

}  // namespace

std::vector<FingerprintClosure> propose_near_closures(const RadioMeasurements& radio, double trusted_way_m,
                                                      const FingerprintClosureParams& params) {
  const double least = params.nearest_factor * radio.near_model.smallest_distance_m().value_or(0);
  const double farthest = std::max({least, params.between_distance_m, params.within_distance_m});
  const auto minimum = radio.near_model.least_similarity_below(farthest);
  std::vector<FingerprintClosure> closures;
  if (!minimum) return closures;
  radio.near_similarity.for_each_pair(std::max(*minimum, kAnySimilarity), [&](const SimilarPair& pair) {
    const auto limit = distance_limit(radio, pair.i, pair.j, trusted_way_m, params);
    if (!limit) return;
    const double similarity = static_cast<double>(pair.similarity);
    const auto predicted = radio.near_model.predict(similarity);
    if (predicted && predicted->mean_m < std::max(*limit, least))
      closures.push_back({pair.i, pair.j, similarity, *predicted, 1, false});
  });
  share_evidence(closures, radio.nodes.size(), params.independent_pairs);
  return closures;
}

std::vector<FingerprintClosure> propose_layout_closures(const Mission& mission,
                                                        const RadioMeasurements& radio,
                                                        const LayoutParams& layout,
                                                        const FingerprintClosureParams& params) {
  std::vector<FingerprintClosure> closures;
  const auto most = static_cast<std::size_t>(params.layout_pairs);
  if (!radio.layout_model || most == 0) return closures;
  const auto for_each_far_pair = [&](const auto& visit) {
    radio.layout_similarity.for_each_pair(layout.least_similarity, [&](const SimilarPair& pair) {
      const RobotIndex a = radio.nodes[pair.i].robot, b = radio.nodes[pair.j].robot;
      if (a == b || static_cast<double>(pair.similarity) <= layout.least_similarity) return;
      if (mission.robots[a.index()].initial_pose && mission.robots[b.index()].initial_pose) return;
      visit(pair);
    });
  };
  std::size_t count = 0, next = 0;
  for_each_far_pair([&](const SimilarPair&) { ++count; });
  const std::size_t stride = (count + most - 1) / most;
  for_each_far_pair([&](const SimilarPair& pair) {
    if (next++ % stride == 0)
      closures.push_back(far_closure(pair, *radio.layout_model, layout, static_cast<double>(stride)));
  });
  return closures;
}

std::vector<FingerprintClosure> propose_fingerprint_closures(const Mission& mission,
                                                             const RadioMeasurements& radio,
                                                             double trusted_way_m, const LayoutParams& layout,
                                                             const FingerprintClosureParams& params) {
  auto closures = propose_near_closures(radio, trusted_way_m, params);
  const auto far = propose_layout_closures(mission, radio, layout, params);
  closures.insert(closures.end(), far.begin(), far.end());
  return closures;
}

}  // namespace radioslam
