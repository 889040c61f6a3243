#include "radioslam/cli/online_output.hpp"

#include <algorithm>
#include <iomanip>
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

Trajectory<SE3> online_trajectory(const ReplayedRobot& robot) {
  std::vector<StampedPose<SE3>> rows;
  for (const ReplayedPose& pose : robot.poses)
    if (pose.keyframe) rows.push_back({pose.pose.stamp, pose.pose.T_start_body});
  return Trajectory<SE3>(std::move(rows));
}

}  // namespace

std::vector<std::string> event_notes(const Mission& mission, const std::vector<ReplayedRobot>& robots) {
  std::vector<std::pair<Stamp, std::string>> events;
  for (std::size_t r = 0; r < robots.size(); ++r)
    for (const FrontEndEvent& event : robots[r].events)
      events.emplace_back(event.stamp, "robot " + mission.robots[r].id + ", at " + seconds_text(event.stamp) +
                                           " s: " + event.what);
  std::stable_sort(events.begin(), events.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> notes;
  for (auto& [stamp, note] : events) notes.push_back(std::move(note));
  return notes;
}

void write_online(const std::filesystem::path& folder, const Mission& mission,
                  const std::vector<ReplayedRobot>& robots) {
  std::ostringstream table;
  table << "t_s,robot,keyframe,latency_ms,delay_s\n" << std::fixed;
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const std::string& id = mission.robots[r].id;
    write_file(folder / (id + ".online.tum"), format_tum(online_trajectory(robots[r])));
    for (const ReplayedPose& pose : robots[r].poses) {
      if (!pose.keyframe && !robots[r].follows_scans) continue;
      table << std::setprecision(9) << pose.pose.stamp.seconds() << ',' << id << ',';
      if (pose.keyframe) table << *pose.keyframe;
      table << ',' << std::setprecision(3) << pose.latency_ms << ',' << pose.delay_s << '\n';
    }
  }
  write_file(folder / "online.csv", table.str());
}

std::string latency_text(const Mission& mission, const std::vector<ReplayedRobot>& robots) {
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
  return text.str();
}

}  // namespace radioslam::cli
