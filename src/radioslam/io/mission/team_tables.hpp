// Reads and writes the tables of a team: radio/anchors.csv, radio/ranges.csv, radio/aoa.csv and matches.csv.
// Rows may be in any order. Refused (InputError, with the line) are unknown names, numbers that are not
// finite, coordinates beyond 1e8 m, and negative distances and sigmas.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/io/mission/team_names.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

// Names of the columns of matches.csv.

inline constexpr std::string_view kMatchPoseColumns = "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw";
inline constexpr std::string_view kMatchSigmaColumns = "sigma_t_m,sigma_r_rad";

/// cov_tx_tx, cov_tx_ty, ..., cov_rz_rz: the upper triangle of a match's covariance, row by row.
inline std::vector<std::string> match_covariance_columns() {
  constexpr std::string_view kAxes[] = {"tx", "ty", "tz", "rx", "ry", "rz"};
  std::vector<std::string> names;
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = row; column < 6; ++column)
      names.push_back("cov_" + std::string(kAxes[row]) + "_" + std::string(kAxes[column]));
  return names;
}

/// `id,x_m,y_m,z_m,sigma_m`. A position is known if x and y are given, and also z unless the mission is
/// planar (z = 0). Refuses an id that appears twice or is a robot's.
std::vector<Anchor> read_anchors(const Text& text, const TeamNames& names, int dimension);

/// `t_s,robot_i,robot_j,range_m,sigma_m[,antenna_i,antenna_j]`, sorted by time, then in the order of
/// the rows. Refuses antennas that mission.yaml does not list, ranges without a robot, and ranges of a robot
/// to itself.
std::vector<RangeMeasurement> read_ranges(const Text& text, const TeamNames& names);

/// `t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db`. Rows with equal
/// first three columns form one measurement, with its paths in the order of `path`; measurements are sorted
/// by time, then by their first rows. Angles are wrapped; an empty elevation was not measured, an empty power
/// is 0.
std::vector<AoaMeasurement> read_aoa(const Text& text, const TeamNames& names);

/// Whether the azimuths are in degrees: a finding if more than one in twenty is beyond a full turn.
std::optional<Finding> check_azimuth_unit(const Text& text);

/// `robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,sigma_t_m,sigma_r_rad`, in the order of the rows. The 21
/// columns `cov_tx_tx` ... `cov_rz_rz`, the upper triangle of the covariance row by row, take the place of
/// the two sigmas where the table has them; refuses a covariance that is not positive definite.
std::vector<PoseMatch> read_matches(const Text& text, const TeamNames& names);

/// The tables as text, which read back as the same values. An end with a lever arm must name its antenna.
/// Matches have two sigmas if all their covariances are isotropic, else the 21 columns.
std::string format_anchors(const Mission& mission);
std::string format_ranges(const Mission& mission);
std::string format_aoa(const Mission& mission);
std::string format_matches(const Mission& mission);

/// aoa.csv row by row: the paths of one measurement, numbered from 0.
inline constexpr std::string_view kAoaHeader =
    "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n";
void append_aoa_rows(std::string& out, Stamp stamp, const std::string& receiver,
                     const std::string& transmitter, const std::vector<AoaPath>& paths);

}  // namespace radioslam
