#include <algorithm>
#include <cmath>

#include "radioslam/base/check.hpp"
#include "radioslam/io/mission/team_tables.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

const std::string& name_of(const Mission& mission, const LinkEnd& end) {
  return end.robot.valid() ? mission.robots[end.robot.index()].id : mission.anchors[end.anchor.index()].id;
}

bool any_antenna(const Mission& mission) {
  for (const RangeMeasurement& range : mission.ranges)
    if (!range.i.antenna.empty() || !range.j.antenna.empty()) return true;
  return false;
}

void append_antenna(std::string& out, const LinkEnd& end) {
  RADIOSLAM_CHECK(!end.antenna.empty() || end.lever_arm_m.isZero(0),
                  "an end with a lever arm names its antenna");
  (out += ',') += end.antenna;
}

/// Whether two sigmas make exactly this covariance.
bool is_isotropic(const SE3::Jacobian& covariance) {
  return isotropic_covariance(std::sqrt(covariance(0, 0)), std::sqrt(covariance(3, 3))) == covariance;
}

void append_sigmas(std::string& out, const SE3::Jacobian& covariance) {
  append_number(out += ',', std::sqrt(covariance(0, 0)));
  append_number(out += ',', std::sqrt(covariance(3, 3)));
}

void append_covariance(std::string& out, const SE3::Jacobian& covariance) {
  for (int row = 0; row < 6; ++row)
    for (int column = row; column < 6; ++column) append_number(out += ',', covariance(row, column));
}

}  // namespace

std::string format_anchors(const Mission& mission) {
  std::string out = "id,x_m,y_m,z_m,sigma_m\n";
  for (const Anchor& anchor : mission.anchors) {
    out += anchor.id;
    for (int axis = 0; axis < 3; ++axis) {
      out += ',';
      if (anchor.position_m) append_number(out, (*anchor.position_m)(axis));
    }
    append_number(out += ',', anchor.sigma_m);
    out += '\n';
  }
  return out;
}

std::string format_ranges(const Mission& mission) {
  const bool antennas = any_antenna(mission);
  std::string out = "t_s,robot_i,robot_j,range_m,sigma_m";
  out += antennas ? ",antenna_i,antenna_j\n" : "\n";
  for (const RangeMeasurement& range : mission.ranges) {
    ((out += format_stamp(range.stamp)) += ',') += name_of(mission, range.i);
    (out += ',') += name_of(mission, range.j);
    append_number(out += ',', range.range_m);
    append_number(out += ',', range.sigma_m);
    if (antennas) append_antenna(out, range.i);
    if (antennas) append_antenna(out, range.j);
    out += '\n';
  }
  return out;
}

void append_aoa_rows(std::string& out, Stamp stamp, const std::string& receiver,
                     const std::string& transmitter, const std::vector<AoaPath>& paths) {
  const std::string start = format_stamp(stamp) + ',' + receiver + ',' + transmitter + ',';
  for (std::size_t p = 0; p < paths.size(); ++p) {
    append_number((out += start + std::to_string(p)) += ',', paths[p].azimuth_rad);
    out += ',';
    if (paths[p].elevation_rad) append_number(out, *paths[p].elevation_rad);
    append_number(out += ',', paths[p].sigma_rad);
    append_number(out += ',', paths[p].power_db);
    out += '\n';
  }
}

std::string format_aoa(const Mission& mission) {
  std::string out(kAoaHeader);
  for (const AoaMeasurement& arrival : mission.aoa_measurements)
    append_aoa_rows(out, arrival.stamp, mission.robots[arrival.receiver.index()].id,
                    name_of(mission, arrival.transmitter), arrival.paths);
  return out;
}

std::string format_matches(const Mission& mission) {
  const bool isotropic = std::all_of(mission.matches.begin(), mission.matches.end(),
                                     [](const PoseMatch& match) { return is_isotropic(match.covariance); });
  std::string out(kMatchPoseColumns);
  if (isotropic) (out += ',') += kMatchSigmaColumns;
  if (!isotropic)
    for (const std::string& name : match_covariance_columns()) (out += ',') += name;
  out += '\n';
  for (const PoseMatch& match : mission.matches) {
    out += mission.robots[match.robot_i.index()].id + ',' + format_stamp(match.stamp_i) + ',';
    out += mission.robots[match.robot_j.index()].id + ',' + format_stamp(match.stamp_j);
    for (int axis = 0; axis < 3; ++axis) append_number(out += ',', match.T_i_j.translation()(axis));
    for (int k = 0; k < 4; ++k) append_number(out += ',', match.T_i_j.rotation().coeffs()(k));
    if (isotropic)
      append_sigmas(out, match.covariance);
    else
      append_covariance(out, match.covariance);
    out += '\n';
  }
  return out;
}

}  // namespace radioslam
