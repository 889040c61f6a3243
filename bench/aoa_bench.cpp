// Benchmark of angle-of-arrival estimation, on one core.
//   beams/...   one profile, 360 azimuths x 90 elevations, of a two-way product of 500 packets x 30
//               subcarriers on a random path of a metre: three plane waves, noise 20 dB below them
//   pair        two-way channel of a simulated capture of 1,500 exchanges in a room, as published by WSR
//   estimate    AoA estimate from that channel
// Counters: `peak_MiB`, peak memory of the process so far.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/aoa/beamforming.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"
#include "radioslam/radio/aoa/multipath_model.hpp"
#include "radioslam/sim/sensors/csi_exchange.hpp"

namespace radioslam {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kCarrier_hz = 5.54e9;
constexpr MacAddress kDriver{0x0016ea000001}, kStander{0x0016ea000002};

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Closed path composed of a few harmonics of random phase, about `size_m` across.
class RandomPath {
 public:
  RandomPath(double size_m, bool is_plane, Rng rng) : size_m_(size_m), is_plane_(is_plane) {
    for (Eigen::Index k = 0; k < phase_rad_.size(); ++k) phase_rad_(k) = rng.uniform(0, kTurn_rad);
  }
  Eigen::Vector3d at(double fraction) const {
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (Eigen::Index wave = 0; wave < phase_rad_.cols(); ++wave)
      for (Eigen::Index axis = 0; axis < (is_plane_ ? 2 : 3); ++axis)
        place[axis] +=
            std::sin(kTurn_rad * static_cast<double>(wave + 1) * fraction + phase_rad_(axis, wave)) /
            static_cast<double>(wave + 1);
    return size_m_ / 3 * place;
  }

 private:
  double size_m_;
  bool is_plane_;
  Eigen::Matrix3d phase_rad_;
};

SyntheticArray moved_radio(bool is_plane) {
  constexpr Eigen::Index kPackets = 500;
  constexpr double kNoise = 0.1;  // relative to the strongest wave's amplitude
  const RandomPath path(1, is_plane, Rng(1));
  SyntheticArray array;
  array.subcarrier_hz = CsiBand::intel5300(kCarrier_hz).subcarrier_hz;
  array.wavenumber_radpm = 2 * kTurn_rad * kCarrier_hz / kLightSpeed_mps;
  array.positions_m.resize(3, kPackets);
  for (Eigen::Index k = 0; k < kPackets; ++k)
    array.positions_m.col(k) = path.at(static_cast<double>(k) / kPackets);
  array.positions_m.colwise() -= Eigen::Vector3d(array.positions_m.rowwise().mean());
  array.channel =
      channel_of({{{0.4, 0.2, 0}, 0, 1}, {{2.1, 0.5, 0}, 30e-9, 0.6}, {{-1.7, 0.1, 0}, 75e-9, 0.4}}, array);
  Rng noise(2);
  const double sigma = kNoise / std::numbers::sqrt2;
  for (std::complex<double>& h : array.channel.reshaped())
    h += std::complex<double>(noise.normal(0, sigma), noise.normal(0, sigma));
  return array;
}

void beams(benchmark::State& state, bool is_plane) {
  const SyntheticArray array = moved_radio(is_plane);
  const DelayTable delays = delay_table(array.subcarrier_hz);
  WaveGrid grid;
  grid.elevations_rad.clear();
  for (int k = 0; k < 90; ++k) grid.elevations_rad.push_back(k * kTurn_rad / 360);
  for (auto _ : state) benchmark::DoNotOptimize(array_beams(array, grid, delays));
  state.counters["peak_MiB"] = peak_mib();
}

/// One robot drives a path in a room, another stands still and replies.
struct Exchange {
  CsiCapture driver, stander;
  Trajectory<SE3> trajectory;
};

Exchange wsr_like() {
  constexpr int kPackets = 1500;
  constexpr double kRate_hz = 120, kEnd_s = kPackets / kRate_hz, kPoses_hz = 200;
  const RandomPath path(0.8, true, Rng(3));
  const auto pose_at = [&](double t_s) {
    return SE3(Eigen::Vector3d(3, 3, 0.3) + path.at(t_s / kEnd_s), Eigen::Quaterniond::Identity());
  };
  const auto standing_pose = [](double /*t_s*/) { return SE3({7, 5, 0.5}, Eigen::Quaterniond::Identity()); };
  const CsiCardParams cards;
  const CsiRadio driver{kDriver, {{0, 0, 0}}, pose_at, CsiCard(cards, kEnd_s, Rng(4))};
  const CsiRadio stander{kStander, {{0, 0, 0}}, standing_pose, CsiCard(cards, kEnd_s, Rng(5))};
  const double x_m = 10, y_m = 8;
  const auto wall = [](const Eigen::Vector2d& begin, const Eigen::Vector2d& end) {
    return WallSegment{begin, end, -0.4, 8};
  };
  const CsiMedium air{room_paths({wall({0, 0}, {x_m, 0}), wall({x_m, 0}, {x_m, y_m}),
                                  wall({x_m, y_m}, {0, y_m}), wall({0, y_m}, {0, 0})},
                                 {}),
                      CsiBand::intel5300(kCarrier_hz), cards};
  std::vector<SentPacket> asked;
  for (int k = 0; k < kPackets; ++k) asked.push_back({k / kRate_hz, static_cast<std::uint32_t>(k)});
  ReceivedPackets heard = exchange_packets(driver, stander, asked, air, Rng(6));
  std::vector<StampedPose<SE3>> poses;
  for (int k = 0; k <= kEnd_s * kPoses_hz; ++k)
    poses.push_back({{static_cast<std::int64_t>(k * 1e9 / kPoses_hz)}, pose_at(k / kPoses_hz)});
  return {record_as_sent(std::move(heard.by_asker), air, Rng(7)),
          record_as_sent(std::move(heard.by_answerer), air, Rng(8)), Trajectory<SE3>(std::move(poses))};
}

ChannelTrack track_of(const Exchange& exchange, const AoaParams& params) {
  return two_way_track(exchange.driver, kStander, exchange.stander, kCarrier_hz, Eigen::Vector3d::Zero(),
                       params.two_way)
      .track.value();
}

void pair(benchmark::State& state) {
  const Exchange exchange = wsr_like();
  for (auto _ : state) benchmark::DoNotOptimize(track_of(exchange, {}));
}

void estimate(benchmark::State& state, const char* profile) {
  set_thread_count(1);
  const Exchange exchange = wsr_like();
  AoaParams params;
  params.profile = profile;
  const ChannelTrack track = track_of(exchange, params);
  AoaResult result;
  for (auto _ : state)
    result = estimate_aoa(track, exchange.trajectory, track.stamps.front(), track.stamps.back(), params);
  const double truth_rad = std::atan2(5 - result.estimate->centre_m.y(), 7 - result.estimate->centre_m.x());
  state.counters["error_deg"] =
      std::abs(result.estimate->peaks.front().azimuth_rad - truth_rad) * 360 / kTurn_rad;
  state.counters["packets"] = static_cast<double>(result.estimate->packets);
  state.counters["peak_MiB"] = peak_mib();
}

BENCHMARK_CAPTURE(beams, space, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(beams, plane, true)->Unit(benchmark::kMillisecond);
BENCHMARK(pair)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(estimate, bartlett, "bartlett")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(estimate, sparse, "sparse")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace radioslam
