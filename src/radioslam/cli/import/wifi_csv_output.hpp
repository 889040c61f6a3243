// Output of imported WiFi scans: a wifi.csv alone, or the wifi.csv of a robot in a mission.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam::cli {

/// One of three targets, depending on the output path:
///   NAME.csv              the table alone
///   an existing mission   robots/<robot>/wifi.csv; the robot need not be named if there is only one
///   any other folder      a new mission of one robot without odometry; without a name, the robot is named
///   after
///                         the source
class WifiCsvOutput {
 public:
  /// Refuses (InputError) a robot that the mission does not have, and invalid names.
  WifiCsvOutput(const std::string& output, const std::string& robot, const std::string& source);

  void commit(const std::vector<WifiRow>& rows);

  /// The path that commit() replaces.
  std::string replaced() const;
  /// The robot's name; empty for a table alone.
  const std::string& robot() const { return robot_; }
  /// A note on what the mission still lacks before it can be run; empty if nothing is known to be missing.
  std::string missing() const;

 private:
  void find_robot_of_mission();
  void name_robot_after(const std::string& source);
  std::string file_of_robot(const char* name) const;

  std::string output_, robot_;
  std::string table_;  ///< the path of file_
  std::optional<OutputFile> file_;
  std::optional<OutputFolder> folder_;
};

}  // namespace radioslam::cli
