// LiDAR odometry per scan, and registration of two scans from an initial pose 0.3 m and 2 degrees off,
// including preprocessing. Scans of some 60,000 points in a simulated town, one thread.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/lidar/surfels/voxel_grid.hpp"
#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kScans = 100;

/// The first scans of one robot.
struct Recording {
  std::vector<Stamp> stamps;
  std::vector<LidarScan> scans;
  double points = 0;  ///< per scan
};

const Recording& recording() {
  static const Recording recorded = [] {
    CityParams params;
    params.path_length_m = 150;
    params.onboard.lidar.lidar_beams = 64;
    params.onboard.lidar.lidar_azimuth_steps = 1100;
    params.lidar_range_m = 100;
    const Simulation town = simulate_city(params, 1);
    const LidarLog& log = town.mission.robots.front().lidar;
    Recording result;
    for (std::size_t k = 0; k < kScans; ++k) {
      result.stamps.push_back(log.stamps[k]);
      result.scans.push_back(log.read(k));
      result.points += static_cast<double>(result.scans.back().points.size()) / kScans;
    }
    return result;
  }();
  return recorded;
}

ScannerTraits traits_of(const Recording& recorded) {
  LidarLog log{recorded.stamps, [&](std::size_t k) { return recorded.scans[k]; }};
  return scanner_traits(log, {});
}

/// The value below which `fraction` of the values are.
double quantile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  const auto k = static_cast<std::size_t>(fraction * static_cast<double>(values.size()));
  return values[std::min(values.size() - 1, k)];
}

void odometry(benchmark::State& state) {
  const Recording& recorded = recording();
  set_thread_count(1);
  const ScannerTraits traits = traits_of(recorded);
  std::size_t registered = 0;
  std::vector<double> took_ms;
  for (auto _ : state) {
    LidarOdometry odometer(traits, {});
    for (std::size_t k = 0; k < kScans; ++k) {
      const auto before = std::chrono::steady_clock::now();
      if (odometer.register_scan(recorded.stamps[k], recorded.scans[k]).status == ScanStatus::kRegistered)
        ++registered;
      const std::chrono::duration<double, std::milli> passed = std::chrono::steady_clock::now() - before;
      took_ms.push_back(passed.count());
    }
  }
  set_thread_count(0);
  if (registered + static_cast<std::size_t>(state.iterations()) !=
      kScans * static_cast<std::size_t>(state.iterations()))
    state.SkipWithError("not every scan was registered");
  state.counters["points"] = recorded.points;
  state.counters["median_ms"] = quantile(took_ms, 0.5);
  state.counters["p99_ms"] = quantile(took_ms, 0.99);
  state.counters["scans_per_s"] = benchmark::Counter(
      static_cast<double>(kScans) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

ScanPyramid pyramid_of(const LidarScan& scan, const ScannerTraits& traits, const LidarParams& params) {
  const auto points = filter_and_deskew(scan, SE3::Tangent::Zero(), params.points).points;
  return scan_pyramid(measure_surfels(voxel_downsample(points, traits.spacing_m), traits.spacing_m,
                                      traits.kind, params.surfel),
                      traits.spacing_m, traits.kind, params.map);
}

void registration(benchmark::State& state) {
  const Recording& recorded = recording();
  set_thread_count(1);
  const ScannerTraits traits = traits_of(recorded);
  const LidarParams params;
  PosePrior prior;
  prior.pose = SE3({0.2, -0.2, 0.1}, Eigen::Quaterniond(Eigen::AngleAxisd(0.035, Eigen::Vector3d::UnitZ())));
  prior.information.diagonal().setConstant(1e-3);
  for (auto _ : state) {
    LocalMap map(traits.spacing_m, params.map);
    map.add(pyramid_of(recorded.scans[0], traits, params), SE3(), 0);
    const ScanPyramid source = pyramid_of(recorded.scans[1], traits, params);
    benchmark::DoNotOptimize(register_near(map, source, prior, 0.5, traits.kind, params.registration));
  }
  set_thread_count(0);
  state.counters["points"] = recorded.points;
}

BENCHMARK(odometry)->Unit(benchmark::kMillisecond);
BENCHMARK(registration)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace radioslam
