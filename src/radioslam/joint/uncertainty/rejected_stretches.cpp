#include "radioslam/joint/uncertainty/rejected_stretches.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace radioslam {
namespace {

constexpr double kRejectedThere = 0.95;
constexpr double kMaxUsualShare = 0.75;  // a kind rejected more often says nothing
constexpr double kMinUsualShare = 0.05;
constexpr double kMinScore = 20;  // of a stretch; closures of one scan share errors
constexpr double kMinDuration_s = 30;

struct ScoredStatus {
  Stamp stamp;
  double score = 0;
};

/// Scores of a rejected and an accepted closure of a kind; both 0 where the kind says nothing.
struct KindScores {
  double rejected = 0, accepted = 0;
};

/// Scans of two robots that were compared: that most do not fit says nothing of the trajectories.
bool is_trial(const ClosureResult& closure) {
  return closure.kind == ClosureKind::kLidar && closure.robot_i != closure.robot_j;
}

std::array<KindScores, kClosureKinds> kind_scores(const std::vector<ClosureResult>& closures) {
  std::array<std::size_t, kClosureKinds> all{}, rejected{};
  for (const ClosureResult& closure : closures) {
    if (is_trial(closure)) continue;
    const auto kind = static_cast<std::size_t>(closure.kind);
    ++all[kind];
    rejected[kind] += closure.status == ClosureStatus::kRejected ? 1U : 0U;
  }
  std::array<KindScores, kClosureKinds> scores;
  for (std::size_t kind = 0; kind < kClosureKinds; ++kind) {
    if (all[kind] == 0) continue;
    const double usual =
        std::max(kMinUsualShare, static_cast<double>(rejected[kind]) / static_cast<double>(all[kind]));
    if (usual > kMaxUsualShare) continue;
    scores[kind] = {std::log(kRejectedThere / usual), std::log((1 - kRejectedThere) / (1 - usual))};
  }
  return scores;
}

/// The statuses of one robot's closures, in time order.
std::vector<ScoredStatus> scored_statuses(RobotIndex robot, const std::vector<ClosureResult>& closures,
                                          const std::array<KindScores, kClosureKinds>& scores) {
  std::vector<ScoredStatus> result;
  for (const ClosureResult& closure : closures) {
    if (is_trial(closure)) continue;
    const KindScores& kind = scores[static_cast<std::size_t>(closure.kind)];
    const double score = closure.status == ClosureStatus::kRejected ? kind.rejected : kind.accepted;
    if (closure.robot_i == robot) result.push_back({closure.stamp_i, score});
    if (closure.robot_j == robot) result.push_back({closure.stamp_j, score});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const ScoredStatus& x, const ScoredStatus& y) { return x.stamp < y.stamp; });
  return result;
}

/// Adds the interval of largest sum within [begin, end) if it is large enough, and those beside it.
void add_stretches(const std::vector<ScoredStatus>& of, std::size_t begin, std::size_t end,
                   std::vector<std::pair<Stamp, Stamp>>& stretches) {
  double sum = 0, best = 0;
  std::size_t from = begin, best_from = begin, best_to = begin;
  for (std::size_t k = begin; k < end; ++k) {
    if (sum <= 0) sum = 0, from = k;
    sum += of[k].score;
    if (sum > best) best = sum, best_from = from, best_to = k + 1;
  }
  if (best < kMinScore) return;
  add_stretches(of, begin, best_from, stretches);
  if (seconds_between(of[best_from].stamp, of[best_to - 1].stamp) >= kMinDuration_s)
    stretches.emplace_back(of[best_from].stamp, of[best_to - 1].stamp);
  add_stretches(of, best_to, end, stretches);
}

}  // namespace

std::vector<std::vector<std::pair<Stamp, Stamp>>> rejected_stretches(
    std::size_t robots, const std::vector<ClosureResult>& closures) {
  const auto scores = kind_scores(closures);
  std::vector<std::vector<std::pair<Stamp, Stamp>>> result(robots);
  for (std::size_t r = 0; r < robots; ++r) {
    const auto of_robot = scored_statuses(RobotIndex(r), closures, scores);
    add_stretches(of_robot, 0, of_robot.size(), result[r]);
  }
  return result;
}

}  // namespace radioslam
