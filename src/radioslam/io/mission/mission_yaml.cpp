#include "radioslam/io/mission/mission_yaml.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/units.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/io/csi/csi_yaml.hpp"
#include "radioslam/io/text/mac_address.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/yaml_map.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kFormat = "radioslam-mission/1";
constexpr std::size_t kPositionSize = 3;
constexpr std::size_t kInitialPoseSize = 4;  // position and yaw
constexpr double kFullView_deg = 360;

double sigma_at(const Text& text, const YAML::Node& node, const std::string& what) {
  const double value = number_at(text, node, what);
  if (value < 0) text.fail(line_of(node), what + " is negative");
  return value;
}

void read_odometry_noise(const Text& text, const YAML::Node& node, OdometryNoise& noise) {
  YamlKeyHandlers keys;
  for (const auto& [name, member] : kOdometryNoiseFields)
    keys[std::string(name)] = [&text, &noise, field = std::string(name), target = member](
                                  const YAML::Node& value) { noise.*target = sigma_at(text, value, field); };
  read_yaml_map(text, node, "odometry", keys);
}

double view_rad_at(const Text& text, const YAML::Node& node) {
  const double view_deg = number_at(text, node, "view_deg");
  if (view_deg <= 0 || view_deg > kFullView_deg) text.fail(line_of(node), "view_deg is not in (0, 360]");
  return view_deg == kFullView_deg ? 2 * std::numbers::pi : radians(view_deg);
}

void read_lidar(const Text& text, const YAML::Node& node, Robot& robot) {
  read_yaml_map(
      text, node, "lidar",
      {{"range_m",
        [&](const YAML::Node& value) {
          robot.lidar_range_m = number_at(text, value, "range_m");
          if (robot.lidar_range_m <= 0) text.fail(line_of(value), "range_m is not positive");
        }},
       {"view_deg", [&](const YAML::Node& value) { robot.lidar_view_rad = view_rad_at(text, value); }}});
}

/// The first three values of a sequence; `what` names them in error messages.
Eigen::Vector3d position_at(const Text& text, const YAML::Node& node, const std::string& what) {
  Eigen::Vector3d position;
  for (std::size_t k = 0; k < kPositionSize; ++k) {
    const double value = number_at(text, node[k], what);
    if (std::abs(value) > kMaxCoordinate_m)
      text.fail(line_of(node[k]), what + " is not a plausible coordinate (more than 1e8 m)",
                InputError::Kind::kUnit);
    position(static_cast<Eigen::Index>(k)) = value;
  }
  return position;
}

void read_antennas(const Text& text, const YAML::Node& node, Antennas& antennas) {
  for_each_key(text, node, "antennas", [&](const YamlEntry& entry) {
    const std::string what = "antenna '" + entry.key + "'";
    if (!is_valid_id(entry.key)) text.fail(entry.line, what + " does not have a valid name");
    if (!entry.value.IsSequence() || entry.value.size() != kPositionSize)
      text.fail(entry.line, what + " is not [x, y, z]");
    antennas[entry.key] = position_at(text, entry.value, what);
  });
}

Heading heading_at(const Text& text, const YAML::Node& node) {
  const std::string value = scalar_at(text, node, "heading");
  if (value == "absolute") return Heading::kAbsolute;
  if (value != "relative")
    text.fail(line_of(node), "heading '" + value + "' is neither relative nor absolute");
  return Heading::kRelative;
}

std::optional<SE3> initial_pose_at(const Text& text, const YAML::Node& node) {
  if (node.IsScalar() && node.Scalar() == "unknown") return std::nullopt;
  if (!node.IsSequence() || node.size() != kInitialPoseSize)
    text.fail(line_of(node), "initial_pose is neither unknown nor [x, y, z, yaw]");
  const Eigen::Vector3d position = position_at(text, node, "initial_pose");
  const double yaw = number_at(text, node[kPositionSize], "initial_pose");
  return SE3(position, so3_exp({0, 0, wrap_angle(yaw)}));
}

/// A yaw of more than one turn is likely to be in degrees; reading wraps it.
std::optional<Finding> yaw_finding(const Text& text, const YAML::Node& node) {
  if (!node.IsSequence() || node.size() != kInitialPoseSize) return std::nullopt;
  const double yaw = number_at(text, node[kPositionSize], "initial_pose");
  if (std::abs(yaw) <= 2 * std::numbers::pi) return std::nullopt;
  const Severity severity = std::abs(yaw) > 4 * std::numbers::pi ? Severity::kError : Severity::kWarning;
  return Finding{"unit",
                 severity,
                 "",
                 "mission.yaml",
                 "the yaw of initial_pose is " + format_number(yaw),
                 "radians",
                 "multiply it by pi/180 if it is in degrees"};
}

/// Reads the settings under defaults or under a robot.
struct RobotSettings {
  Robot robot;
  Antennas antennas;
  std::optional<CsiSettings> csi;
  std::optional<Finding> finding;
};

