// Reads and writes trajectories in the TUM format: one pose per line, `t x y z qx qy qz qw`, seconds and
// metres, '#' comments. Stamps are exact to the nanosecond in both directions; quaternions, which must be
// near unit length, are normalised on reading.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Refuses (InputError) times that do not increase, quaternions whose norm differs from 1 by more than
/// kUnitQuaternionTolerance, and a text without poses.
Trajectory<SE3> read_tum(const Text& text);

// Trajectories that other programs logged, which are read with the policy of importers (skipped_records.hpp).

/// A row of such a log.
struct TrajectoryRow {
  StampedPose<SE3> pose;
  std::size_t line = 0;
};

/// The trajectory of all rows: those out of order by at most a second are sorted; others that are out of
/// order, and second ones of a time, are left out with a warning. Refuses (InputError) rows of which more
/// than a tenth would be left out, and none at all.
Trajectory<SE3> trajectory_of_rows(const Text& text, const std::vector<TrajectoryRow>& rows,
                                   std::vector<std::string>& warnings);

/// Reads the TUM format; rows that are malformed are left out with a warning. Refuses (InputError) what
/// trajectory_of_rows does, and a text of which most rows are malformed.
Trajectory<SE3> read_logged_tum(const Text& text, std::vector<std::string>& warnings);

std::string format_tum(const Trajectory<SE3>& trajectory);

}  // namespace radioslam
