#include "radioslam/radio/clock_offset.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "radioslam/radio/arrival_channel.hpp"
#include "radioslam/radio/arrival_slopes.hpp"

namespace radioslam {
namespace {

constexpr int kAzimuths = 120;
constexpr Eigen::Index kThinning = 3;
constexpr std::size_t kFewestPackets = 100;
constexpr std::size_t kFewestPieces = 3;

/// Where the sum of some pieces' curves is largest, refined between the steps, in steps.
double best_step(const std::vector<std::vector<double>>& curves, std::size_t left_out) {
  std::vector<double> sum(curves.front().size(), 0);
  for (std::size_t piece = 0; piece < curves.size(); ++piece)
    for (std::size_t k = 0; piece != left_out && k < sum.size(); ++k) sum[k] += curves[piece][k];
  const auto best = static_cast<std::size_t>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  if (best == 0 || best + 1 == sum.size()) return static_cast<double>(best);
  const double bend = sum[best - 1] - 2 * sum[best] + sum[best + 1];
  return static_cast<double>(best) + (bend < 0 ? (sum[best - 1] - sum[best + 1]) / (2 * bend) : 0);
}

}  // namespace

ChannelTrack shifted(ChannelTrack track, double offset_s) {
  for (Stamp& stamp : track.stamps) stamp.ns += std::llround(offset_s * 1e9);
  return track;
}

std::optional<ClockOffset> estimate_clock_offset(const ChannelTrack& track, const Trajectory<SE3>& trajectory,
                                                 const ArrivalParams& params,
                                                 const ClockOffsetParams& search) {
  if (track.stamps.empty()) return std::nullopt;
  const Stamp begin = track.stamps.front(), end = track.stamps.back();
  ChannelTrack one_way = one_way_between(track, begin, end);
  MovedArray moved = moved_array(one_way, trajectory, begin, end, params);
  if (moved.rows.size() < kFewestPackets || moved.is_difference) return std::nullopt;
  align_to_waves(moved, params);
  for (std::size_t k = 0; k < moved.rows.size(); ++k)
    one_way.channel.row(static_cast<Eigen::Index>(moved.rows[k])) =
        moved.array.channel.row(static_cast<Eigen::Index>(k));
  const auto steps = static_cast<int>(std::lround(search.most_s / search.step_s));
  std::vector<std::vector<double>> curves;
  for (int step = -steps; step <= steps; ++step) {
    MovedArray there = moved;
    for (std::size_t k = 0; k < moved.rows.size(); ++k) {
      const Stamp at{one_way.stamps[moved.rows[k]].ns + std::llround(step * search.step_s * 1e9)};
      const Stamp inside = std::clamp(at, trajectory.front().stamp, trajectory.back().stamp);
      there.array.positions_m.col(static_cast<Eigen::Index>(k)) =
          *trajectory.at(inside) * track.lever_arm_m - moved.array.centre_m;
    }
    if (there.is_plane) there.array.positions_m.row(2).setZero();
    WaveGrid grid = grid_for(there, params, kAzimuths);
    if (there.is_plane) grid.elevations_rad = {0};
    const DelayTable delays = delay_table(there.array.subcarrier_hz);
    const auto pieces = subarrays(both_ways(there).array, params.subarray_m);
    if (pieces.size() < kFewestPieces) return std::nullopt;
    curves.resize(std::max(curves.size(), pieces.size()));
    for (std::size_t piece = 0; piece < curves.size(); ++piece) {
      const ArrayBeams beams = array_beams(
          thinned(pieces[std::min(piece, pieces.size() - 1)], kThinning), grid, delays);
      curves[piece].push_back(
          static_cast<double>(*std::max_element(beams.power.begin(), beams.power.end())));
    }
  }
  for (auto& curve : curves) curve.resize(static_cast<std::size_t>(2 * steps + 1), 0);
  const auto n = static_cast<double>(curves.size());
  const double best = best_step(curves, curves.size());
  double scatter = 0;
  for (std::size_t piece = 0; piece < curves.size(); ++piece)
    scatter += std::pow(best_step(curves, piece) - best, 2);
  const double sigma = std::min(std::hypot(std::sqrt((n - 1) / n * scatter), 0.5), static_cast<double>(steps));
  return ClockOffset{(best - steps) * search.step_s, sigma * search.step_s};
}

}  // namespace radioslam
