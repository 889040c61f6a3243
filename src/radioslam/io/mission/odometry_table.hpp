// Reads a robot's odometry from tables that other programs write, with the policy of importers
// (skipped_records.hpp):
//
//   t x y z qx qy qz qw                                TUM format (tum.hpp), also with commas, without a
//   header time,x,y,yaw                                       a header that names a time, x, y, perhaps z,
//   and yaw (or time,x,y,z,qx,qy,qz,qw                             theta, heading) or a quaternion
//
// Columns are recognised by their names (named_columns.hpp), also with a prefix: pose.position.x,
// field.pose.pose.orientation.w. Metres; radians, or degrees if the column's name says so.
#pragma once

#include <string>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// The poses as recorded. Refuses (InputError) a table without these columns, one of which most rows are
/// malformed, and whatever trajectory_of_rows refuses.
Trajectory<SE3> read_odometry_table(const Text& text, std::vector<std::string>& warnings);

}  // namespace radioslam
