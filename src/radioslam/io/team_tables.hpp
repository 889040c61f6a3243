// The tables about several robots: radio/anchors.csv, radio/ranges.csv, radio/aoa.csv and matches.csv.
// Rows come in any order. Every row is checked: names that belong to nobody, numbers that are not finite,
// coordinates beyond 1e8 m, negative distances and sigmas are refused with their line.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/team_names.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// `id,x_m,y_m,z_m,sigma_m`. A position is known when x and y stand there, and z as well or the mission is
/// of the plane (z = 0). Refuses an id that stands there twice or is a robot's.
std::vector<Anchor> read_anchors(const Text& text, const TeamNames& names, int dimension);

/// `t_s,robot_i,robot_j,range_m,sigma_m[,antenna_i,antenna_j]`, in the order of time, then of the rows.
/// Refuses antennas that mission.yaml does not list, and a range without a robot or of a robot to itself.
std::vector<RangeMeasurement> read_ranges(const Text& text, const TeamNames& names);

/// `t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db`. The rows that share the
/// first three are one measurement, its paths in the order of `path`; measurements in the order of time,
/// then of their first rows. Angles are wrapped; an empty elevation was not measured, an empty power is 0.
std::vector<ArrivalMeasurement> read_arrivals(const Text& text, const TeamNames& names);

/// `robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,sigma_t_m,sigma_r_rad`, in the order of the rows.
std::vector<PoseMatch> read_matches(const Text& text, const TeamNames& names);

/// The texts that read back as the mission's. An end with a lever arm must have an antenna's name.
std::string format_anchors(const Mission& mission);
std::string format_ranges(const Mission& mission);
std::string format_arrivals(const Mission& mission);
std::string format_matches(const Mission& mission);

}  // namespace radioslam
