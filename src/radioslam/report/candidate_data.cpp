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
using Group = CandidateList::Group;

/// Index of the keyframe with this stamp among a robot's keyframes.
std::optional<std::size_t> keyframe_index(const RobotResult& robot, Stamp stamp) {
  const auto& estimate = robot.estimate;
  const auto found = std::lower_bound(estimate.begin(), estimate.end(), stamp,
                                      [](const auto& pose, Stamp s) { return pose.stamp < s; });
  if (found == estimate.end() || found->stamp != stamp) return std::nullopt;
  return static_cast<std::size_t>(found - estimate.begin());
}

/// Bin of each of the list's stamps among `bins` of the robot's keyframes.
std::vector<std::optional<std::size_t>> bins_of(const RobotResult& robot, const std::vector<Stamp>& stamps,
                                                std::size_t bins) {
  std::vector<std::optional<std::size_t>> result;
  for (const Stamp stamp : stamps) {
    const auto keyframe = keyframe_index(robot, stamp);
    result.push_back(keyframe ? std::optional(*keyframe * bins / robot.estimate.size()) : std::nullopt);
  }
  return result;
}

/// Candidates of two robots, the one listed first in front.
struct FilledPair {
  RobotPair robots;
  std::vector<const Group*> groups;
  std::size_t kept = 0;
};

std::vector<FilledPair> by_robots(const RunResult& result) {
  std::map<RobotPair, FilledPair> pairs;
  const auto is_drawn = [&](RobotIndex robot) {
    return robot.valid() && robot.index() < result.robots.size() &&
           !result.robots[robot.index()].estimate.empty();
  };
  for (const Group& group : result.candidates.groups()) {
    if (group.rows.empty() || !is_drawn(group.robot_i) || !is_drawn(group.robot_j)) continue;
    const RobotPair robots = std::minmax(group.robot_i.index(), group.robot_j.index());
    FilledPair& pair = pairs.try_emplace(robots, FilledPair{robots, {}, 0}).first->second;
    pair.groups.push_back(&group);
    pair.kept += group.rows.size();
  }
  std::vector<FilledPair> list;
  for (auto& [robots, pair] : pairs) list.push_back(std::move(pair));
  return list;
}

PageData matrix(const RunResult& result, const FilledPair& pair, std::size_t max_bins) {
  const auto& [first, second] = pair.robots;
  const std::size_t bins_i = std::min(result.robots[first].estimate.size(), max_bins);
  const std::size_t bins_j = std::min(result.robots[second].estimate.size(), max_bins);
  const auto of_first = bins_of(result.robots[first], result.candidates.stamps(RobotIndex(first)), bins_i);
  const auto of_second = bins_of(result.robots[second], result.candidates.stamps(RobotIndex(second)), bins_j);
  std::vector<std::size_t> counts(bins_i * bins_j, 0);
  for (const Group* group : pair.groups)
    for (const CandidateList::Row& row : group->rows) {
      const bool in_order = group->robot_i.index() == first;
      const auto i = of_first[in_order ? row.keyframe_i : row.keyframe_j];
      const auto j = of_second[in_order ? row.keyframe_j : row.keyframe_i];
      if (i && j) ++counts[*j * bins_i + *i];
    }
  PageData cell = PageData::array(), count = cell;
  for (std::size_t place = 0; place < counts.size(); ++place) {
    if (counts[place] == 0) continue;
    cell.push_back(place);
    count.push_back(counts[place]);
  }
  return {{"robot_i", first}, {"robot_j", second},       {"kept", pair.kept},        {"bins_i", bins_i},
          {"bins_j", bins_j}, {"cell", std::move(cell)}, {"count", std::move(count)}};
}

PageData count_of(const RunResult& result, const char* key) {
  const auto found = result.counts.find(key);
  return found == result.counts.end() ? PageData() : rounded(found->second, 0);
}

}  // namespace

PageData candidate_data(const RunResult& result, const ReportParams& params) {
  std::vector<FilledPair> pairs = by_robots(result);
  const std::size_t robot_pairs = pairs.size();
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const FilledPair& a, const FilledPair& b) { return a.kept > b.kept; });
  pairs.resize(std::min(pairs.size(), static_cast<std::size_t>(params.max_matrices)));
  const double cells_each =
      params.max_candidate_cells / static_cast<double>(std::max<std::size_t>(pairs.size(), 1));
  const auto max_bins = std::clamp(static_cast<std::size_t>(std::sqrt(cells_each)), kMinBins, kMaxBins);
  PageData matrices = PageData::array();
  for (const FilledPair& pair : pairs) matrices.push_back(matrix(result, pair, max_bins));
  const auto kept = result.counts.find("candidates");
  return {
      {"kept", kept == result.counts.end() ? PageData(result.candidates.size()) : rounded(kept->second, 0)},
      {"listed", result.candidates.size()},
      {"pairs", count_of(result, "pairs")},
      {"distances_evaluated", count_of(result, "distances_evaluated")},
      {"robot_pairs", robot_pairs},
      {"matrices", std::move(matrices)}};
}

}  // namespace radioslam
