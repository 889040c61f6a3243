#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>

#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/csi_yaml.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/text/yaml_insertion.hpp"
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

/// The settings of `robot` that the mission.yaml `file` does not give its robot of this name: those that
/// differ from this program's defaults, which are all that an importer knows.
std::vector<Setting> settings_to_add(const Robot& robot, const Antennas& antennas, const MissionFile& file) {
  const auto named = std::find_if(file.mission.robots.begin(), file.mission.robots.end(),
                                  [&](const Robot& other) { return other.id == robot.id; });
  const auto place = static_cast<std::size_t>(named - file.mission.robots.begin());
  const std::vector<Setting> plain = settings_of({}, {}), stated = settings_of(*named, file.antennas[place]);
  std::vector<Setting> added = settings_of(robot, antennas);
  for (std::size_t k = added.size(); k-- > 0;)
    if (added[k] == plain[k] || added[k] == stated[k])
      added.erase(added.begin() + static_cast<std::ptrdiff_t>(k));
  return added;
}

/// Adds a setting to a robot's entry, unless it is there already, which is kept with a note.
void add_setting(Text& yaml, const std::string& id, const Setting& setting, std::vector<std::string>& notes) {
  const YAML::Node entry = YAML::Load(yaml.content)["robots"][id];
  if (entry.IsMap() && entry[setting.first].IsDefined())
    notes.push_back("mission.yaml keeps its '" + setting.first + "' of robot '" + id +
                    "'; the recording's would be " + setting.second);
  else
    yaml.content = with_yaml_entry(yaml, {"robots", id}, setting.first, setting.second);
}

bool has_robot(const Mission& mission, const std::string& id) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [&](const Robot& robot) { return robot.id == id; });
}

/// Whether a robot, of whose noise its importer knows nothing, gets other values than this program's
/// defaults.
bool takes_noise_of_defaults(const Robot& robot, const MissionFile& file) {
  const auto named = std::find_if(file.mission.robots.begin(), file.mission.robots.end(),
                                  [&](const Robot& other) { return other.id == robot.id; });
  const std::string plain = noise_value({});
  return !robot.odometry.empty() && noise_value(robot.odometry_noise) == plain &&
         noise_value(named->odometry_noise) != plain;
}

/// Whether the robots of `before` are the first ones of `after`, with the same settings but for those of
/// `added`.
bool is_extension(const MissionFile& before, const MissionFile& after, const Mission& added) {
  if (after.mission.robots.size() < before.mission.robots.size()) return false;
  for (std::size_t r = 0; r < before.mission.robots.size(); ++r) {
    const Robot &was = before.mission.robots[r], &is = after.mission.robots[r];
    if (was.id != is.id) return false;
    if (!has_robot(added, was.id) &&
        settings_of(was, before.antennas[r]) != settings_of(is, after.antennas[r]))
      return false;
  }
  return std::all_of(added.robots.begin(), added.robots.end(),
                     [&](const Robot& robot) { return has_robot(after.mission, robot.id); });
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

std::string extended_mission_yaml(const Text& yaml, const Mission& added, std::vector<std::string>& notes) {
  const MissionFile before = read_mission_yaml(yaml, "");
  const std::vector<Antennas> antennas = antennas_of(added);
  Text grown = yaml;
  try {
    for (const Robot& robot : added.robots)
      if (!has_robot(before.mission, robot.id))
        grown.content = with_yaml_entry(grown, {"robots"}, quoted(robot.id), "{}");
    const MissionFile plain = read_mission_yaml(grown, "");
    for (const Robot& robot : added.robots)
      if (!has_robot(before.mission, robot.id) && takes_noise_of_defaults(robot, plain))
        notes.push_back("robot '" + robot.id + "' takes the odometry noise of the defaults in mission.yaml");
    for (std::size_t r = 0; r < added.robots.size(); ++r)
      for (const Setting& setting : settings_to_add(added.robots[r], antennas[r], plain))
        add_setting(grown, added.robots[r].id, setting, notes);
    if (is_extension(before, read_mission_yaml(grown, ""), added)) return grown.content;
  } catch (const YAML::Exception&) {
  } catch (const InputError&) {
  }
  yaml.fail(before.robots_line, "a robot cannot be added to it; write '" + quoted(added.robots.front().id) +
                                    ": {}' under 'robots' and import again");
}

}  // namespace radioslam
