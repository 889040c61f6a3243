// The maps of a run: one per component, in its frame.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/map/map_files.hpp"
#include "radioslam/map/team_map.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam::cli {

/// A robot with its final continuous trajectory, which is empty where it could not be placed.
struct ScannedTrajectory {
  std::string id;
  LidarLog scans;
  Trajectory<SE3> poses;
};

/// The robots of a mission that have scans; without trajectories.
std::vector<ScannedTrajectory> scans_of(const Mission& mission);

/// Whether the robot's trajectory is in a frame of a map: that of its team or, in a component of its own, its
/// own. Among others, a robot that is not placed has none.
bool has_frame(const std::string& robot, const std::vector<Component>& components,
               const std::vector<std::string>& unplaced);

/// The files of the k-th alternative's maps are in this folder of the run.
std::filesystem::path hypothesis_folder(std::size_t k);

struct WrittenMaps {
  std::vector<MapResult> maps;
  std::vector<std::string> notes;
};

/// Hands over how to write a file of this name into the folder of the maps.
using WriteMapFile =
    std::function<void(const std::string& name, const std::function<void(const AppendToFile&)>&)>;

/// Writes the maps of those robots of each component that have a trajectory: map.ply, map.pgm, map.yaml and,
/// if asked for, map.pcd; with several components, map-<first robot>.ply and so on.
WrittenMaps write_maps(std::vector<ScannedTrajectory> robots, const std::vector<Component>& components,
                       const RunParams& params, const MapOptions& options, const WriteMapFile& write);

/// Writes the maps of a run and of its alternatives into its folder, and adds those of the run, their notes,
/// counts and the time to its result.
void add_maps(RunResult& result, const std::vector<ScannedTrajectory>& robots, const RunParams& params,
              const Progress& progress, const std::filesystem::path& folder);

}  // namespace radioslam::cli
