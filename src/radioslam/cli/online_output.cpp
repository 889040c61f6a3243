#include "radioslam/cli/online_output.hpp"

#include <algorithm>
#include <iomanip>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam::cli {
namespace {

std::string seconds_text(Stamp stamp) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << stamp.seconds();
  return text.str();
}

const char* name_of(Effort effort) {
  return effort == Effort::kExtend ? "extend" : effort == Effort::kJudge ? "judge" : "align";
}

/// The robot's keyframes since it is in the frame in which it ended.
Trajectory<SE3> online_trajectory(const StreamedTeam& team, std::size_t robot) {
  std::vector<StampedPose<SE3>> rows;
  std::optional<std::size_t> frame;
  for (auto keyframe = team.keyframes.rbegin(); keyframe != team.keyframes.rend(); ++keyframe) {
    if (keyframe->robot != robot) continue;
    if (!frame) frame = keyframe->frame;
    if (keyframe->frame == *frame) rows.push_back({keyframe->stamp, keyframe->T_frame_body});
  }
  std::reverse(rows.begin(), rows.end());
  return Trajectory<SE3>(std::move(rows));
}

/// A keyframe, and the estimates made since the one said before it.
struct SaidKeyframe {
  const OnlineKeyframe* keyframe = nullptr;
  std::optional<Effort> effort = {};  ///< the largest
  double solve_s = 0;
};

/// By robot and number.
std::map<std::pair<std::size_t, std::uint32_t>, SaidKeyframe> said_keyframes(const StreamedTeam& team) {
  std::map<std::pair<std::size_t, std::uint32_t>, SaidKeyframe> keyframes;
  std::size_t next = 0;  // estimate
  for (const OnlineKeyframe& keyframe : team.keyframes) {
    SaidKeyframe& said = keyframes[{keyframe.robot, keyframe.number}];
    said.keyframe = &keyframe;
    for (; keyframe.estimate && next <= *keyframe.estimate; ++next) {
      const OnlineEstimate& estimate = team.estimates[next];
      said.effort = std::max(said.effort.value_or(estimate.effort), estimate.effort);
      said.solve_s += estimate.seconds;
    }
  }
  return keyframes;
}

/// The robots of its frame, and the last error of a frame that was measured.
std::string team_columns(const Mission& mission, const StreamedTeam& team, const SaidKeyframe& said) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(3);
  if (said.effort)
    text << 1000 * said.solve_s << ',' << name_of(*said.effort) << ',';
  else
    text << ",,";
  const OnlineKeyframe& keyframe = *said.keyframe;
  if (!keyframe.estimate) {
    text << mission.robots[keyframe.robot].id << ',';
    return text.str();
  }
  const std::vector<std::size_t>& frames = team.estimates[*keyframe.estimate].frame;
  const char* separator = "";
  for (std::size_t r = 0; r < frames.size(); ++r)
    if (frames[r] == frames[keyframe.robot]) text << separator << mission.robots[r].id, separator = " ";
  text << ',';
  for (std::size_t k = *keyframe.estimate + 1; k-- > 0;)
    if (const auto& error_m = team.estimates[k].error_m) {
      text << *error_m;
      break;
    }
  return text.str();
}

}  // namespace

StreamResult stream_result(const Mission& mission, const Streamed& streamed) {
  StreamResult result;
  for (const OnlineEstimate& estimate : streamed.team.estimates) {
    const std::set<std::size_t> frames(estimate.frame.begin(), estimate.frame.end());
    result.estimates.push_back({estimate.at, name_of(estimate.effort), frames.size(), estimate.error_m});
  }
  for (std::size_t r = 0; r < streamed.robots.size(); ++r)
    for (const FrontEndEvent& event : streamed.robots[r].events)
      result.events.push_back({event.stamp, "robot " + mission.robots[r].id + ": " + event.what});
  for (const TeamEvent& event : streamed.team.events)
    result.events.push_back({event.at, event.what, event.is_join});
  std::stable_sort(result.events.begin(), result.events.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  return result;
}

std::vector<std::string> event_notes(const StreamResult& stream) {
  std::vector<std::string> notes;
  for (const auto& event : stream.events)
    notes.push_back("at " + seconds_text(event.at) + " s: " + event.what);
  return notes;
}

void write_online(const std::filesystem::path& folder, const Mission& mission, const Streamed& streamed) {
  const auto& robots = streamed.robots;
  const auto keyframes = said_keyframes(streamed.team);
  std::ostringstream table;
  table << "t_s,robot,keyframe,latency_ms,solve_ms,effort,component,ate_m,delay_s\n" << std::fixed;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const std::string& id = mission.robots[r].id;
    write_file(folder / (id + ".online.tum"), format_tum(online_trajectory(streamed.team, r)));
    for (const ReplayedPose& pose : robots[r].poses) {
      if (!pose.keyframe && !robots[r].follows_scans) continue;
      table << std::setprecision(9) << pose.pose.stamp.seconds() << ',' << id << ',';
      if (pose.keyframe) table << *pose.keyframe;
      table << ',' << std::setprecision(3) << pose.latency_ms << ',';
      const auto keyframe = pose.keyframe ? keyframes.find({r, *pose.keyframe}) : keyframes.end();
      table << (keyframe == keyframes.end() ? ",,," : team_columns(mission, streamed.team, keyframe->second))
            << ',' << std::setprecision(3) << pose.delay_s << '\n';
    }
  }
  write_file(folder / "online.csv", table.str());
}

std::string stream_text(const Mission& mission, const Streamed& streamed) {
  const auto& robots = streamed.robots;
  std::ostringstream text;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    if (!robots[r].follows_scans || robots[r].poses.empty()) continue;
    std::vector<double> latencies_ms;
    for (const ReplayedPose& pose : robots[r].poses) latencies_ms.push_back(pose.latency_ms);
    std::sort(latencies_ms.begin(), latencies_ms.end());
    const auto most = latencies_ms[std::min(latencies_ms.size() - 1, latencies_ms.size() * 99 / 100)];
    text << mission.robots[r].id << ": " << latencies_ms.size() << " scans, 99 % of them registered within "
         << std::setprecision(3) << most << " ms\n";
  }
  std::map<Effort, std::pair<std::size_t, double>> efforts;  // number, seconds
  for (const OnlineEstimate& estimate : streamed.team.estimates) {
    ++efforts[estimate.effort].first;
    efforts[estimate.effort].second += estimate.seconds;
  }
  const auto of = [&](Effort effort) {
    std::ostringstream part;
    part << efforts[effort].first << " in " << std::setprecision(2) << efforts[effort].second << " s";
    return part.str();
  };
  text << "estimates of the team: extended " << of(Effort::kExtend) << ", judged " << of(Effort::kJudge)
       << ", aligned " << of(Effort::kAlign) << '\n';
  return text.str();
}

}  // namespace radioslam::cli
