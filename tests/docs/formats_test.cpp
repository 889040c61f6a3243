// Compares docs/formats.md with the readers and writers: header lines of the tables, their columns, the keys
// of mission.yaml, and what a run writes.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/process.hpp"
#include "radioslam/cli/commands/aoa_output.hpp"
#include "radioslam/io/mission/anchor_tables.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/mission/robot_tables.hpp"
#include "radioslam/io/mission/team_tables.hpp"
#include "radioslam/io/mission/truth_labels.hpp"
#include "radioslam/io/run/run_tables.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

std::string source_file(const std::string& path) {
  return read_text(fs::path(RADIOSLAM_SOURCE_DIR) / path).content;
}

const std::string& page() {
  static const std::string text = source_file("docs/formats.md");
  return text;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
  return parts;
}

/// The page's text under a heading, up to the next one.
std::string section(const std::string& heading) {
  const std::regex begin("\n#+ " + std::regex_replace(heading, std::regex(R"([.*+?()\[\]{}|\\])"), R"(\$&)") +
                         "\n");
  std::smatch found;
  if (!std::regex_search(page(), found, begin)) return {};
  const std::string rest = found.suffix();
  return rest.substr(0, rest.find("\n#"));
}

/// The indented lines of a section before the first other text, without the indentation.
std::string first_example(const std::string& text) {
  std::string example;
  for (const std::string& line : split(text, '\n')) {
    if (line.starts_with("    "))
      example += line.substr(4) + "\n";
    else if (!example.empty())
      break;
  }
  return example;
}

/// The header line that a section shows, with optional columns in brackets.
std::string shown_header(const std::string& file) {
  return first_line(first_example(section("`" + file + "`")));
}

std::string without_optional(const std::string& header) { return header.substr(0, header.find('[')); }

std::string with_optional(const std::string& header) {
  return std::regex_replace(header, std::regex(R"([\[\]])"), "");
}

Mission mission_with_antennas() {
  Mission mission;
  mission.robots.resize(2);
  mission.robots[0].id = "a";
  mission.robots[1].id = "b";
  RangeMeasurement range;
  range.i.robot = RobotIndex(std::size_t{0});
  range.j.robot = RobotIndex(std::size_t{1});
  range.i.antenna = "front";
  mission.ranges.push_back(range);
  return mission;
}

std::map<std::string, std::string> headers_of_writers() {
  const Mission none;
  std::map<std::string, std::string> headers{
      {"robots/ID/wifi.csv", format_wifi({}, {})},
      {"robots/ID/imu.csv", format_imu({})},
      {"robots/ID/gnss.csv", format_fixes({})},
      {"radio/anchors.csv", format_anchors(none)},
      {"radio/aoa.csv", format_aoa(none)},
      {"radio/direct_paths.csv", format_direct_paths(none, {})},
      {"matches.csv", format_matches(none)},
      {"match_labels.csv", format_match_labels(none, {})},
      {"candidates.csv", std::string(kCandidateHeader)},
      {"closures.csv", format_closures({}, {})},
      {"uncertainty.csv", format_uncertainty({})},
      {"aoa.csv", format_measured_aoa({})},
      {"access_points.csv", format_access_points({})},
      {"profile.csv", cli::profile_rows({})},
  };
  for (auto& [file, text] : headers) text = first_line(text);
  return headers;
}

TEST(Formats, HeadersAreThoseOfTheWriters) {
  for (const auto& [file, header] : headers_of_writers()) EXPECT_EQ(shown_header(file), header) << file;
  const std::string ranges = shown_header("radio/ranges.csv");
  EXPECT_EQ(without_optional(ranges), first_line(format_ranges({})));
  EXPECT_EQ(with_optional(ranges), first_line(format_ranges(mission_with_antennas())));
}

TEST(Formats, DistancesOfAnchorsAreReadAsShown) {
  const std::string header = shown_header("distances.csv");
  const DistanceTable plain = read_distances({"d", without_optional(header) + "\nA,B,1\n"}, 0.5);
  EXPECT_EQ(plain.distances.at(0).sigma_m, 0.5);
  const DistanceTable full = read_distances({"d", with_optional(header) + "\nA,B,1,0.1\n"}, 0.5);
  EXPECT_EQ(full.distances.at(0).sigma_m, 0.1);
}

