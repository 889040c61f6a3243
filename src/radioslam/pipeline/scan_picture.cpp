#include "radioslam/pipeline/scan_picture.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "radioslam/lidar/scan_points.hpp"

namespace radioslam {
namespace {

/// Column x and row y of a cell as one number, in the order of rows.
std::int64_t cell_key(std::int32_t x, std::int32_t y) {
  return (static_cast<std::int64_t>(y) << 32) + static_cast<std::uint32_t>(x);
}
std::int32_t row_of(std::int64_t key) { return static_cast<std::int32_t>(key >> 32); }
std::int32_t column_of(std::int64_t key) { return static_cast<std::int32_t>(key & 0xffffffff); }

std::int32_t step_of(double value_m, double step_m) {
  constexpr double kMost = 1e9;
  return static_cast<std::int32_t>(std::clamp(std::floor(value_m / step_m), -kMost, kMost));
}

/// What hit a cell.
struct CellHits {
  std::int32_t last_scan = -1;
  int scans = 0;
  std::vector<std::int32_t> heights;  ///< distinct, at most as many as needed
};

/// The scans nearest after keyframes, at most `most`, evenly.
std::vector<std::size_t> shown_scans(const LidarLog& log, const RobotResult& robot, std::size_t most) {
  std::set<std::size_t> found;
  for (const auto& row : robot.estimate) {
    const auto scan = std::lower_bound(log.stamps.begin(), log.stamps.end(), row.stamp);
    if (scan != log.stamps.end() && robot.dense.covers(*scan))
      found.insert(static_cast<std::size_t>(scan - log.stamps.begin()));
  }
  const std::vector<std::size_t> all(found.begin(), found.end());
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (all.size() <= most || (k + 1) * most / all.size() != k * most / all.size()) kept.push_back(all[k]);
  return kept;
}

/// The body's twist at a stamp, per second.
SE3::Tangent twist_at(const Trajectory<SE3>& way, Stamp stamp) {
  if (way.size() < 2) return SE3::Tangent::Zero();
  const std::size_t i = way.segment(stamp);
  return (way[i].pose.inverse() * way[i + 1].pose).log() / seconds_between(way[i].stamp, way[i + 1].stamp);
}

class CellGrid {
 public:
  CellGrid(double cell_m, const ScanPictureParams& params) : cell_m_(cell_m), params_(params) {}

  void add(std::int32_t scan, const Eigen::Vector3d& point) {
    CellHits& hits = cells_[cell_key(step_of(point.x(), cell_m_), step_of(point.y(), cell_m_))];
    if (hits.last_scan != scan) hits.last_scan = scan, ++hits.scans;
    const std::int32_t height = step_of(point.z(), params_.height_step_m);
    if (hits.heights.size() < static_cast<std::size_t>(params_.least_heights) &&
        std::find(hits.heights.begin(), hits.heights.end(), height) == hits.heights.end())
      hits.heights.push_back(height);
  }

  /// Cells hit at `least_heights` or more, in rows; so wide that they are few enough.
  ScanPictureResult picture(int least_heights, std::size_t most) const {
    std::map<std::int64_t, int> kept;
    for (const auto& [key, hits] : cells_)
      if (hits.heights.size() >= static_cast<std::size_t>(least_heights)) kept[key] = hits.scans;
    double cell_m = cell_m_;
    while (kept.size() > std::max<std::size_t>(1, most)) {
      std::map<std::int64_t, int> wider;
      for (const auto& [key, scans] : kept) {
        int& there = wider[cell_key(column_of(key) >> 1, row_of(key) >> 1)];
        there = std::max(there, scans);
      }
      kept = std::move(wider);
      cell_m *= 2;
    }
    ScanPictureResult result{cell_m, 0, {}};
    for (const auto& [key, scans] : kept) result.cells.push_back({column_of(key), row_of(key), scans});
    return result;
  }

 private:
  double cell_m_;
  const ScanPictureParams& params_;
  std::unordered_map<std::int64_t, CellHits> cells_;
};

ScanPictureResult picture_of(const Robot& robot, const RobotResult& estimate, const LidarParams& lidar,
                             const ScanPictureParams& params, std::size_t robots) {
  const ScannerTraits traits = scanner_traits(robot.lidar, lidar);
  CellGrid grid(traits.spacing_m, params);
  const auto scans =
      shown_scans(robot.lidar, estimate, static_cast<std::size_t>(params.most_scans) / robots + 1);
  for (std::size_t n = 0; n < scans.size(); ++n) {
    const Stamp stamp = robot.lidar.stamps[scans[n]];
    const SE3 T_frame_body = *estimate.dense.at(stamp);
    const auto points =
        usable_points(robot.lidar.read(scans[n]), twist_at(estimate.dense, stamp), lidar.points).points;
    const std::size_t stride = 1 + points.size() / static_cast<std::size_t>(params.most_points);
    for (std::size_t k = 0; k < points.size(); k += stride)
      grid.add(static_cast<std::int32_t>(n), T_frame_body * Eigen::Vector3d(points[k].cast<double>()));
  }
  const int least_heights = traits.kind == ScannerKind::kPlanar ? 1 : params.least_heights;
  ScanPictureResult result =
      grid.picture(least_heights, static_cast<std::size_t>(params.most_cells) / robots);
  result.scans = scans.size();
  return result;
}

}  // namespace

void add_scan_pictures(RunResult& result, const Mission& mission, const LidarParams& lidar,
                       const ScanPictureParams& params) {
  const auto scanning = static_cast<std::size_t>(std::count_if(
      mission.robots.begin(), mission.robots.end(), [](const Robot& robot) { return !robot.lidar.empty(); }));
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (!mission.robots[r].lidar.empty() && !result.robots[r].dense.empty())
      result.robots[r].picture = picture_of(mission.robots[r], result.robots[r], lidar, params, scanning);
}

}  // namespace radioslam
