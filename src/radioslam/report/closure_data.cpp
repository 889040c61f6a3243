#include "radioslam/report/closure_data.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "radioslam/base/statistics.hpp"

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

using ClosureGroup = std::pair<ClosureKind, ClosureStatus>;
using Reason = std::tuple<ClosureKind, ClosureStatus, std::string>;
using StatisticsByReason = std::map<Reason, std::vector<double>>;

std::map<ClosureGroup, std::vector<std::size_t>> by_group(const std::vector<ClosureResult>& closures) {
  std::map<ClosureGroup, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < closures.size(); ++c)
    groups[{closures[c].kind, closures[c].status}].push_back(c);
  return groups;
}

Reason reason_of(const ClosureResult& closure) { return {closure.kind, closure.status, closure.reason}; }

StatisticsByReason by_reason(const std::vector<ClosureResult>& closures) {
  StatisticsByReason statistics;
  for (const auto& closure : closures) statistics[reason_of(closure)].push_back(closure.statistic);
  return statistics;
}

PageData reason_rows(const StatisticsByReason& statistics) {
  PageData rows = PageData::array();
  for (const auto& [reason, values] : statistics) {
    rows.push_back({{"kind", name_of(std::get<0>(reason))},
                    {"status", name_of(std::get<1>(reason))},
                    {"reason", std::get<2>(reason)},
                    {"count", values.size()},
                    {"statistic_median", rounded_relative(upper_median(values))}});
  }
  return rows;
}

/// The keyframe at `stamp`, or the first one after it.
std::size_t keyframe_at(const Trajectory<SE3>& estimate, Stamp stamp) {
  const auto found = std::lower_bound(estimate.begin(), estimate.end(), stamp,
                                      [](const auto& pose, Stamp s) { return pose.stamp < s; });
  const auto index = static_cast<std::size_t>(found - estimate.begin());
  return std::min(index, estimate.size() - 1);
}

/// The lines on the map, column by column.
class DrawnClosures {
 public:
  DrawnClosures(const RunResult& result, const DrawnKeyframes& keyframes,
                const StatisticsByReason& statistics)
      : result_(result), keyframes_(keyframes) {
    for (const auto& [reason, values] : statistics) reason_rows_.emplace(reason, reason_rows_.size());
  }

  /// False if an end has no drawn keyframe.
  bool add(const ClosureResult& closure, std::size_t group) {
    if (!has_place(closure.robot_i, closure.stamp_i) || !has_place(closure.robot_j, closure.stamp_j))
      return false;
    group_.push_back(group);
    reason_.push_back(reason_rows_.at(reason_of(closure)));
    robot_i_.push_back(closure.robot_i.value);
    keyframe_i_.push_back(place(closure.robot_i, closure.stamp_i));
    robot_j_.push_back(closure.robot_j.value);
    keyframe_j_.push_back(place(closure.robot_j, closure.stamp_j));
    statistic_.push_back(rounded(closure.statistic, 3));
    return true;
  }

  PageData data() const {
    return {{"group", group_},           {"reason", reason_},   {"robot_i", robot_i_},
            {"keyframe_i", keyframe_i_}, {"robot_j", robot_j_}, {"keyframe_j", keyframe_j_},
            {"statistic", statistic_}};
  }

 private:
  bool has_place(RobotIndex robot, Stamp stamp) const {
    if (!robot.valid() || robot.index() >= keyframes_.size() || keyframes_[robot.index()].empty())
      return false;
    const auto& untied = result_.robots[robot.index()].untied;
    return std::none_of(untied.begin(), untied.end(), [&](const UntiedStretch& stretch) {
      return stretch.first <= stamp && stamp <= stretch.last;
    });
  }
  std::size_t place(RobotIndex robot, Stamp stamp) const {
    return nearest_kept(keyframes_[robot.index()],
                        keyframe_at(result_.robots[robot.index()].estimate, stamp));
  }

  const RunResult& result_;
  const DrawnKeyframes& keyframes_;
  std::map<Reason, std::size_t> reason_rows_;
  PageData group_ = PageData::array(), reason_ = group_, robot_i_ = group_, keyframe_i_ = group_,
           robot_j_ = group_, keyframe_j_ = group_, statistic_ = group_;
};

}  // namespace

const char* name_of(ClosureKind kind) {
  switch (kind) {
    case ClosureKind::kRange:
      return "range";
    case ClosureKind::kAoa:
      return "aoa";
    case ClosureKind::kFingerprint:
      return "fingerprint";
    case ClosureKind::kSequence:
      return "sequence";
    case ClosureKind::kLidar:
      return "lidar";
    case ClosureKind::kMatch:
      return "match";
    case ClosureKind::kFile:
      return "file";
  }
  return "";
}

const char* name_of(ClosureStatus status) {
  return status == ClosureStatus::kAccepted ? "accepted" : "rejected";
}

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

PageData closure_data(const RunResult& result, const DrawnKeyframes& keyframes, const ReportParams& params) {
  const auto& closures = result.closures;
  const auto budget = static_cast<std::size_t>(std::max(params.max_closures, 2));
  const StatisticsByReason statistics = by_reason(closures);
  PageData groups = PageData::array();
  DrawnClosures lines(result, keyframes, statistics);
  for (const auto& [group, members] : by_group(closures)) {
    const std::size_t limit = part_of_budget(members.size(), closures.size(), budget);
    std::size_t drawn = 0;
    for (const std::size_t m : evenly_spaced(members.size(), limit))
      if (lines.add(closures[members[m]], groups.size())) ++drawn;
    groups.push_back({{"kind", name_of(group.first)},
                      {"status", name_of(group.second)},
                      {"count", members.size()},
                      {"drawn", drawn}});
  }
  return {{"groups", groups}, {"reasons", reason_rows(statistics)}, {"drawn", lines.data()}};
}

PageData compared_closure_data(const ClosuresByKind& closures) {
  PageData rows = PageData::array();
  for (const auto& [kind, counts] : closures) {
    rows.push_back({{"kind", name_of(kind)},
                    {"accepted", counts.accepted},
                    {"true_accepted", counts.true_accepted},
                    {"rejected", counts.rejected},
                    {"true_rejected", counts.true_rejected}});
    if (kind != ClosureKind::kAoa) continue;
    rows.back()["direct_found"] = counts.direct_found;
    rows.back()["wrong_path"] = counts.wrong_path;
    rows.back()["none_direct"] = counts.none_direct;
  }
  return rows;
}

PageData place_data(const RunResult& result, const ClosuresByKind& compared_closures) {
  const auto pairs = result.counts.find("place_pairs");
  if (pairs == result.counts.end() || pairs->second <= 0) return {};
  const auto accepted =
      std::count_if(result.closures.begin(), result.closures.end(), [](const ClosureResult& closure) {
        return closure.kind == ClosureKind::kLidar && closure.robot_i != closure.robot_j &&
               closure.status == ClosureStatus::kAccepted;
      });
  PageData data{{"pairs", count_of(result, "place_pairs")},
                {"allowed", count_of(result, "place_pairs_allowed")},
                {"compared", count_of(result, "descriptor_pairs")},
                {"registered", count_of(result, "registrations")},
                {"verified", count_of(result, "registrations_verified")},
                {"accepted", accepted}};
  if (const auto compared = compared_closures.find(ClosureKind::kLidar);
      compared != compared_closures.end()) {
    data["true"] = compared->second.true_accepted;
    data["false"] = compared->second.accepted - compared->second.true_accepted;
  }
  return data;
}

}  // namespace radioslam
