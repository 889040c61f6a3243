#include "radioslam/cli/import/ros_sources.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam::cli {
namespace {

/// The parts of a topic between slashes: turtle1, odom of /turtle1/odom.
std::vector<std::string> parts_of(const std::string& topic) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin < topic.size();) {
    const std::size_t end = std::min(topic.find('/', begin), topic.size());
    if (end > begin) parts.push_back(topic.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool are_different(const std::vector<std::string>& names) {
  return std::set<std::string>(names.begin(), names.end()).size() == names.size();
}

/// Per topic the first part that differs in all of them; empty if there is none.
std::vector<std::string> differing_parts(const std::vector<std::string>& topics) {
  std::vector<std::vector<std::string>> parts;
  std::size_t least = topics.empty() ? 0 : parts_of(topics.front()).size();
  for (const std::string& topic : topics) {
    parts.push_back(parts_of(topic));
    least = std::min(least, parts.back().size());
  }
  for (std::size_t k = 0; k < least; ++k) {
    std::vector<std::string> names;
    for (const auto& each : parts) names.push_back(each[k]);
    if (are_different(names)) return names;
  }
  return {};
}

/// Names for several robots: of their recordings, of the folders of those, of their topics, or letters.
std::vector<std::string> default_names(const std::vector<RosSource>& sources) {
  std::vector<std::string> files, folders, topics;
  for (const RosSource& source : sources) {
    files.push_back(recording_name(source.recording));
    folders.push_back(recording_name(std::filesystem::absolute(source.recording).parent_path()));
    topics.push_back(source.topics.odometry.empty() ? source.topics.scans : source.topics.odometry);
  }
  for (const auto& names : {files, folders, differing_parts(topics)})
    if (names.size() == sources.size() && are_different(names) &&
        std::all_of(names.begin(), names.end(), is_valid_id))
      return names;
  return robot_letters(sources.size());
}

/// The recordings, once per robot.
std::vector<std::string> recordings_of(const ImportOptions& options) {
  std::vector<std::string> recordings;
  for (const std::string& source : options.sources)
    for (const auto& recording : recordings_in(source)) recordings.push_back(recording.string());
  std::size_t robots = options.robots.size();
  for (const auto* topics :
       {&options.odometry, &options.scans, &options.imu, &options.gnss, &options.truth, &options.wifi})
    robots = std::max(robots, topics->size());
  if (recordings.size() == 1 && robots > 1) recordings.resize(robots, std::string(recordings.front()));
  return recordings;
}

void give_names(const ImportOptions& options, std::vector<RosSource>& sources) {
  const auto names = robots_of_import(options, sources.size(),
                                      sources.size() == 1 ? robot_letters(1) : default_names(sources));
  for (std::size_t k = 0; k < sources.size(); ++k) sources[k].robot = names[k];
}

/// The text before and behind the last '='.
std::pair<std::string, std::string> split_at_equals(const char* option, const std::string& text,
                                                    const char* expected) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(std::string(option) + ' ' + text, 0, std::string("expected ") + expected);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace

std::vector<RosSource> ros_sources(const ImportOptions& options) {
  std::vector<RosSource> sources;
  const std::vector<std::string> recordings = recordings_of(options);
  const std::size_t count = recordings.size();
  for (std::size_t k = 0; k < count; ++k)
    sources.push_back(
        {recordings[k],
         "",
         {value_for(options.odometry, "--odometry", k, count), value_for(options.scans, "--scans", k, count),
          value_for(options.imu, "--imu", k, count), value_for(options.truth, "--truth", k, count),
          value_for(options.gnss, "--gnss", k, count), value_for(options.wifi, "--wifi", k, count)}});
  give_names(options, sources);
  return sources;
}

RosRangeRequest ros_range_request(const ImportOptions& options, const std::vector<RosSource>& sources) {
  RosRangeRequest request;
  for (const RosSource& source : sources) request.robots.insert(source.robot);
  for (const std::string& name : options.names) {
    const auto [radio, id] = split_at_equals("--name", name, "RADIO=ID");
    check_import_id("--name " + name, id);
    if (!request.names.emplace(radio, id).second)
      throw InputError("--name " + name, 0, "this radio already has a name");
  }
  for (const std::string& range : options.ranges) {
    const auto [topic, ends] = split_at_equals("--ranges", range, "TOPIC=ID,ID");
    const std::size_t comma = ends.find(',');
    if (comma == std::string::npos) throw InputError("--ranges " + range, 0, "expected TOPIC=ID,ID");
    const std::string i = ends.substr(0, comma), j = ends.substr(comma + 1);
    check_import_id("--ranges " + range, i);
    check_import_id("--ranges " + range, j);
    if (i == j || (!request.robots.contains(i) && !request.robots.contains(j)))
      throw InputError("--ranges " + range, 0, "at least one of two different ends has to be a robot");
    request.ends[topic] = {i, j};
  }
  return request;
}

}  // namespace radioslam::cli
