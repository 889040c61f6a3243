// A mission folder that importers write: a new one, or one that is there and gets another robot, or
// recordings of a robot that has none of their kind.
//
// What is there stays: other robots, other recordings, and mission.yaml as it was edited. Recordings are of
// three kinds: motion (odometry.tum, groundtruth.tum, imu.csv, gnss.csv and lidar/, which are one kind
// because they belong together), wifi.csv, and csi/. A robot that has recordings of a kind is not given
// others, and the team's tables are not replaced, unless that is asked for. New files are written beside the
// mission and moved into it together, or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

class MissionOutput {
 public:
  enum class Existing { kKeep, kReplace };

  /// Refuses (InputError) a target that is a file, or a folder with other contents than a mission.
  MissionOutput(const std::filesystem::path& target, Existing existing);

  /// Refuses (InputError) a robot that has recordings of motion already, or, if its name was not chosen by
  /// the user, one that is there at all. To be asked before a long import.
  void expect_free(const std::string& robot, bool is_chosen) const;
  /// The folder of a robot, where recordings can be written before commit().
  std::filesystem::path folder_of(const std::string& robot) const {
    return folder_.path() / "robots" / robot;
  }
  /// Writes the mission's files and moves everything to its place. Refuses (InputError) recordings of a kind
  /// that a robot has, tables that the mission has, position fixes beside those of robots that are not part
  /// of the import, whose origin differs, and a mission.yaml in which no robot can be added.
  void commit(const Mission& mission, const Truth& truth = {});
  /// What the user should know of the mission that grew; filled by commit().
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  using Moves = std::vector<OutputFolder::Move>;

  bool replaces() const { return existing_ == Existing::kReplace; }
  void grow(const Mission& mission);
  void refuse_fixes_of_another_origin(const Mission& mission) const;
  void add_moves_of_robot(const std::string& robot, Moves& moves) const;
  void add_moves_of_tables(Moves& moves) const;

  std::filesystem::path target_;
  Existing existing_;
  OutputFolder folder_;
  std::vector<std::string> notes_;
};

}  // namespace radioslam
