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

/// Every k-th closure, weighing k times as much.
std::vector<FingerprintClosure> thinned(const std::vector<FingerprintClosure>& closures, std::size_t most) {
  if (most == 0) return {};
  const std::size_t stride = (closures.size() + most - 1) / most;
  std::vector<FingerprintClosure> kept;
  for (std::size_t k = 0; k < closures.size(); k += stride) {
    kept.push_back(closures[k]);
    kept.back().weight *= static_cast<double>(stride);
  }
  return kept;
}

}  // namespace

std::vector<FingerprintClosure> propose_near_closures(const RadioMeasurements& radio, double trusted_way_m,
                                                      const FingerprintClosureParams& params) {
  const double least = params.nearest_factor * radio.near_model.smallest_distance_m().value_or(0);
  std::vector<FingerprintClosure> closures;
  for (std::size_t i = 0; i < radio.nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < radio.nodes.size(); ++j) {
      const double similarity = static_cast<double>(radio.near_similarity[i][j]);
      if (similarity <= 0) continue;
      const auto limit = distance_limit(radio, i, j, trusted_way_m, params);
      if (!limit) continue;
      const auto predicted = radio.near_model.predict(similarity);
      if (predicted && predicted->mean_m < std::max(*limit, least))
        closures.push_back({i, j, similarity, *predicted, 1, false});
    }
  }
  share_evidence(closures, radio.nodes.size(), params.independent_pairs);
  return closures;
}

std::vector<FingerprintClosure> propose_layout_closures(const Mission& mission,
                                                        const RadioMeasurements& radio,
                                                        const LayoutParams& layout,
                                                        const FingerprintClosureParams& params) {
  std::vector<FingerprintClosure> closures;
  if (!radio.layout_model) return closures;
  for (std::size_t i = 0; i < radio.nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < radio.nodes.size(); ++j) {
      const RobotIndex a = radio.nodes[i].robot, b = radio.nodes[j].robot;
      const double similarity = static_cast<double>(radio.layout_similarity[i][j]);
      if (a == b || similarity <= layout.least_similarity) continue;
      if (mission.robots[a.index()].initial_pose && mission.robots[b.index()].initial_pose) continue;
      const double distance = radio.layout_model->distance_m(similarity);
      const double sigma = std::hypot(layout.sigma_m, layout.sigma_relative * distance);
      closures.push_back({i, j, similarity, {distance, sigma, 0, distance, sigma}, layout.pair_weight, true});
    }
  }
  return thinned(closures, static_cast<std::size_t>(params.layout_pairs));
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
