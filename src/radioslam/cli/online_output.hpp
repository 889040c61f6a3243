// What `run --stream` says beside the final estimate: each robot's poses as the team knew them when they were
// added, and what was noticed on the way.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/front_end/replay.hpp"
#include "radioslam/live/team_stream.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/results/stream_result.hpp"

namespace radioslam::cli {

/// A mission that was streamed.
struct Streamed {
  std::vector<ReplayedRobot> robots;
  StreamedTeam team;
};

/// Writes `<robot>.online.tum` and online.csv (docs/formats.md, "Output").
void write_online(const std::filesystem::path& folder, const Mission& mission, const Streamed& streamed);

/// Of all robots and of the team, for the report.
StreamResult stream_result(const Mission& mission, const Streamed& streamed);
std::vector<std::string> event_notes(const StreamResult& stream);

/// "720 scans, 99 % of them registered within 31 ms", a line a robot with scans; and how often
/// the team was estimated, in what time.
std::string stream_text(const Mission& mission, const Streamed& streamed);

}  // namespace radioslam::cli
