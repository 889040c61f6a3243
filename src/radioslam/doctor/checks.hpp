// The checks of doctor (check_mission.hpp), by what they look at.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/doctor/team_links.hpp"
#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// What one robot's trajectory shows by itself: units, speeds, gaps, order of columns, handedness. Findings
/// about every robot with recorded odometry, and about robots with the same recording.
std::vector<Finding> check_odometry(const Mission& mission);

/// A finding per robot whose odometry leaves out more than a quarter of a recording of ten rows or more of
/// its other sensors and its links, and more than twenty seconds. Holes within the odometry are
/// check_odometry's.
std::vector<Finding> check_odometry_coverage(const Mission& mission);

/// A finding per robot whose pose repeats exactly for ten seconds or more while fixes, ranges, gyroscope or
/// WiFi say that it moves (frozen_odometry.cpp). A robot that stands still has none.
std::vector<Finding> check_frozen_odometry(const Mission& mission);
/// The same against the ground truth.
std::optional<Finding> frozen_against(const Robot& robot, const RobotTruth& truth);

/// At most one finding: matches that fit one another only as inverse poses, or with w first
/// (match_convention.cpp).
std::vector<Finding> check_matches(const Mission& mission);

/// The times of every file against those of the robot's odometry (or scans).
std::vector<Finding> check_times(const Mission& mission);

/// Robots that nothing ties to the others.
std::vector<Finding> check_connections(const Mission& mission);

/// What the recordings of single sensors show: units, repeated rows, spellings, moving access points, and
/// whether an IMU turns as the odometry does.
std::vector<Finding> check_wifi(const Mission& mission);
std::vector<Finding> check_inertial(const Mission& mission);
/// Reads a few scans of every robot.
std::vector<Finding> check_scans(const Mission& mission);

/// Holds the radio links and position fixes of a team against its dead reckoning: what does not fit is
/// explained by the likeliest correction, by a wrong start, or by a stated noise that is not the measured
/// one.
std::vector<Finding> check_links(const Mission& mission);

/// At most one finding: a stated start, or two, that fingerprints contradict (fingerprint_starts.cpp).
std::vector<Finding> check_fingerprint_starts(const Mission& mission);

/// Access points that move: carried by the robot itself, or heard with strengths that no fixed place
/// explains. Adds a finding for every one in the robot's scans. `track`: its dead reckoning, here and below.
void check_access_points(const Mission& mission, const Robot& robot, const Track& track,
                         std::vector<Finding>& findings);

/// Whether a robot's fingerprints are on the clock of its odometry (fingerprint_clock.cpp). Adds a finding if
/// a lag of two seconds or more explains similarity clearly better than none does.
void check_fingerprint_clock(const Robot& robot, const Track& track, std::vector<Finding>& findings);

/// WiFi scans that repeat older ones (stale_scans.cpp). Adds at most one finding. Scans are compared with the
/// twelve before, at places a metre or more apart by the dead reckoning; a robot that stands still, or scans
/// of fewer than five readings, show nothing.
void check_stale_scans(const Robot& robot, const Track& track, std::vector<Finding>& findings);

/// Share of common access points, times a falling function of the mean difference of their levels.
double fingerprint_similarity(const WifiScan& a, const WifiScan& b);

/// Calls `use` with both readings of every access point that both scans contain.
void for_common_readings(const WifiScan& a, const WifiScan& b, const auto& use) {
  auto x = a.readings.begin(), y = b.readings.begin();
  while (x != a.readings.end() && y != b.readings.end()) {
    if (x->access_point < y->access_point)
      ++x;
    else if (y->access_point < x->access_point)
      ++y;
    else
      use(*x++, *y++);
  }
}

/// Adds `finding` once for every robot that is the `same` as an earlier one, with its id and the other's id
/// quoted at the end of what was found. `file_of` gives the file of a robot's id.
void add_duplicates(const Mission& mission, const auto& same, const auto& file_of, const Finding& finding,
                    std::vector<Finding>& findings) {
  for (std::size_t b = 1; b < mission.robots.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) {
      if (!same(mission.robots[a], mission.robots[b])) continue;
      Finding& found = findings.emplace_back(finding);
      found.robot = mission.robots[b].id;
      found.file = file_of(found.robot);
      found.found += " robot '" + mission.robots[a].id + "'";
      break;
    }
}

}  // namespace radioslam
