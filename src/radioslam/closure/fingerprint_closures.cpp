#include "radioslam/closure/fingerprint_closures.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace radioslam {
namespace {

/// Largest predicted distance for which the pair is a closure; nothing if odometry is more accurate.
std::optional<double> distance_limit(const RadioMeasurements& radio, std::size_t i, std::size_t j,
                                     double max_trusted_path_m, const FingerprintClosureParams& params) {
  if (radio.nodes[i].robot != radio.nodes[j].robot) return params.between_distance_m;
  const double path_m = std::abs(radio.at(j).travelled_m - radio.at(i).travelled_m);
  if (path_m <= max_trusted_path_m) return std::nullopt;
  return params.within_distance_m;
}

/// All n pairs of a fingerprint share its error, so together they weigh as much as `independent` ones.
void set_weights(std::vector<FingerprintClosure>& closures, std::size_t nodes, double independent) {
  std::vector<double> pairs(nodes, 0);
  for (const auto& closure : closures) {
    ++pairs[closure.node_i];
    ++pairs[closure.node_j];
  }
  for (auto& closure : closures)
    closure.weight = std::min(1.0, 2 * independent / (pairs[closure.node_i] + pairs[closure.node_j]));
}

/// Distant pair, as far apart as it is now.
FingerprintClosure far_closure(const SimilarPair& pair, const Eigen::Matrix3Xd& places,
                               const LayoutParams& layout) {
  const double distance =
      (places.col(static_cast<Eigen::Index>(pair.i)) - places.col(static_cast<Eigen::Index>(pair.j))).norm();
  const double sigma = std::hypot(layout.sigma_m, layout.sigma_relative * distance);
  return {pair.i, pair.j, static_cast<double>(pair.similarity), {distance, sigma, 0, distance, sigma},
          1,      true};
}

/// Lower bound of both distance limits.
double least_limit_m(const RadioMeasurements& radio, const FingerprintClosureParams& params) {
  return params.nearest_factor * radio.near_model.smallest_distance_m().value_or(0);
}

}  // namespace

std::optional<double> least_near_similarity(const RadioMeasurements& radio,
                                            const FingerprintClosureParams& params) {
  const double farthest_m =
      std::max({least_limit_m(radio, params), params.between_distance_m, params.within_distance_m});
  const auto minimum = radio.near_model.min_similarity_below(farthest_m);
  return minimum ? std::optional(std::max(*minimum, kAnySimilarity)) : std::nullopt;
}

std::vector<FingerprintClosure> propose_near_closures(const RadioMeasurements& radio,
                                                      double max_trusted_path_m,
                                                      const FingerprintClosureParams& params) {
  const double least = least_limit_m(radio, params);
  const auto minimum = least_near_similarity(radio, params);
  std::vector<FingerprintClosure> closures;
  if (!minimum) return closures;
  radio.near_similarity.for_each_pair(*minimum, [&](const SimilarPair& pair) {
    const auto limit = distance_limit(radio, pair.i, pair.j, max_trusted_path_m, params);
    if (!limit) return;
    const double similarity = static_cast<double>(pair.similarity);
    const auto predicted = radio.near_model.predict(similarity);
    if (predicted && predicted->mean_m < std::max(*limit, least))
      closures.push_back({pair.i, pair.j, similarity, *predicted, 1, false});
  });
  set_weights(closures, radio.nodes.size(), params.independent_pairs);
  return closures;
}

std::vector<FingerprintClosure> propose_layout_closures(const KnownStarts& starts,
                                                        const RadioMeasurements& radio,
                                                        const Eigen::Matrix3Xd& places,
                                                        const LayoutParams& layout,
                                                        const FingerprintClosureParams& params) {
  std::vector<FingerprintClosure> closures;
  const auto most = static_cast<std::size_t>(params.layout_pairs);
  const bool all_known =
      std::all_of(starts.begin(), starts.end(), [](const auto& s) { return s.has_value(); });
  if (!radio.layout_model || most == 0 || all_known) return closures;
  const auto for_each_far_pair = [&](const auto& visit) {
    radio.layout_similarity.for_each_pair(layout.min_similarity, [&](const SimilarPair& pair) {
      const RobotIndex a = radio.nodes[pair.i].robot, b = radio.nodes[pair.j].robot;
      if (a == b || static_cast<double>(pair.similarity) <= layout.min_similarity) return;
      if (starts[a.index()] && starts[b.index()]) return;
      visit(pair);
    });
  };
  std::size_t count = 0, next = 0;
  for_each_far_pair([&](const SimilarPair&) { ++count; });
  const std::size_t stride = (count + most - 1) / most;
  std::map<std::pair<RobotIndex, RobotIndex>, double> pairs;
  for_each_far_pair([&](const SimilarPair& pair) {
    if (next++ % stride != 0) return;
    closures.push_back(far_closure(pair, places, layout));
    ++pairs[{radio.nodes[pair.i].robot, radio.nodes[pair.j].robot}];
  });
  for (FingerprintClosure& closure : closures)
    closure.weight = 1 / pairs[{radio.nodes[closure.node_i].robot, radio.nodes[closure.node_j].robot}];
  return closures;
}

std::vector<FingerprintClosure> propose_fingerprint_closures(
    const KnownStarts& starts, const RadioMeasurements& radio, const Eigen::Matrix3Xd& places,
    double max_trusted_path_m, const LayoutParams& layout, const FingerprintClosureParams& params) {
  auto closures = propose_near_closures(radio, max_trusted_path_m, params);
  const auto far = propose_layout_closures(starts, radio, places, layout, params);
  closures.insert(closures.end(), far.begin(), far.end());
  return closures;
}

}  // namespace radioslam
