#include "radioslam/graph/distributed/condensed/shared_part.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr double kLargest = 1e9;        ///< metres and other numbers of a part
constexpr double kLatestTime_s = 1e11;  ///< also of clocks that count from 1970

bool is_sane(double value) { return std::isfinite(value) && std::abs(value) <= kLargest; }
bool is_sane(const SE2& pose) {
  return is_sane(pose.translation().x()) && is_sane(pose.translation().y()) && is_sane(pose.angle());
}
bool is_time(double value) { return std::isfinite(value) && std::abs(value) <= kLatestTime_s; }
bool is_sigma(double value) { return is_sane(value) && value > 0; }
bool is_sane(const AngleEvidence& evidence) {
  return is_sane(evidence.log_odds) && evidence.scale >= 0 && evidence.scale <= 1;
}
bool is_covariance(const SE2::Jacobian& matrix) {
  if (!matrix.allFinite() || matrix.cwiseAbs().maxCoeff() > kLargest) return false;
  return Cholesky<SE2::Jacobian>(matrix).succeeded();
}

bool are_in_order(const std::vector<SharedNode>& nodes) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const SharedNode& node = nodes[k];
    if (!is_time(node.t_s) || !is_time(node.until_s) || node.until_s < node.t_s) return false;
    if (!is_sane(node.from_before.pose)) return false;
    if (k == 0 && node.number != 0) return false;
    if (k > 0 && (node.number <= nodes[k - 1].number || node.t_s < nodes[k - 1].t_s ||
                  !is_covariance(node.from_before.covariance)))
      return false;
  }
  return !nodes.empty();
}

}  // namespace

const SharedNode* SharedPart::node_at(double t_s) const {
  const auto after = std::upper_bound(nodes.begin(), nodes.end(), t_s,
                                      [](double t, const SharedNode& node) { return t < node.t_s; });
  if (after == nodes.begin()) return nullptr;
  const SharedNode& node = *std::prev(after);
  return t_s <= node.until_s ? &node : nullptr;
}

std::size_t SharedPart::place_of(std::uint32_t number) const {
  const auto at = std::lower_bound(nodes.begin(), nodes.end(), number,
                                   [](const SharedNode& node, std::uint32_t n) { return node.number < n; });
  if (at == nodes.end() || at->number != number) return nodes.size();
  return static_cast<std::size_t>(at - nodes.begin());
}

std::uint64_t first_number(double t_s) {
  constexpr double kPerSecond = 1000;
  return static_cast<std::uint64_t>(std::max(0.0, t_s) * kPerSecond);
}

bool is_well_formed(const SharedPart& part) {
  if (part.nodes.size() > kMaxSharedNodes || part.observations.size() > kMaxSharedEntries ||
      part.evidence.size() > kMaxSharedEntries)
    return false;
  if (part.robot.empty() || !are_in_order(part.nodes) || (part.start && !is_sane(*part.start))) return false;
  for (const SharedObservation& observation : part.observations)
    if (part.place_of(observation.node) == part.nodes.size() || observation.robot.empty() ||
        observation.robot == part.robot || !is_time(observation.t_s) || !is_sane(observation.T_i_j) ||
        !is_sigma(observation.sigma_m) || !is_sigma(observation.sigma_rad) || !is_sane(observation.evidence))
      return false;
  return std::all_of(part.evidence.begin(), part.evidence.end(), [](const SharedEvidence& evidence) {
    return is_time(evidence.t_s) && is_sane(evidence.angles);
  });
}

}  // namespace radioslam