/// Files whose columns are explained in the section of another file.
const std::map<std::string, std::string>& explained_elsewhere() {
  static const std::map<std::string, std::string> places{{"aoa.csv", "radio/aoa.csv"}};
  return places;
}

TEST(Formats, EveryColumnIsExplained) {
  std::map<std::string, std::string> headers = headers_of_writers();
  for (const char* file : {"radio/ranges.csv", "distances.csv", "pairs.csv"})
    headers[file] = with_optional(shown_header(file));
  for (const auto& [file, header] : headers) {
    const auto elsewhere = explained_elsewhere().find(file);
    const std::string text =
        section("`" + (elsewhere == explained_elsewhere().end() ? file : elsewhere->second) + "`");
    for (const std::string& column : split(header, ','))
      EXPECT_TRUE(contains(text, "`" + column + "`")) << column << " of " << file;
  }
}

/// The keys that the readers of mission.yaml accept, found in their source.
std::set<std::string> accepted_keys() {
  std::set<std::string> keys;
  for (const char* file : {"mission/mission_yaml.cpp", "csi/csi_yaml.cpp"}) {
    const std::string source = source_file("src/radioslam/io/" + std::string(file));
    const std::regex key(R"re(\{\s*"(\w+)",\s*\[&)re");
    for (std::sregex_iterator k(source.begin(), source.end(), key), end; k != end; ++k) keys.insert((*k)[1]);
  }
  const std::string noise = source_file("src/radioslam/io/mission/mission_yaml.hpp");
  const std::regex field(R"re(\{"(\w+)", &OdometryNoise)re");
  for (std::sregex_iterator k(noise.begin(), noise.end(), field), end; k != end; ++k) keys.insert((*k)[1]);
  return keys;
}

/// All keys in the nested maps of the node, except names of robots and antennas.
void collect_keys(const YAML::Node& node, std::set<std::string>& keys) {
  for (const auto& entry : node) {
    const std::string key = entry.first.as<std::string>();
    keys.insert(key);
    if (key == "robots")
      for (const auto& robot : entry.second) collect_keys(robot.second, keys);
    else if (key != "antennas" && entry.second.IsMap())
      collect_keys(entry.second, keys);
  }
}

TEST(Formats, EveryKeyOfMissionYamlIsExplainedAndInTheExample) {
  const std::string text = section("mission.yaml");
  std::set<std::string> shown;
  collect_keys(YAML::Load(first_example(text)), shown);
  const std::set<std::string> accepted = accepted_keys();
  EXPECT_GE(accepted.size(), 20U) << "the readers' keys are found";
  EXPECT_EQ(shown, accepted);
  for (const std::string& key : accepted)
    EXPECT_TRUE(contains(text, "`" + key + "`") || contains(text, ": " + key + "`")) << key;
}

TEST(Formats, TheExampleOfMissionYamlIsAccepted) {
  const MissionFile file = read_mission_yaml({"example", first_example(section("mission.yaml"))}, "");
  ASSERT_EQ(file.mission.robots.size(), 2U);
  EXPECT_TRUE(file.mission.robots[0].csi.has_value());
  EXPECT_EQ(file.mission.robots[1].lidar_range_m, 20);
}

TEST(Formats, DefaultsOfMissionYamlAreThoseOfTheReader) {
  const Robot defaults;
  const std::string text = section("mission.yaml");
  const auto default_in_row = [&](const std::string& key) {
    const std::size_t begin = text.find("| `" + key + "` |");
    EXPECT_NE(begin, std::string::npos) << key;
    const std::vector<std::string> cells = split(first_line(text.substr(begin)), '|');
    return std::stod(cells.back());
  };
  EXPECT_EQ(default_in_row("lidar: range_m"), defaults.lidar_range_m);
  EXPECT_EQ(default_in_row("lidar: view_deg"), 360);
  EXPECT_EQ(default_in_row("sigma_heading_rad"), defaults.sigma_heading_rad);
  EXPECT_EQ(default_in_row("sigma_xy_per_sqrt_m"), defaults.odometry_noise.sigma_xy_per_sqrt_m);
  EXPECT_EQ(default_in_row("sigma_z_per_sqrt_m"), defaults.odometry_noise.sigma_z_per_sqrt_m);
  EXPECT_EQ(default_in_row("sigma_yaw_per_sqrt_m_rad"), defaults.odometry_noise.sigma_yaw_per_sqrt_m_rad);
  EXPECT_EQ(default_in_row("sigma_yaw_per_rad"), defaults.odometry_noise.sigma_yaw_per_rad);
  EXPECT_EQ(default_in_row("sigma_yaw_drift_per_m_rad"), defaults.odometry_noise.sigma_yaw_drift_per_m_rad);
  EXPECT_EQ(default_in_row("sigma_scale"), defaults.odometry_noise.sigma_scale);
}

