// The tables of a mission that no estimator reads yet: radio/ranges.csv, radio/aoa.csv, radio/anchors.csv,
// matches.csv, and each robot's imu.csv and gnss.csv. They are checked as a whole; nothing is taken from
// them. Sigmas are positive; only an anchor's may be 0, where its place is known exactly.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "radioslam/io/text.hpp"

namespace radioslam {

/// Which names an end of a measurement may have.
struct TeamNames {
  std::set<std::string, std::less<>> robots;
  std::set<std::string, std::less<>> anchors = {};
};

/// Refuse malformed rows, names that belong to nobody, and measurements of a robot by itself. A match of one
/// robot with itself ties two times of it; at one time it is refused too.
void check_ranges(const Text& text, const TeamNames& names);
void check_angles(const Text& text, const TeamNames& names);
void check_matches(const Text& text, const TeamNames& names);
/// The ids of radio/anchors.csv; refuses also an id that stands there twice or is a robot's.
std::set<std::string, std::less<>> read_anchor_ids(const Text& text, const TeamNames& names);

/// Inertial rows, which must run forward in time, and position fixes.
void check_inertial(const Text& text);
void check_fixes(const Text& text);

/// Checks those of the tables that a mission's folder has, and returns their names within it.
std::vector<std::string> check_team_tables(const std::filesystem::path& mission_folder, TeamNames names);

}  // namespace radioslam
