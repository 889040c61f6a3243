// What `run --stream` says beside the final estimate: each robot's poses as they were known when they were
// added, and what its front end noticed on the way.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/front_end/replay.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam::cli {

/// Of all robots, in time order.
std::vector<std::string> event_notes(const Mission& mission, const std::vector<ReplayedRobot>& robots);

/// Writes `<robot>.online.tum` and online.csv (docs/formats.md, "Output").
void write_online(const std::filesystem::path& folder, const Mission& mission,
                  const std::vector<ReplayedRobot>& robots);

/// "720 scans, 99 % of them registered within 31 ms", a line a robot with scans.
std::string latency_text(const Mission& mission, const std::vector<ReplayedRobot>& robots);

}  // namespace radioslam::cli