/// Every key of a JSON object and of those within, except under keys that hold names or parameters.
void collect_keys(const nlohmann::json& json, std::set<std::string>& keys) {
  if (json.is_array())
    for (const auto& entry : json) collect_keys(entry, keys);
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    keys.insert(key);
    if (key == "robots")
      for (const auto& robot : value) collect_keys(robot, keys);
    else if (key != "parameters" && key != "seconds")
      collect_keys(value, keys);
  }
}

void expect_explained(const nlohmann::json& json) {
  std::set<std::string> keys;
  collect_keys(json, keys);
  for (const std::string& key : keys) EXPECT_TRUE(contains(page(), "`" + key + "`")) << key;
}

/// A written file's name on the page: dense/a.tum is dense/ID.tum.
std::string name_on_page(const std::string& file) {
  std::string name = std::regex_replace(file, std::regex(R"(^robots/\w+/)"), "robots/ID/");
  name = std::regex_replace(name, std::regex(R"(^hypotheses/\d/(dense/)?\w+\.tum$)"), "hypotheses/K/ID.tum");
  return std::regex_replace(name, std::regex(R"((^|dense/)[a-z]\.tum$)"), "$1ID.tum");
}

/// Expects the file's name on the page, and the header of a table in its section.
void expect_described(const std::string& file, const std::string& content) {
  const std::string name = name_on_page(file);
  EXPECT_TRUE(contains(page(), "    " + name + " ")) << file;
  if (!name.ends_with(".csv")) return;
  const std::string header = first_line(content), shown = shown_header(name);
  EXPECT_TRUE(header == with_optional(shown) || header == without_optional(shown)) << file << ": " << header;
}

struct Example {
  std::string name;
  std::vector<std::string> settings;
};

class FormatsOfRuns : public testing::TestWithParam<Example> {};

TEST_P(FormatsOfRuns, EveryFileHeaderAndKeyIsExplained) {
  const cli::TemporaryFolder folder;
  std::vector<std::string> simulate{"simulate", GetParam().name, "-o", "mission"};
  simulate.insert(simulate.end(), GetParam().settings.begin(), GetParam().settings.end());
  ASSERT_EQ(cli::run(simulate, folder.path()).status, 0);
  ASSERT_EQ(cli::run({"run", "mission", "-o", "out"}, folder.path()).status, 0);
  for (const char* root : {"mission", "out"})
    for (const std::string& file : cli::files_in(folder.path() / root))
      expect_described(file, cli::read_file(folder.path() / root / file));
  expect_explained(nlohmann::json::parse(cli::read_file(folder.path() / "out/summary.json")));
  const cli::Outcome evaluated = cli::run({"evaluate", "out", "mission", "--json"}, folder.path());
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  expect_explained(nlohmann::json::parse(evaluated.out));
}

std::string name_of(const testing::TestParamInfo<Example>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Examples, FormatsOfRuns,
                         testing::Values(Example{"carpark", {"--set", "path_length_m=150"}},
                                         Example{"city",
                                                 {"--set", "path_length_m=400", "matches_true=5",
                                                  "matches_false=5", "gnss_hz=1"}},
                                         Example{"hall", {"--set", "matches_true=5", "matches_false=5"}}),
                         name_of);

TEST(Formats, SimilaritiesHaveTheHeaderShown) {
  const cli::TemporaryFolder folder;
  cli::write_file(folder.path() / "wifi.csv",
                  "t_s,bssid,frequency_mhz,rssi_dbm\n0,ap1,2412,-50\n9,ap1,2412,-51\n");
  ASSERT_EQ(
      cli::run({"similarity", "wifi.csv", "--measure", "cosine", "-o", "pairs.csv"}, folder.path()).status,
      0);
  EXPECT_EQ(shown_header("pairs.csv"), first_line(cli::read_file(folder.path() / "pairs.csv")));
}

}  // namespace
}  // namespace radioslam
