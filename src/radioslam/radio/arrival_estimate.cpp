#include "radioslam/radio/arrival_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/radio/arrival_channel.hpp"
#include "radioslam/radio/arrival_peaks.hpp"
#include "radioslam/radio/arrival_slopes.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kFewestPackets = 16;

void fill_peaks(ArrivalEstimate& estimate, MovedArray& one_way, ArrivalParams params) {
  // Only Bartlett's profile is a sum over pieces of the way.
  if (params.profile != "bartlett") params.subarray_m = std::max(params.subarray_m, 2 * one_way.way_m);
  std::vector<WavePath> waves;
  if (!one_way.is_difference) waves = align_to_waves(one_way, params);
  const MovedArray even = one_way.is_difference ? evened(one_way) : both_ways(one_way);
  const AzimuthProfile profile =
      params.profile == "music" ? music_profile(one_way, params) : bartlett_profile(even, params);
  const bool is_sparse = params.profile == "sparse";
  if (is_sparse && waves.empty())
    waves = find_paths(one_way.array, grid_for(one_way, params, params.azimuths),
                       delay_table(one_way.array.subcarrier_hz), params.model_paths);
  estimate.peaks = is_sparse ? peaks_of_waves(waves, one_way, params)
                             : find_peaks(profile, params.profile == "music" ? one_way : even, params);
  if (!one_way.is_difference && !is_sparse) name_ghosts(estimate.peaks, waves, one_way);
  const double most = *std::max_element(profile.power.begin(), profile.power.end());
  for (const double power : profile.power) estimate.profile.push_back(static_cast<float>(power / most));
  estimate.explained = estimate.peaks.front().explained;
}

}  // namespace

ArrivalResult estimate_arrival(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin,
                               Stamp end, const ArrivalParams& params) {
  const ChannelTrack part = one_way_between(track, begin, end);
  if (part.stamps.empty()) return {std::nullopt, NoArrival::kTooFewPackets};
  MovedArray one_way = moved_array(part, trajectory, begin, end, params);
  if (one_way.rows.empty()) return {std::nullopt, NoArrival::kNoOdometry};
  if (!one_way.is_difference && one_way.way_m < params.least_way_m)
    return {std::nullopt, NoArrival::kNoMotion};
  if (one_way.extent_m > params.most_extent_m) return {std::nullopt, NoArrival::kTooWide};
  if (one_way.rows.size() < kFewestPackets) return {std::nullopt, NoArrival::kTooFewPackets};
  if (one_way.array.channel.squaredNorm() == 0) return {std::nullopt, NoArrival::kSilent};
  ArrivalEstimate estimate;
  const Stamp first = part.stamps[one_way.rows.front()], last = part.stamps[one_way.rows.back()];
  estimate.stamp = {first.ns + (last.ns - first.ns) / 2};
  estimate.T_frame_body = *trajectory.at(estimate.stamp);
  estimate.centre_m = one_way.array.centre_m;
  estimate.packets = one_way.rows.size();
  estimate.tells_height = one_way.shape == ArrayShape::kSpace;
  fill_peaks(estimate, one_way, params);
  return {std::move(estimate), {}};
}

}  // namespace radioslam
