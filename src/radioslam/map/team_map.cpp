#include "radioslam/map/team_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/evenly_chosen.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/map/map_surfaces.hpp"
#include "radioslam/map/occupancy.hpp"
#include "radioslam/map/ray_view.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kBlockScans = 16;
constexpr double kTile_m = 6;
constexpr std::size_t kMaxViewReturns = 20000;

Eigen::AlignedBox2d bounds_of(const std::vector<MappedRobot>& robots, const MapOptions& options) {
  Eigen::AlignedBox2d bounds;
  for (const MappedRobot& robot : robots)
    for (const auto& row : robot.poses) {
      const Eigen::Vector2d at = row.pose.translation().head<2>();
      const Eigen::Vector2d reach = Eigen::Vector2d::Constant(robot.geometry.reach_m);
      bounds.extend(Eigen::Vector2d(at - reach));
      bounds.extend(Eigen::Vector2d(at + reach));
    }
  if (!options.crop) return bounds;
  return bounds.intersection(
      Eigen::AlignedBox2d(options.crop->min().head<2>().eval(), options.crop->max().head<2>().eval()));
}

/// The items in an order of which any beginning is spread evenly: that of their numbers with the bits
/// reversed.
template <class T>
std::vector<T> spread(const std::vector<T>& of) {
  std::vector<T> result;
  const auto bits = static_cast<int>(std::bit_width(of.size()));
  for (std::size_t n = 0; n < std::size_t{1} << bits; ++n) {
    std::size_t reversed = 0;
    for (int bit = 0; bit < bits; ++bit) reversed |= ((n >> bit) & 1U) << (bits - 1 - bit);
    if (reversed < of.size()) result.push_back(of[reversed]);
  }
  return result;
}

/// Without returns outside of the crop, which their rays may still pass.
bool is_kept(const MapOptions& options, const Eigen::Vector3d& position) {
  return !options.crop || options.crop->contains(position);
}

}  // namespace

TeamMap::TeamMap(std::vector<MappedRobot> robots, const ScanPointParams& points, const MapParams& params,
                 const MapOptions& options)
    : robots_(std::move(robots)),
      points_(points),
      params_(params),
      options_(options),
      voxels_(params.voxel_m, static_cast<std::size_t>(params.max_points)) {
  RADIOSLAM_CHECK(!robots_.empty() && robots_.size() <= VoxelMap::kMaxRobots, "a map has robots");
  for (const MappedRobot& robot : robots_) result_.robots.push_back(robot.id);
  gather();
  result_.seen_through = leave_out_moving();
  result_.voxel_m = voxels_.voxel_m();
  result_.all_points = voxels_.voxels().size() - result_.seen_through;
  choose_shown_points();
}

/// In time order, then by robot.
std::vector<TeamMap::Task> TeamMap::tasks(double step_m, double step_s) const {
  std::vector<Task> all;
  for (std::size_t r = 0; r < robots_.size(); ++r)
    for (const std::size_t k : scans_apart(robots_[r], step_m, step_s)) all.push_back({r, k});
  std::sort(all.begin(), all.end(), [&](const Task& a, const Task& b) {
    return std::pair(robots_[a.robot].scans.stamps[a.scan], a.robot) <
           std::pair(robots_[b.robot].scans.stamps[b.scan], b.robot);
  });
  return all;
}

/// From the first pose of any robot to the last.
double TeamMap::duration_s() const {
  Stamp first = robots_.front().poses.front().stamp, last = first;
  for (const MappedRobot& robot : robots_) {
    first = std::min(first, robot.poses.front().stamp);
    last = std::max(last, robot.poses.back().stamp);
  }
  constexpr double kLeast_s = 10;
  return std::max(kLeast_s, seconds_between(first, last));
}

void TeamMap::for_each_block(const std::vector<Task>& tasks, double share, const char* what,
                             const std::function<void(const Block&)>& take) const {
  for (std::size_t begin = 0; begin < tasks.size(); begin += kBlockScans) {
    Block block(std::min(kBlockScans, tasks.size() - begin));
    parallel_for(block.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        const Task& task = tasks[begin + n];
        block[n] = place_scan(robots_[task.robot], task.scan, points_, share);
        block[n].robot = task.robot;
      }
    });
    take(block);
    report_progress(options_.progress, what,
                    static_cast<double>(begin + block.size()) / static_cast<double>(tasks.size()));
  }
}

