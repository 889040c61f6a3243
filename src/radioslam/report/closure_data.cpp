#include "radioslam/report/closure_data.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/report/rounding.hpp"

namespace radioslam {
namespace {

using ClosureGroup = std::pair<ClosureKind, ClosureStatus>;
using Reason = std::tuple<ClosureKind, ClosureStatus, std::string>;

const char* name(ClosureKind kind) {
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

const char* name(ClosureStatus status) {
  return status == ClosureStatus::kAccepted ? "accepted" : "rejected";
}

std::map<ClosureGroup, std::vector<std::size_t>> by_group(const std::vector<ClosureResult>& closures) {
  std::map<ClosureGroup, std::vector<std::size_t>> groups;
  for (std::size_t c = 0; c < closures.size(); ++c)
    groups[{closures[c].kind, closures[c].status}].push_back(c);
  return groups;
}

PageData reason_rows(const std::vector<ClosureResult>& closures) {
  std::map<Reason, std::vector<double>> statistics;
  for (const auto& closure : closures)
    statistics[{closure.kind, closure.status, closure.reason}].push_back(closure.statistic);
  PageData rows = PageData::array();
  for (const auto& [reason, values] : statistics) {
    rows.push_back({{"kind", name(std::get<0>(reason))},
                    {"status", name(std::get<1>(reason))},
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
  DrawnClosures(const RunResult& result, const DrawnKeyframes& keyframes)
      : result_(result), keyframes_(keyframes) {}

  /// False if an end has no drawn keyframe.
  bool add(const ClosureResult& closure, std::size_t group) {
    if (!has_place(closure.robot_i) || !has_place(closure.robot_j)) return false;
    group_.push_back(group);
    robot_i_.push_back(closure.robot_i.value);
    keyframe_i_.push_back(place(closure.robot_i, closure.stamp_i));
    robot_j_.push_back(closure.robot_j.value);
    keyframe_j_.push_back(place(closure.robot_j, closure.stamp_j));
    statistic_.push_back(rounded(closure.statistic, 2));
    return true;
  }

  PageData data() const {
    return {{"group", group_},     {"robot_i", robot_i_},       {"keyframe_i", keyframe_i_},
            {"robot_j", robot_j_}, {"keyframe_j", keyframe_j_}, {"statistic", statistic_}};
  }

 private:
  bool has_place(RobotIndex robot) const {
    return robot.valid() && robot.index() < keyframes_.size() && !keyframes_[robot.index()].empty();
  }
  std::size_t place(RobotIndex robot, Stamp stamp) const {
    return nearest_kept(keyframes_[robot.index()],
                        keyframe_at(result_.robots[robot.index()].estimate, stamp));
  }

  const RunResult& result_;
  const DrawnKeyframes& keyframes_;
  PageData group_ = PageData::array(), robot_i_ = group_, keyframe_i_ = group_, robot_j_ = group_,
           keyframe_j_ = group_, statistic_ = group_;
};

}  // namespace

PageData closure_data(const RunResult& result, const DrawnKeyframes& keyframes, const ReportParams& params) {
  const auto& closures = result.closures;
  const auto budget = static_cast<std::size_t>(std::max(params.max_closures, 2));
  PageData groups = PageData::array();
  DrawnClosures lines(result, keyframes);
  for (const auto& [group, members] : by_group(closures)) {
    const std::size_t limit = part_of_budget(members.size(), closures.size(), budget);
    std::size_t drawn = 0;
    for (const std::size_t m : evenly_spaced(members.size(), limit))
      if (lines.add(closures[members[m]], groups.size())) ++drawn;
    groups.push_back({{"kind", name(group.first)},
                      {"status", name(group.second)},
                      {"count", members.size()},
                      {"drawn", drawn}});
  }
  return {{"groups", groups}, {"reasons", reason_rows(closures)}, {"drawn", lines.data()}};
}

PageData judged_closure_data(const ClosuresByKind& closures) {
  PageData rows = PageData::array();
  for (const auto& [kind, counts] : closures) {
    rows.push_back({{"kind", name(kind)},
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

}  // namespace radioslam
