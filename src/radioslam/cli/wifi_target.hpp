// Where a robot's imported wifi.csv goes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/wifi_log.hpp"

namespace radioslam::cli {

/// One of three places, told by the output's name and by what is there:
///   NAME.csv              the table alone
///   a mission             robots/<robot>/wifi.csv of a robot it lists; its only one may go unnamed
///   a folder not yet      a mission of one robot, named after the source unless it is named, without
///   odometry
class WifiTarget {
 public:
  /// Refuses (InputError) a robot that the mission does not list, and names that are none.
  WifiTarget(const std::string& output, const std::string& robot, const std::string& source);

  void commit(const std::vector<WifiRow>& rows);

  /// What commit() replaces.
  std::string replaced() const;
  /// The robot's name; empty for a table alone.
  const std::string& robot() const { return robot_; }
  /// What is still missing before the mission can be run; empty when nothing is known to be.
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