void apply_settings(const Text& text, const YAML::Node& node, const std::string& what,
                    RobotSettings& settings) {
  Robot& robot = settings.robot;
  read_yaml_map(
      text, node, what,
      {{"odometry", [&](const YAML::Node& value) { read_odometry_noise(text, value, robot.odometry_noise); }},
       {"lidar", [&](const YAML::Node& value) { read_lidar(text, value, robot); }},
       {"heading", [&](const YAML::Node& value) { robot.heading = heading_at(text, value); }},
       {"sigma_heading_rad",
        [&](const YAML::Node& value) {
          robot.sigma_heading_rad = sigma_at(text, value, "sigma_heading_rad");
        }},
       {"initial_pose",
        [&](const YAML::Node& value) {
          robot.initial_pose = initial_pose_at(text, value);
          settings.finding = yaw_finding(text, value);
        }},
       {"antennas", [&](const YAML::Node& value) { read_antennas(text, value, settings.antennas); }},
       {"csi", [&](const YAML::Node& value) {
          if (!settings.csi) settings.csi.emplace();
          read_csi_settings(text, value, *settings.csi);
        }}});
}

/// Refuses a card with the address of another robot's card, because their packets could not be distinguished.
void check_own_address(const Text& text, const YamlEntry& entry, const CsiRecording& csi,
                       const std::vector<Robot>& others) {
  for (const Robot& other : others)
    if (csi.address && other.csi && other.csi->address == csi.address)
      text.fail(entry.line,
                "robot '" + entry.key + "' has the same mac " + format_mac_address(*csi.address) +
                    " as robot '" + other.id + "'",
                InputError::Kind::kDuplicate);
}

void read_robots(const Text& text, const YAML::Node& node, const RobotSettings& defaults, MissionFile& file) {
  file.robots_line = line_of(node);
  for_each_key(text, node, "robots", [&](const YamlEntry& entry) {
    if (!is_valid_id(entry.key))
      text.fail(entry.line, "the robot's id '" + entry.key + "' is not a valid file name");
    RobotSettings settings = defaults;
    settings.robot.id = entry.key;
    apply_settings(text, entry.value, "robot '" + entry.key + "'", settings);
    const auto receiver = settings.antennas.find(std::string(kFixAntenna));
    if (receiver != settings.antennas.end()) settings.robot.fix_lever_m = receiver->second;
    if (settings.csi) {
      settings.robot.csi = csi_recording(text, *settings.csi, settings.antennas);
      check_own_address(text, entry, *settings.robot.csi, file.mission.robots);
    }
    if (settings.finding) {
      settings.finding->robot = entry.key;
      file.mission.reading_findings.push_back(*settings.finding);
    }
    file.mission.robots.push_back(std::move(settings.robot));
    file.antennas.push_back(std::move(settings.antennas));
    file.robot_lines.push_back(entry.line);
  });
  if (file.mission.robots.empty()) text.fail(file.robots_line, "there are no robots");
}

int dimension_at(const Text& text, const YAML::Node& node) {
  const std::string value = scalar_at(text, node, "dimension");
  if (value != "2" && value != "3") text.fail(line_of(node), "dimension '" + value + "' is neither 2 nor 3");
  return value == "2" ? 2 : 3;
}

void check_format(const Text& text, const YAML::Node& node) {
  const std::string format = scalar_at(text, node, "format");
  if (format != kFormat) text.fail(line_of(node), "format '" + format + "' is not " + std::string(kFormat));
}

MissionFile read_mission_node(const Text& text, const YAML::Node& root, const std::string& default_name) {
  MissionFile file;
  file.mission.name = default_name;
  YAML::Node format, robots, defaults;
  read_yaml_map(
      text, root, "the file",
      {{"format", [&](const YAML::Node& value) { format.reset(value); }},
       {"name", [&](const YAML::Node& value) { file.mission.name = scalar_at(text, value, "name"); }},
       {"dimension", [&](const YAML::Node& value) { file.mission.dimension = dimension_at(text, value); }},
       {"robots", [&](const YAML::Node& value) { robots.reset(value); }},
       {"defaults", [&](const YAML::Node& value) { defaults.reset(value); }}});
  if (!format.IsDefined() || format.IsNull())
    text.fail(1, "'format: " + std::string(kFormat) + "' is missing");
  check_format(text, format);
  RobotSettings common;
  apply_settings(text, defaults, "defaults", common);
  if (robots.IsNull()) text.fail(1, "'robots' is missing");
  read_robots(text, robots, common, file);
  return file;
}

}  // namespace

MissionFile read_mission_yaml(const Text& text, const std::string& default_name) {
  try {
    return read_mission_node(text, load_yaml(text), default_name);
  } catch (const YAML::Exception& error) {
    text.fail(1, "not valid YAML: " + error.msg);
  }
}

}  // namespace radioslam
