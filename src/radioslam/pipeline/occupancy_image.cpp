#include "radioslam/pipeline/occupancy_image.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "radioslam/lidar/scan_points.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kExcludedHighest = 30;  // number of cells excluded from the reference height

/// Column x and row y of a cell as one number, in row order.
std::int64_t cell_key(std::int32_t x, std::int32_t y) {
  return (static_cast<std::int64_t>(y) << 32) + static_cast<std::uint32_t>(x);
}
std::int32_t row_of(std::int64_t key) { return static_cast<std::int32_t>(key >> 32); }
std::int32_t column_of(std::int64_t key) { return static_cast<std::int32_t>(key & 0xffffffff); }

std::int32_t step_of(double value_m, double step_m) {
  constexpr double kMax = 1e9;
  return static_cast<std::int32_t>(std::clamp(std::floor(value_m / step_m), -kMax, kMax));
}

/// The hits of one cell.
struct CellHits {
  std::int32_t last_scan = -1;
  int scans = 0;
  std::vector<std::int32_t> heights;  ///< distinct
};

/// The first scans after keyframes, at most `most`, evenly spaced.
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
SE3::Tangent twist_at(const Trajectory<SE3>& trajectory, Stamp stamp) {
  if (trajectory.size() < 2) return SE3::Tangent::Zero();
  const std::size_t i = trajectory.segment(stamp);
  return (trajectory[i].pose.inverse() * trajectory[i + 1].pose).log() /
         seconds_between(trajectory[i].stamp, trajectory[i + 1].stamp);
}

class CellGrid {
 public:
  CellGrid(double cell_m, const OccupancyImageParams& params) : cell_m_(cell_m), params_(params) {}

  void add(std::int32_t scan, const Eigen::Vector3d& point) {
    CellHits& hits = cells_[cell_key(step_of(point.x(), cell_m_), step_of(point.y(), cell_m_))];
    if (hits.last_scan != scan) hits.last_scan = scan, ++hits.scans;
    const std::int32_t height = step_of(point.z(), params_.height_step_m);
    if (std::find(hits.heights.begin(), hits.heights.end(), height) == hits.heights.end())
      hits.heights.push_back(height);
  }

  /// Cells in the order of y, then x; they are widened until there are at most `most`.
  OccupancyImageResult picture(ScannerKind kind, std::size_t most) const {
    auto kept = kind == ScannerKind::kPlanar ? scans_that_hit() : heights_of_upright();
    double cell_m = cell_m_;
    while (kept.size() > std::max<std::size_t>(1, most)) {
      std::map<std::int64_t, int> wider;
      for (const auto& [key, hits] : kept) {
        int& there = wider[cell_key(column_of(key) >> 1, row_of(key) >> 1)];
        there = std::max(there, hits);
      }
      kept = std::move(wider);
      cell_m *= 2;
    }
    OccupancyImageResult result{cell_m, 0, {}};
    for (const auto& [key, hits] : kept) result.cells.push_back({column_of(key), row_of(key), hits});
    return result;
  }

 private:
  std::map<std::int64_t, int> scans_that_hit() const {
    std::map<std::int64_t, int> kept;
    for (const auto& [key, hits] : cells_) kept[key] = hits.scans;
    return kept;
  }

  std::map<std::int64_t, int> heights_of_upright() const {
    std::vector<std::size_t> counts;
    for (const auto& [_, hits] : cells_) counts.push_back(hits.heights.size());
    if (counts.empty()) return {};
    const auto high =
        counts.begin() + static_cast<std::ptrdiff_t>(std::min(kExcludedHighest, counts.size() - 1));
    std::nth_element(counts.begin(), high, counts.end(), std::greater<>());
    const double least =
        std::max<double>(params_.min_heights, params_.min_height_ratio * static_cast<double>(*high));
    std::map<std::int64_t, int> kept;
    for (const auto& [key, hits] : cells_)
      if (static_cast<double>(hits.heights.size()) >= least)
        kept[key] = static_cast<int>(hits.heights.size());
    return kept;
  }

  double cell_m_;
  const OccupancyImageParams& params_;
  std::unordered_map<std::int64_t, CellHits> cells_;
};

OccupancyImageResult picture_of(const Robot& robot, const RobotResult& estimate, const LidarParams& lidar,
                                const OccupancyImageParams& params, std::size_t robots) {
  const ScannerTraits traits = scanner_traits(robot.lidar, lidar);
  CellGrid grid(params.cell_spacings * traits.spacing_m, params);
  const auto scans = shown_scans(
      robot.lidar, estimate, std::max<std::size_t>(1, static_cast<std::size_t>(params.max_scans) / robots));
  for (std::size_t n = 0; n < scans.size(); ++n) {
    const Stamp stamp = robot.lidar.stamps[scans[n]];
    const SE3 T_frame_body = *estimate.dense.at(stamp);
    const auto points =
        filter_and_deskew(robot.lidar.read(scans[n]), twist_at(estimate.dense, stamp), lidar.points).points;
    const std::size_t stride = 1 + points.size() / static_cast<std::size_t>(params.max_points);
    for (std::size_t k = 0; k < points.size(); k += stride)
      grid.add(static_cast<std::int32_t>(n), T_frame_body * Eigen::Vector3d(points[k].cast<double>()));
  }
  OccupancyImageResult result =
      grid.picture(traits.kind, static_cast<std::size_t>(params.max_cells) / robots);
  result.scans = scans.size();
  return result;
}

}  // namespace

void add_occupancy_images(RunResult& result, const Mission& mission, const LidarParams& lidar,
                          const OccupancyImageParams& params) {
  const auto scanning = static_cast<std::size_t>(std::count_if(
      mission.robots.begin(), mission.robots.end(), [](const Robot& robot) { return !robot.lidar.empty(); }));
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (!mission.robots[r].lidar.empty() && !result.robots[r].dense.empty())
      result.robots[r].picture = picture_of(mission.robots[r], result.robots[r], lidar, params, scanning);
}

}  // namespace radioslam
