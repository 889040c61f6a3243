#include "radioslam/report/live/live_changes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "radioslam/report/closure_data.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kColumns = 5;
constexpr std::array<const char*, kColumns> kNames{"t", "x", "y", "z", "heading"};
constexpr std::size_t kHeight = 3;
constexpr double kStays = 0.75;  // steps by which a value may differ from the one that is shown

std::int32_t whole_steps(double steps) {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::int32_t>(std::lround(std::clamp(steps, -kMost, kMost)));
}

std::size_t first_difference(const std::vector<std::vector<std::int32_t>>& a,
                             const std::vector<std::vector<std::int32_t>>& b) {
  std::size_t first = std::numeric_limits<std::size_t>::max();
  for (std::size_t c = 0; c < kColumns; ++c) {
    const auto [at, ignored] = std::mismatch(a[c].begin(), a[c].end(), b[c].begin(), b[c].end());
    first = std::min(first, static_cast<std::size_t>(at - a[c].begin()));
  }
  return first;
}

/// Behind the last of them that differs, of `a`.
std::size_t end_of_difference(const std::vector<std::vector<std::int32_t>>& a,
                              const std::vector<std::vector<std::int32_t>>& b) {
  std::size_t end = a[0].size();
  if (end != b[0].size()) return end;
  const auto is_same = [&](std::size_t k) {
    for (std::size_t c = 0; c < kColumns; ++c)
      if (a[c][k] != b[c][k]) return false;
    return true;
  };
  while (end > 0 && is_same(end - 1)) --end;
  return end;
}

PageData seconds(const LiveTeam& team, Stamp at) { return rounded_seconds(seconds_between(team.start, at)); }

PageData optional_metres(const std::optional<double>& value_m) {
  return value_m ? rounded_metres(*value_m) : PageData();
}

/// Those that were added.
template <class Item, class Describe>
PageData added(const std::vector<Item>& before, const std::vector<Item>& now, const Describe& describe) {
  PageData list = PageData::array();
  for (std::size_t k = std::min(before.size(), now.size()); k < now.size(); ++k)
    list.push_back(describe(now[k]));
  return list;
}

PageData cloud_data(const LiveTeam& team, const LiveCloud& cloud) {
  std::array<PageData, 3> columns{PageData::array(), PageData::array(), PageData::array()};
  for (const Eigen::Vector3f& point : cloud.points)
    for (std::size_t axis = 0; axis < columns.size(); ++axis)
      columns[axis].push_back(
          whole_steps(static_cast<double>(point[static_cast<Eigen::Index>(axis)]) / LiveChanges::kStep_m));
  return {{"robot", cloud.robot},
          {"t", whole_steps(seconds_between(team.start, cloud.keyframe) / LiveChanges::kStep_s)},
          {"x", std::move(columns[0])},
          {"y", std::move(columns[1])},
          {"z", std::move(columns[2])}};
}

PageData team_data(const LiveTeam& team) {
  PageData list = PageData::array();
  for (const LiveRobot& robot : team.robots) {
    const auto log = team.logs.find(robot.id);
    const LiveLog known = log == team.logs.end() ? LiveLog{} : log->second;
    list.push_back({{"id", robot.id},
                    {"sigma_m", optional_metres(robot.sigma_m)},
                    {"sigma_team_m", optional_metres(robot.sigma_team_m)},
                    {"here", known.here},
                    {"said", known.said}});
  }
  return list;
}

PageData peers_data(const LiveTeam& team) {
  PageData list = PageData::array();
  for (const LivePeer& peer : team.peers) {
    PageData refused = PageData::array();
    for (const auto& [what, count] : peer.refused) refused.push_back({{"what", what}, {"count", count}});
    list.push_back({{"id", peer.id},
                    {"silent_s", peer.silent_s ? rounded(*peer.silent_s, 1) : PageData()},
                    {"heard", peer.is_heard},
                    {"solves", peer.solves},
                    {"knows_of_own", peer.knows_of_own},
                    {"refused", std::move(refused)}});
  }
  return list;
}

PageData traffic_data(const LiveTeam& team) {
  PageData list = PageData::array();
  for (const LiveTraffic& of : team.traffic)
    list.push_back({{"peer", of.peer},
                    {"kind", of.kind},
                    {"sent", of.is_sent},
                    {"messages", of.messages},
                    {"bytes", of.bytes},
                    {"lost", of.lost}});
  return list;
}

}  // namespace

LiveChanges::Columns LiveChanges::in_steps(const LiveTeam& team, const LiveRobot& robot, std::size_t stride,
                                           const Columns* before) {
  Columns columns(kColumns);
  for (std::size_t k = 0; k < robot.poses.size(); k += stride) {
    const LivePose& pose = robot.poses[k];
    const Eigen::Vector3d at = pose.position_m / kStep_m;
    const std::array values{seconds_between(team.start, pose.stamp) / kStep_s, at.x(), at.y(), at.z(),
                            pose.heading_rad / kStep_rad};
    for (std::size_t c = 0; c < kColumns; ++c) {
      const std::size_t place = columns[c].size();
      const bool is_shown = before != nullptr && place < (*before)[c].size();
      const bool stays = is_shown && std::abs((*before)[c][place] - values[c]) < kStays;
      columns[c].push_back(stays ? (*before)[c][place] : whole_steps(values[c]));
    }
  }
  return columns;
}