void TeamMap::insert(const Block& block) {
  for (const PlacedScan& scan : block) {
    const Eigen::Matrix3d R = scan.T_frame_body.rotation_matrix();
    const Eigen::Vector3d t = scan.T_frame_body.translation();
    const Eigen::Vector3d scanner = robots_[scan.robot].geometry.scanner_m;
    std::vector<MapReturn> placed;
    MapReturn next;
    next.robot = static_cast<std::uint16_t>(scan.robot);
    next.time_ms = static_cast<std::uint32_t>((scan.stamp.ns - result_.start.ns) / 1000000);
    const ScanPoints& returns = scan.returns;
    result_.has_intensity = result_.has_intensity || !returns.intensities.empty();
    for (std::size_t k = 0; k < returns.points.size(); ++k) {
      const Eigen::Vector3d body = returns.points[k].cast<double>();
      next.position = R * body + t;
      if (!is_kept(options_, next.position)) continue;
      next.to_scanner = (R * (scanner - body)).normalized().cast<float>();
      if (!returns.intensities.empty())
        next.intensity = std::isfinite(returns.intensities[k]) ? returns.intensities[k] : 0;
      placed.push_back(next);
    }
    voxels_.add(placed);
  }
}

void TeamMap::gather() {
  std::vector<Task> all = tasks(params_.scan_step_m, params_.scan_step_s);
  if (all.empty()) return;
  result_.start = robots_[all.front().robot].scans.stamps[all.front().scan];
  double returns = 0;
  for (const Task& task : all) returns += robots_[task.robot].geometry.returns_per_scan;
  // What is too much is thinned among scans and within them.
  const double share = std::sqrt(std::min(1.0, params_.points_per_s * duration_s() / std::max(1.0, returns)));
  const auto kept = static_cast<std::size_t>(std::ceil(share * static_cast<double>(all.size())));
  all = evenly_chosen(std::move(all), kept);
  result_.scans = all.size();
  OccupancyBuilder occupancy(bounds_of(robots_, options_), params_);
  for_each_block(all, share, "map", [&](const Block& block) {
    parallel_for(2, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t part = begin; part < end; ++part)
        if (part == 0)
          insert(block);
        else
          for (const PlacedScan& scan : block) occupancy.add(scan, robots_[scan.robot]);
    });
  });
  result_.grid = occupancy.grid();
  tiles_ = voxels_.sort_into_tiles(kTile_m);
}

std::size_t TeamMap::leave_out_moving() {
  std::vector<bool> is_planar;
  double returns = 0;
  for (const MappedRobot& robot : robots_) {
    is_planar.push_back(robot.kind == ScannerKind::kPlanar);
    returns = std::max(returns, robot.geometry.returns_per_scan);
  }
  estimate_normals(voxels_, tiles_, is_planar);
  const auto most = static_cast<std::size_t>(params_.views_per_s * duration_s());
  const double share = std::min(1.0, static_cast<double>(kMaxViewReturns) / std::max(1.0, returns));
  for_each_block(spread(evenly_chosen(tasks(params_.view_step_m, params_.view_step_s), most)), share,
                 "moving things", [&](const Block& block) {
                   std::vector<std::optional<RayView>> made(block.size());
                   parallel_for(block.size(), 1, [&](std::size_t begin, std::size_t end) {
                     for (std::size_t n = begin; n < end; ++n)
                       made[n].emplace(block[n], robots_[block[n].robot], params_.view_range_m);
                   });
                   std::vector<RayView> views;
                   for (auto& view : made) views.push_back(*std::move(view));
                   count_rays(voxels_, tiles_, views, params_);
                 });
  return leave_out_seen_through(voxels_, tiles_, params_);
}

void TeamMap::for_each_point(
    const std::function<void(const Eigen::Vector3d& position, const MapPoint& point)>& take) const {
  for (const Voxel& voxel : voxels_.voxels()) {
    if (voxel.is_left_out) continue;
    constexpr float kSeconds_per_ms = 1e-3F;
    const Eigen::Vector3d position = voxels_.position(voxel);
    take(position, {position.cast<float>(), normal_of(voxel), voxel.intensity,
                    kSeconds_per_ms * static_cast<float>(voxel.time_ms), VoxelMap::robot_of(voxel)});
  }
}

void TeamMap::choose_shown_points() {
  const std::size_t all = result_.all_points, most = static_cast<std::size_t>(params_.max_shown_points);
  std::size_t n = 0;
  for_each_point([&](const Eigen::Vector3d&, const MapPoint& point) {
    if (all <= most || (n + 1) * most / all != n * most / all) result_.points.push_back(point);
    ++n;
  });
}

}  // namespace radioslam
