#include "radioslam/io/mission/truth_labels.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <tuple>

#include "radioslam/base/check.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {
namespace {

const std::string& transmitter_of(const Mission& mission, const AoaMeasurement& aoa) {
  const LinkEnd& end = aoa.transmitter;
  return end.robot.valid() ? mission.robots[end.robot.index()].id : mission.anchors[end.anchor.index()].id;
}

const std::string& receiver_of(const Mission& mission, const AoaMeasurement& aoa) {
  return mission.robots[aoa.receiver.index()].id;
}

void check_name(const CsvReader& csv, std::size_t column, const Mission& mission) {
  const auto is_it = [&](const auto& named) { return named.id == csv.field(column); };
  if (std::none_of(mission.robots.begin(), mission.robots.end(), is_it) &&
      std::none_of(mission.anchors.begin(), mission.anchors.end(), is_it))
    csv.fail("unknown robot '" + std::string(csv.field(column)) + "'");
}

int path_number_at(const CsvReader& csv, std::size_t column) {
  const auto path = parse_integer(csv.field(column));
  if (!path || *path < kNoDirectPath || *path > std::numeric_limits<int>::max())
    csv.fail("path '" + std::string(csv.field(column)) + "' is neither the index of a path nor -1");
  return static_cast<int>(*path);
}

using AoaKey = std::tuple<Stamp, std::string, std::string>;
using MatchKey = std::tuple<std::string, Stamp, std::string, Stamp>;

MatchKey key_of(const Mission& mission, const PoseMatch& match) {
  return {mission.robots[match.robot_i.index()].id, match.stamp_i, mission.robots[match.robot_j.index()].id,
          match.stamp_j};
}

bool label_at(const CsvReader& csv, std::size_t column) {
  const std::string_view word = csv.field(column);
  if (word != "true" && word != "false")
    csv.fail("label '" + std::string(word) + "' is neither true nor false");
  return word == "true";
}

}  // namespace

std::vector<std::optional<int>> read_direct_paths(const Text& text, const Mission& mission) {
  enum : std::size_t { kTime, kReceiver, kTransmitter, kPath };
  std::map<AoaKey, std::size_t> places;
  for (std::size_t k = 0; k < mission.aoa_measurements.size(); ++k) {
    const AoaMeasurement& aoa = mission.aoa_measurements[k];
    places[{aoa.stamp, receiver_of(mission, aoa), transmitter_of(mission, aoa)}] = k;
  }
  std::vector<std::optional<int>> direct_paths(mission.aoa_measurements.size());
  CsvReader csv(text, {{"t_s", "receiver", "transmitter", "path"}});
  while (csv.next()) {
    for (const std::size_t column : {kReceiver, kTransmitter}) check_name(csv, column, mission);
    const int path = path_number_at(csv, kPath);
    const auto place = places.find(
        {csv.stamp(kTime), std::string(csv.field(kReceiver)), std::string(csv.field(kTransmitter))});
    if (place == places.end()) continue;
    if (path >= static_cast<int>(mission.aoa_measurements[place->second].paths.size()))
      csv.fail("the measurement has no path " + std::to_string(path));
    direct_paths[place->second] = path;
  }
  return direct_paths;
}

std::string format_direct_paths(const Mission& mission, const std::vector<std::optional<int>>& direct_paths) {
  RADIOSLAM_CHECK(direct_paths.size() == mission.aoa_measurements.size(), "one label per measurement");
  std::string out = "t_s,receiver,transmitter,path\n";
  for (std::size_t k = 0; k < direct_paths.size(); ++k) {
    const AoaMeasurement& aoa = mission.aoa_measurements[k];
    if (!direct_paths[k]) continue;
    out += format_stamp(aoa.stamp) + ',' + receiver_of(mission, aoa) + ',' + transmitter_of(mission, aoa) +
           ',' + std::to_string(*direct_paths[k]) + '\n';
  }
  return out;
}

std::vector<std::optional<bool>> read_match_labels(const Text& text, const Mission& mission) {
  enum : std::size_t { kI, kTimeI, kJ, kTimeJ, kLabel };
  std::map<MatchKey, std::vector<std::size_t>> places;  // the next one to be labelled is last
  for (std::size_t k = mission.matches.size(); k-- > 0;)
    places[key_of(mission, mission.matches[k])].push_back(k);
  std::vector<std::optional<bool>> labels(mission.matches.size());
  CsvReader csv(text, {{"robot_i", "t_i_s", "robot_j", "t_j_s", "label"}});
  while (csv.next()) {
    for (const std::size_t column : {kI, kJ}) check_name(csv, column, mission);
    const bool label = label_at(csv, kLabel);
    const auto place = places.find(
        {std::string(csv.field(kI)), csv.stamp(kTimeI), std::string(csv.field(kJ)), csv.stamp(kTimeJ)});
    if (place == places.end() || place->second.empty()) continue;
    labels[place->second.back()] = label;
    place->second.pop_back();
  }
  return labels;
}

std::string format_match_labels(const Mission& mission, const std::vector<std::optional<bool>>& labels) {
  RADIOSLAM_CHECK(labels.size() == mission.matches.size(), "one label per match");
  std::string out = "robot_i,t_i_s,robot_j,t_j_s,label\n";
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (!labels[k]) continue;
    const auto& [i, stamp_i, j, stamp_j] = key_of(mission, mission.matches[k]);
    out.append(i).append(",").append(format_stamp(stamp_i)).append(",");
    out.append(j).append(",").append(format_stamp(stamp_j)).append(*labels[k] ? ",true\n" : ",false\n");
  }
  return out;
}

}  // namespace radioslam
