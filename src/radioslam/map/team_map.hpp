// The map of the robots of one component, from their scans and final continuous trajectories.
//
//   gather    scans a little way apart are read and placed, in blocks: their returns go into voxels
//             (voxel_map.hpp), their rays into an occupancy grid (occupancy.hpp)
//   surfaces  normals of the voxels from their neighbours
//   view      fewer scans are read again: which voxels do their rays end at, which do they go through? What
//             was there for a while and is then seen through has moved, and is left out (ray_view.hpp)
//
// Memory: voxels and cells, both bounded by the parameters, and a block of scans. Time: bounded by the
// returns and views per second of the mission. The same bytes for any number of threads.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/lidar/lidar_params.hpp"
#include "radioslam/map/map_params.hpp"
#include "radioslam/map/placed_scan.hpp"
#include "radioslam/map/voxel_map.hpp"
#include "radioslam/results/map_result.hpp"

namespace radioslam {

struct MapOptions {
  std::optional<Eigen::AlignedBox3d> crop;  ///< in the frame of the component; what is outside is left out
  Progress progress;
};

class TeamMap {
 public:
  /// From at most VoxelMap::kMaxRobots robots, at least one.
  TeamMap(std::vector<MappedRobot> robots, const ScanPointParams& points, const MapParams& params,
          const MapOptions& options = {});

  /// With the grid, and a share of the points for the report.
  const MapResult& result() const { return result_; }

  /// Calls take(position in the frame, point) for every point; their number is result().all_points.
  void for_each_point(
      const std::function<void(const Eigen::Vector3d& position, const MapPoint& point)>& take) const;

 private:
  struct Task {
    std::size_t robot = 0, scan = 0;
  };
  using Block = std::vector<PlacedScan>;

  std::vector<Task> tasks(double step_m, double step_s) const;
  double duration_s() const;
  void gather();
  void insert(const Block& block);
  std::size_t leave_out_moving();
  /// Calls take(scans) for blocks of the tasks, placed in parallel.
  void for_each_block(const std::vector<Task>& tasks, double share, const char* what,
                      const std::function<void(const Block&)>& take) const;
  void choose_shown_points();

  std::vector<MappedRobot> robots_;
  ScanPointParams points_;
  MapParams params_;
  MapOptions options_;
  VoxelMap voxels_;
  std::vector<VoxelMap::Tile> tiles_;
  MapResult result_;
};

}  // namespace radioslam
