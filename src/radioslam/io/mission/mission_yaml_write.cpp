#include <algorithm>
#include <array>

#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/csi_yaml.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

bool is_plain(const std::string& s) {
  constexpr std::array<std::string_view, 10> kReserved = {"true", "false", "yes", "no", "on",
                                                          "off",  "null",  "y",   "n",  "unknown"};
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto inner = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  const std::string lower = lower_case(s);
  return !s.empty() && letter(s.front()) && std::all_of(s.begin(), s.end(), inner) &&
         std::find(kReserved.begin(), kReserved.end(), lower) == kReserved.end();
}

/// A YAML scalar that is read as text.
std::string quoted(const std::string& s) {
  if (is_plain(s)) return s;
  std::string out = "\"";
  for (const char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return out + "\"";
}

std::string initial_pose_value(const std::optional<SE3>& pose) {
  if (!pose) return "unknown";
  std::string out = "[";
  for (int axis = 0; axis < 3; ++axis) out += format_number(pose->translation()(axis)) + ", ";
  return out + format_number(pose->yaw()) + "]";
}

std::string noise_value(const OdometryNoise& noise) {
  std::string out;
  for (const auto& [name, member] : kOdometryNoiseFields)
    out += (out.empty() ? "" : ", ") + std::string(name) + ": " + format_number(noise.*member);
  return "{" + out + "}";
}

std::string position_value(const Eigen::Vector3d& position) {
  return "[" + format_number(position.x()) + ", " + format_number(position.y()) + ", " +
         format_number(position.z()) + "]";
}

std::string lidar_value(const Robot& robot) {
  const double view_deg = degrees(robot.lidar_view_rad);
  return "{range_m: " + format_number(robot.lidar_range_m) + ", view_deg: " + format_number(view_deg) + "}";
}

/// The antennas of each robot that are named by ranges, and those of position fixes.
std::vector<Antennas> antennas_of(const Mission& mission) {
  std::vector<Antennas> antennas(mission.robots.size());
  for (const RangeMeasurement& range : mission.ranges)
    for (const LinkEnd* end : {&range.i, &range.j})
      if (!end->antenna.empty()) antennas[end->robot.index()][end->antenna] = end->lever_arm_m;
  for (std::size_t r = 0; r < antennas.size(); ++r)
    if (!mission.robots[r].fix_lever_m.isZero(0))
      antennas[r][std::string(kFixAntenna)] = mission.robots[r].fix_lever_m;
  return antennas;
}

std::string antennas_value(const Antennas& antennas) {
  std::string out;
  for (const auto& [name, position] : antennas)
    out += (out.empty() ? "" : ", ") + quoted(name) + ": " + position_value(position);
  return "{" + out + "}";
}

std::string csi_value(const CsiRecording& csi, const std::vector<std::string>& antennas) {
  std::vector<std::string> entries;
  if (csi.address) entries.push_back("mac: \"" + format_mac_address(*csi.address) + "\"");
  if (const auto channel = channel_of_carrier(csi.carrier_hz))
    entries.push_back("channel: " + std::to_string(*channel));
  std::string names;
  for (const std::string& name : antennas) names += (names.empty() ? "" : ", ") + quoted(name);
  if (!antennas.empty()) entries.push_back("antennas: [" + names + "]");
  std::string out;
  for (const std::string& entry : entries) out += (out.empty() ? "" : ", ") + entry;
  return "{" + out + "}";
}

using Setting = std::pair<std::string, std::string>;

std::vector<Setting> settings_of(const Robot& robot, Antennas antennas) {
  std::string csi;
  if (robot.csi) csi = csi_value(*robot.csi, name_csi_antennas(*robot.csi, antennas));
  return {{"odometry", noise_value(robot.odometry_noise)},
          {"lidar", lidar_value(robot)},
          {"heading", robot.heading == Heading::kAbsolute ? "absolute" : "relative"},
          {"sigma_heading_rad", format_number(robot.sigma_heading_rad)},
          {"initial_pose", initial_pose_value(robot.initial_pose)},
          {"antennas", antennas_value(antennas)},
          {"csi", csi}};
}

/// The settings that differ from the defaults, in flow style.
std::string overrides(const std::vector<Setting>& defaults, const std::vector<Setting>& settings) {
  std::string out;
  for (std::size_t k = 0; k < settings.size(); ++k)
    if (settings[k] != defaults[k])
      out += (out.empty() ? "" : ", ") + settings[k].first + ": " + settings[k].second;
  return "{" + out + "}";
}

}  // namespace

std::string format_mission_yaml(const Mission& mission) {
  Robot common = mission.robots.empty() ? Robot{} : mission.robots.front();
  common.initial_pose.reset();
  common.csi.reset();
  const std::vector<Setting> defaults = settings_of(common, {});
  const std::vector<Antennas> antennas = antennas_of(mission);
  std::string out = "format: radioslam-mission/1\nname: " + quoted(mission.name) +
                    "\ndimension: " + std::to_string(mission.dimension) + "\nrobots:\n";
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const Robot& robot = mission.robots[r];
    out.append("  ").append(quoted(robot.id)).append(": ");
    out.append(overrides(defaults, settings_of(robot, antennas[r]))).append("\n");
  }
  out += "defaults:\n";
  for (const auto& [key, value] : defaults)
    if (!value.empty()) out.append("  ").append(key).append(": ").append(value).append("\n");
  return out;
}

}  // namespace radioslam