LiveChanges::Shown LiveChanges::shown(LiveTeam team, const Shown& before) {
  Shown now;
  std::size_t poses = 0;
  for (const LiveRobot& robot : team.robots) poses += robot.poses.size();
  while (poses / now.stride > kMostPoses) now.stride *= 2;
  for (std::size_t r = 0; r < team.robots.size(); ++r) {
    const bool is_shown = r < before.poses.size() && before.stride == now.stride;
    now.poses.push_back(in_steps(team, team.robots[r], now.stride, is_shown ? &before.poses[r] : nullptr));
    team.robots[r].poses.clear();
  }
  now.team = std::move(team);
  return now;
}

PageData LiveChanges::robots_data(const Shown& before, const Shown& now) {
  PageData list = PageData::array();
  const Columns nothing(kColumns);
  for (std::size_t r = 0; r < now.poses.size(); ++r) {
    const bool is_new = r >= before.poses.size();
    const LiveRobot& robot = now.team.robots[r];
    const Columns &was = is_new ? nothing : before.poses[r], &is = now.poses[r];
    if (!is_new && was == is && before.team.robots[r].frame == robot.frame) continue;
    const std::size_t first = first_difference(is, was), end = std::max(first, end_of_difference(is, was));
    PageData data{
        {"robot", r}, {"id", robot.id}, {"frame", robot.frame}, {"count", is[0].size()}, {"from", first}};
    for (std::size_t c = 0; c < kColumns; ++c) {
      if (c == kHeight && now.team.dimension == 2) continue;
      PageData steps = PageData::array();
      for (std::size_t k = first; k < end; ++k) steps.push_back(is[c][k] - (k == 0 ? 0 : is[c][k - 1]));
      data[kNames[c]] = std::move(steps);
    }
    list.push_back(std::move(data));
  }
  return list;
}

/// Null if nothing changed.
PageData LiveChanges::lines_data(const Shown& before, const Shown& now) {
  const auto &was = before.team.lines, &is = now.team.lines;
  const bool is_anew = before.stride != now.stride;
  if (was == is && before.team.closures == now.team.closures && !is_anew) return nullptr;
  PageData data{{"groups", PageData::array()}};
  std::map<std::pair<ClosureKind, ClosureStatus>, std::size_t> groups;
  for (const auto& [group, count] : now.team.closures) {
    groups.emplace(group, groups.size());
    data["groups"].push_back(
        {{"kind", name_of(group.first)}, {"status", name_of(group.second)}, {"count", count}});
  }
  // Lines name their group by its place in this list.
  const bool has_same_groups =
      std::equal(before.team.closures.begin(), before.team.closures.end(), now.team.closures.begin(),
                 now.team.closures.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  std::size_t first = 0;
  if (has_same_groups && !is_anew)
    first = static_cast<std::size_t>(std::mismatch(is.begin(), is.end(), was.begin(), was.end()).first -
                                     is.begin());
  data["from"] = first;
  for (const char* key : {"group", "robot_i", "keyframe_i", "robot_j", "keyframe_j"})
    data[key] = PageData::array();
  for (std::size_t k = first; k < is.size(); ++k) {
    const auto group = groups.find({is[k].kind, is[k].status});
    data["group"].push_back(group == groups.end() ? 0 : group->second);
    data["robot_i"].push_back(is[k].robot_i);
    data["keyframe_i"].push_back(is[k].keyframe_i / now.stride);
    data["robot_j"].push_back(is[k].robot_j);
    data["keyframe_j"].push_back(is[k].keyframe_j / now.stride);
  }
  return data;
}

PageData LiveChanges::describe(const Shown& before, const Shown& now) {
  const LiveTeam &was = before.team, &is = now.team;
  PageData data{
      {"t", seconds(is, is.now)}, {"rate", rounded_relative(is.rate)}, {"robots", robots_data(before, now)}};
  if (PageData lines = lines_data(before, now); !lines.is_null()) data["lines"] = std::move(lines);
  data["clouds"] = added(was.clouds, is.clouds, [&](const auto& cloud) { return cloud_data(is, *cloud); });
  data["team"] = team_data(is);
  data["peers"] = peers_data(is);
  data["sent"] = traffic_data(is);
  data["known"] = added(was.known, is.known, [&](const LiveKnown& known) -> PageData {
    return {{"t", seconds(is, known.at)},
            {"share", rounded(known.share, 4)},
            {"error_m", optional_metres(known.error_m)}};
  });
  data["sigmas"] = added(was.sigmas, is.sigmas, [&](const LiveSigma& sigma) -> PageData {
    return {{"t", seconds(is, sigma.at)},
            {"sigma_m", rounded_metres(sigma.sigma_m)},
            {"sigma_team_m", rounded_metres(sigma.sigma_team_m)}};
  });
  data["events"] = added(was.events, is.events, [&](const auto& event) -> PageData {
    return {{"t", seconds(is, event.first)}, {"what", event.second}};
  });
  return data;
}

PageData LiveChanges::next(LiveTeam team) {
  Shown now = shown(std::move(team), shown_);
  PageData data = describe(shown_, now);
  shown_ = std::move(now);
  return data;
}

PageData LiveChanges::whole() const {
  PageData data = describe({}, shown_);
  data["whole"] = true;
  return data;
}

}  // namespace radioslam
