#include "radioslam/io/mission/mission_output.hpp"

#include <algorithm>
#include <array>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

using Kind = std::vector<const char*>;
const std::array<Kind, 3> kKinds = {Kind{"odometry.tum", "groundtruth.tum", "imu.csv", "gnss.csv", "lidar"},
                                    Kind{"wifi.csv"}, Kind{"csi"}};
const Kind& kMotion = kKinds.front();

/// The recordings of one kind in a robot's folder.
std::vector<std::string> recordings_in(const fs::path& folder, const Kind& kind) {
  std::vector<std::string> found;
  for (const char* name : kind)
    if (fs::exists(folder / name)) found.emplace_back(name);
  return found;
}

std::vector<std::string> robots_of(const fs::path& mission) {
  std::vector<std::string> ids;
  for (const Robot& robot : read_mission_yaml(read_text(mission / kMissionFolder), "").mission.robots)
    ids.push_back(robot.id);
  return ids;
}

[[noreturn]] void refuse_taken(const fs::path& mission, const std::string& robot, const std::string& what) {
  throw InputError(mission.string(), 0,
                   "robot '" + robot + "' " + what +
                       "; --robot names another robot, --replace replaces what this import brings",
                   InputError::Kind::kDuplicate);
}

}  // namespace

MissionOutput::MissionOutput(const fs::path& target, Existing existing)
    : target_(target), existing_(existing), folder_(target, kMissionFolder) {}

void MissionOutput::expect_free(const std::string& robot, bool is_chosen) const {
  if (replaces() || !fs::exists(target_ / kMissionFolder)) return;
  const std::vector<std::string> ids = robots_of(target_);
  if (!is_chosen && std::find(ids.begin(), ids.end(), robot) != ids.end())
    refuse_taken(target_, robot, "is in this mission already");
  const auto taken = recordings_in(target_ / "robots" / robot, kMotion);
  if (!taken.empty()) refuse_taken(target_, robot, "has " + taken.front() + " in this mission already");
}

void MissionOutput::commit(const Mission& mission, const Truth& truth) {
  write_mission(folder_.path(), mission, truth);
  if (fs::exists(target_ / kMissionFolder))
    grow(mission);
  else
    folder_.commit();
}

void MissionOutput::grow(const Mission& mission) {
  const Text yaml = read_text(target_ / kMissionFolder);
  const std::string grown = extended_mission_yaml(yaml, mission, notes_);
  if (mission.dimension == 3 && read_mission_yaml(yaml, "").mission.dimension == 2)
    notes_.push_back(
        "mission.yaml has 'dimension: 2', and its estimate stays in the plane; the recording is in space");
  refuse_fixes_of_another_origin(mission);
  Moves moves;
  for (const Robot& robot : mission.robots) add_moves_of_robot(robot.id, moves);
  add_moves_of_tables(moves);
  write_file(folder_.path() / kMissionFolder, grown);
  if (grown != yaml.content) moves.push_back({folder_.path() / kMissionFolder, target_ / kMissionFolder});
  folder_.commit_parts(moves);
}

/// Each import has an origin of its own for position fixes, which the mission does not state.
void MissionOutput::refuse_fixes_of_another_origin(const Mission& mission) const {
  constexpr const char* kFixes = "gnss.csv";
  const bool brings_fixes =
      std::any_of(mission.robots.begin(), mission.robots.end(),
                  [&](const Robot& robot) { return fs::exists(folder_of(robot.id) / kFixes); });
  if (!brings_fixes) return;
  for (const std::string& other : robots_of(target_)) {
    const bool is_brought = std::any_of(mission.robots.begin(), mission.robots.end(),
                                        [&](const Robot& robot) { return robot.id == other; });
    if (!is_brought && fs::exists(target_ / "robots" / other / kFixes))
      throw InputError((target_ / "robots" / other / kFixes).string(), 0,
                       "has another origin than the position fixes of this import; import the recordings "
                       "together, or this one without its fixes",
                       InputError::Kind::kDuplicate);
  }
}

/// New recordings take their places; others of a kind that is replaced leave theirs.
void MissionOutput::add_moves_of_robot(const std::string& robot, Moves& moves) const {
  const fs::path there = target_ / "robots" / robot;
  for (const Kind& kind : kKinds) {
    const auto brought = recordings_in(folder_of(robot), kind), taken = recordings_in(there, kind);
    if (brought.empty()) continue;
    if (!taken.empty() && !replaces())
      refuse_taken(target_, robot, "has " + taken.front() + " in this mission already");
    for (const std::string& name : brought) moves.push_back({folder_of(robot) / name, there / name});
    for (const std::string& name : taken)
      if (std::find(brought.begin(), brought.end(), name) == brought.end())
        moves.push_back({there / name, folder_of(robot) / name});
  }
}

void MissionOutput::add_moves_of_tables(Moves& moves) const {
  const fs::path from = folder_.path();
  for (const fs::path& file : files_in(from, Depth::kBelow, [](const fs::path&) { return true; })) {
    const fs::path name = file.lexically_relative(from);
    if (*name.begin() == "robots" || name == kMissionFolder) continue;
    if (fs::exists(target_ / name) && !replaces())
      throw InputError(
          (target_ / name).string(), 0,
          "is in this mission already, and this import brings another one; --replace replaces it",
          InputError::Kind::kDuplicate);
    moves.push_back({file, target_ / name});
  }
}

}  // namespace radioslam
