#include "radioslam/eval/closures.hpp"

#include <algorithm>
#include <optional>

#include "radioslam/base/check.hpp"
#include "radioslam/eval/association.hpp"

namespace radioslam {
namespace {

using Position = Eigen::Vector3d;
using Positions = std::vector<Position>;

std::optional<Position> true_position(const PairTruth& truth, std::size_t robot, Stamp stamp) {
  const RobotTruth& poses = truth.truth.robots[robot];
  const double slack_s = poses.has_orientation ? 0 : kWaypointStampSlack_s;
  const auto pose = pose_near(poses.poses, stamp, slack_s);
  if (!pose) return std::nullopt;
  Position position = pose->translation();
  if (truth.dimension == 2) position.z() = 0;
  return position;
}

/// True positions at the keyframes of one robot that the truth covers, ordered by x.
Positions true_positions(const PairTruth& truth, std::size_t robot, const KeyframeStamps& keyframes) {
  Positions positions;
  for (const Stamp stamp : keyframes)
    if (const auto position = true_position(truth, robot, stamp)) positions.push_back(*position);
  std::sort(positions.begin(), positions.end(),
            [](const Position& a, const Position& b) { return a.x() < b.x(); });
  return positions;
}

/// Number of pairs closer than `radius_m`; of `b` only the slab of x within reach is visited.
std::size_t count_close(const Positions& a, const Positions& b, double radius_m) {
  std::size_t close = 0;
  std::size_t slab = 0;
  for (const Position& p : a) {
    while (slab < b.size() && b[slab].x() <= p.x() - radius_m) ++slab;
    for (std::size_t k = slab; k < b.size() && b[k].x() < p.x() + radius_m; ++k)
      if ((b[k] - p).norm() < radius_m) ++close;
  }
  return close;
}

/// Whether the pair is true; nothing if the truth does not cover it.
template <class Pair>
std::optional<bool> is_true_pair(const Pair& pair, const PairTruth& truth) {
  const auto a = true_position(truth, pair.robot_i.index(), pair.stamp_i);
  const auto b = true_position(truth, pair.robot_j.index(), pair.stamp_j);
  if (!a || !b) return std::nullopt;
  return (*a - *b).norm() < truth.reach_m[pair.robot_i.index()] + truth.reach_m[pair.robot_j.index()];
}

void check_shapes(const PairTruth& truth) {
  RADIOSLAM_CHECK(truth.reach_m.size() == truth.truth.robots.size(), "every robot has one reach");
}

}  // namespace

std::vector<double> reach_for_radius(std::size_t robots, double radius_m) {
  return std::vector<double>(robots, radius_m / 2);
}

PairCounts count_candidates(const std::vector<KeyframeStamps>& keyframes, const CandidateList& candidates,
                            const PairTruth& truth) {
  check_shapes(truth);
  RADIOSLAM_CHECK(keyframes.size() == truth.reach_m.size(), "every robot has keyframes and one truth");
  std::vector<Positions> team;
  for (std::size_t robot = 0; robot < keyframes.size(); ++robot)
    team.push_back(true_positions(truth, robot, keyframes[robot]));

  PairCounts counts;
  for (std::size_t i = 0; i < team.size(); ++i)
    for (std::size_t j = i + 1; j < team.size(); ++j) {
      counts.pairs += team[i].size() * team[j].size();
      counts.true_pairs += count_close(team[i], team[j], truth.reach_m[i] + truth.reach_m[j]);
    }
  for (const auto& candidate : candidates)
    if (const auto is_true = is_true_pair(candidate, truth)) {
      ++counts.kept;
      counts.true_kept += *is_true ? 1U : 0U;
    }
  return counts;
}

PairCounts count_closures(const std::vector<ClosureResult>& closures, const PairTruth& truth) {
  check_shapes(truth);
  PairCounts counts;
  for (const auto& closure : closures) {
    const auto is_true = is_true_pair(closure, truth);
    if (!is_true || closure.robot_i == closure.robot_j) continue;
    const bool kept = closure.status == ClosureStatus::kAccepted;
    ++counts.pairs;
    counts.true_pairs += *is_true ? 1U : 0U;
    counts.kept += kept ? 1U : 0U;
    counts.true_kept += *is_true && kept ? 1U : 0U;
  }
  return counts;
}

}  // namespace radioslam
