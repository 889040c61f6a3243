#include "radioslam/report/candidate_data.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/report/rounding.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMinBins = 4;
constexpr std::size_t kMaxBins = 240;  // about a pixel each

using RobotPair = std::pair<std::size_t, std::size_t>;
using KeyframePair = std::pair<std::size_t, std::size_t>;

/// Index of the keyframe with this stamp among a robot's keyframes.
std::optional<std::size_t> keyframe_index(const RunResult& result, RobotIndex robot, Stamp stamp) {
  if (!robot.valid() || robot.index() >= result.robots.size()) return std::nullopt;
  const auto& estimate = result.robots[robot.index()].estimate;
  const auto found = std::lower_bound(estimate.begin(), estimate.end(), stamp,
                                      [](const auto& pose, Stamp s) { return pose.stamp < s; });
  if (found == estimate.end() || found->stamp != stamp) return std::nullopt;
  return static_cast<std::size_t>(found - estimate.begin());
}

using FilledPairs = std::map<RobotPair, std::vector<KeyframePair>>;
using FilledPair = FilledPairs::value_type;

FilledPairs by_robots(const RunResult& result) {
  FilledPairs pairs;
  for (const CandidateResult& c : result.candidates) {
    const auto i = keyframe_index(result, c.robot_i, c.stamp_i),
               j = keyframe_index(result, c.robot_j, c.stamp_j);
    if (!i || !j) continue;
    const bool in_order = c.robot_i.index() < c.robot_j.index();
    const RobotPair robots = in_order ? RobotPair(c.robot_i.index(), c.robot_j.index())
                                      : RobotPair(c.robot_j.index(), c.robot_i.index());
    pairs[robots].push_back(in_order ? KeyframePair(*i, *j) : KeyframePair(*j, *i));
  }
  return pairs;
}

PageData matrix(const RunResult& result, const RobotPair& robots, const std::vector<KeyframePair>& pairs,
                std::size_t max_bins) {
  const std::size_t size_i = result.robots[robots.first].estimate.size();
  const std::size_t size_j = result.robots[robots.second].estimate.size();
  const std::size_t bins_i = std::min(size_i, max_bins), bins_j = std::min(size_j, max_bins);
  std::map<std::size_t, std::size_t> counts;
  for (const auto& [i, j] : pairs) ++counts[j * bins_j / size_j * bins_i + i * bins_i / size_i];
  PageData cell = PageData::array(), count = cell;
  for (const auto& [place, kept] : counts) {
    cell.push_back(place);
    count.push_back(kept);
  }
  return {{"robot_i", robots.first},  {"robot_j", robots.second}, {"kept", pairs.size()},
          {"bins_i", bins_i},         {"bins_j", bins_j},         {"cell", std::move(cell)},
          {"count", std::move(count)}};
}

PageData counted(const RunResult& result, const char* key) {
  const auto found = result.counts.find(key);
  return found == result.counts.end() ? PageData() : rounded(found->second, 0);
}

}  // namespace

PageData candidate_data(const RunResult& result, const ReportParams& params) {
  const auto pairs = by_robots(result);
  std::vector<const FilledPair*> fullest;
  for (const FilledPair& pair : pairs) fullest.push_back(&pair);
  std::stable_sort(fullest.begin(), fullest.end(), [](const FilledPair* a, const FilledPair* b) {
    return a->second.size() > b->second.size();
  });
  fullest.resize(std::min(fullest.size(), static_cast<std::size_t>(params.max_matrices)));
  const double cells_each =
      params.max_candidate_cells / static_cast<double>(std::max<std::size_t>(fullest.size(), 1));
  const auto max_bins = std::clamp(static_cast<std::size_t>(std::sqrt(cells_each)), kMinBins, kMaxBins);
  PageData matrices = PageData::array();
  for (const FilledPair* pair : fullest)
    matrices.push_back(matrix(result, pair->first, pair->second, max_bins));
  return {{"kept", result.candidates.size()},
          {"pairs", counted(result, "pairs")},
          {"distances_evaluated", counted(result, "distances_evaluated")},
          {"robot_pairs", pairs.size()},
          {"matrices", std::move(matrices)}};
}

}  // namespace radioslam
