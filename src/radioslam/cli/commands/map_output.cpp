#include "radioslam/cli/commands/map_output.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// The component's robots that can be mapped, moved out of `robots`; notes those that cannot.
std::vector<MappedRobot> take_mapped(std::vector<ScannedTrajectory>& robots, const Component& component,
                                     const LidarParams& lidar, std::vector<std::string>& notes) {
  std::vector<MappedRobot> mapped;
  for (const std::string& id : component.robots) {
    const auto robot = std::find_if(robots.begin(), robots.end(), [&](const auto& r) { return r.id == id; });
    if (robot == robots.end()) continue;
    if (robot->poses.empty())
      notes.push_back("robot " + id +
                      " is not on the map: it has no continuous trajectory in the frame of its team");
    else
      mapped.push_back(mapped_robot(id, std::move(robot->scans), std::move(robot->poses), lidar));
  }
  return mapped;
}

void add_notes(std::vector<std::string>& notes, const MapResult& map, const MapParams& params) {
  if (map.voxel_m > params.voxel_m)
    notes.push_back("the map's voxels are " + format_number(map.voxel_m) +
                    " m wide instead of map.voxel_m, so that it has no more than map.max_points points");
  if (!map.grid.empty() && map.grid.cell_m > params.cell_m)
    notes.push_back("the occupancy grid's cells are " + format_number(map.grid.cell_m) +
                    " m wide instead of map.cell_m, so that it has no more than map.max_cells cells");
}

void write_map(const std::string& name, const TeamMap& map, const MapParams& params,
               const WriteMapFile& write) {
  write(name + ".ply", [&](const AppendToFile& append) { write_ply(map, append); });
  if (params.pcd) write(name + ".pcd", [&](const AppendToFile& append) { write_pcd(map, append); });
  const OccupancyGrid& grid = map.result().grid;
  if (grid.empty()) return;
  write(name + ".pgm", [&](const AppendToFile& append) { append(format_pgm(grid)); });
  write(name + ".yaml", [&](const AppendToFile& append) { append(format_map_yaml(grid, name + ".pgm")); });
}

/// The robots with their continuous trajectories of an estimate, where these are in a frame of the maps.
std::vector<ScannedTrajectory> placed(std::vector<ScannedTrajectory> robots, const RunResult& result,
                                      const std::vector<RobotResult>& estimates) {
  for (ScannedTrajectory& robot : robots)
    for (const RobotResult& estimate : estimates)
      if (estimate.id == robot.id && has_frame(robot.id, result.components, result.unplaced))
        robot.poses = estimate.dense;
  return robots;
}

}  // namespace

std::vector<ScannedTrajectory> scans_of(const Mission& mission) {
  std::vector<ScannedTrajectory> robots;
  for (const Robot& robot : mission.robots)
    if (!robot.lidar.empty()) robots.push_back({robot.id, robot.lidar, {}});
  return robots;
}

bool has_frame(const std::string& robot, const std::vector<Component>& components,
               const std::vector<std::string>& unplaced) {
  const auto is_alone = [&](const Component& of) { return of.robots == std::vector<std::string>{robot}; };
  return std::find(unplaced.begin(), unplaced.end(), robot) == unplaced.end() ||
         std::any_of(components.begin(), components.end(), is_alone);
}

fs::path hypothesis_folder(std::size_t k) { return fs::path("hypotheses") / std::to_string(k + 1); }

WrittenMaps write_maps(std::vector<ScannedTrajectory> robots, const std::vector<Component>& components,
                       const RunParams& params, const MapOptions& options, const WriteMapFile& write) {
  WrittenMaps written;
  for (const Component& component : components) {
    auto mapped = take_mapped(robots, component, params.scans.lidar, written.notes);
    if (mapped.empty()) continue;
    const std::string name = components.size() == 1 ? "map" : "map-" + component.robots.front();
    const TeamMap map(std::move(mapped), params.scans.lidar.points, params.map, options);
    add_notes(written.notes, map.result(), params.map);
    write_map(name, map, params.map, write);
    written.maps.push_back(map.result());
  }
  return written;
}

void add_maps(RunResult& result, const std::vector<ScannedTrajectory>& robots, const RunParams& params,
              const Progress& progress, const fs::path& folder) {
  if (robots.empty()) return;
  const auto start = std::chrono::steady_clock::now();
  const auto write_into = [&](const fs::path& part, const std::vector<RobotResult>& estimates) {
    return write_maps(placed(robots, result, estimates), result.components, params, {{}, progress},
                      [&](const std::string& name, const std::function<void(const AppendToFile&)>& content) {
                        FileWriter file(folder / part / name);
                        content([&](std::string_view piece) { file.write(piece); });
                        file.close();
                      });
  };
  WrittenMaps written = write_into({}, result.robots);
  for (std::size_t k = 0; k < result.alternatives.size(); ++k)
    write_into(hypothesis_folder(k), result.alternatives[k].robots);
  for (const MapResult& map : written.maps) {
    result.counts["map_points"] += static_cast<double>(map.all_points);
    result.counts["map_points_seen_through"] += static_cast<double>(map.seen_through);
  }
  result.maps = std::move(written.maps);
  for (auto& note : written.notes) result.notes.push_back(std::move(note));
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  result.timings.push_back({"map", taken.count()});
}

}  // namespace radioslam::cli
