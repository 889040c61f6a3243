#include "radioslam/radio/aoa/aoa_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "radioslam/radio/aoa/aoa_array.hpp"
#include "radioslam/radio/aoa/aoa_peaks.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {
namespace {

// Channels that an AoA estimate works on: one-way channel, two-way product, or difference of an antenna pair.

/// The track's packets between two stamps. Of a two-way product the packets' delays are aligned with those
/// before and the square root is taken; the difference of an antenna pair is copied unchanged.
ChannelTrack one_way_channel(const ChannelTrack& track, Stamp begin, Stamp end) {
  ChannelTrack part = track;
  const auto first = std::lower_bound(track.stamps.begin(), track.stamps.end(), begin) - track.stamps.begin();
  const auto last = std::upper_bound(track.stamps.begin(), track.stamps.end(), end) - track.stamps.begin();
  part.stamps.assign(track.stamps.begin() + first, track.stamps.begin() + last);
  part.channel = track.channel.middleRows(first, std::max<std::ptrdiff_t>(last - first, 0));
  if (!track.is_two_way || part.stamps.empty()) return part;
  align_to_predecessors(part.channel, part.subcarrier_hz, packet_delays(part.subcarrier_hz), kNewestRatio);
  part.channel = square_root_channel(part.channel);
  return part;
}

/// Two-way product of a one-way channel, normalised to unit amplitude: faded values weigh as much as others.
MovedArray two_way_product(const MovedArray& one_way) {
  MovedArray both = one_way;
  both.array.channel = one_way.array.channel.unaryExpr([](const std::complex<double>& h) {
    const double power = std::norm(h);
    return power > 0 ? h * h / power : h;
  });
  both.array.wavenumber_radpm *= 2;
  return both;
}

/// An antenna pair's channel, normalised to unit amplitude.
MovedArray amplitude_equalised(const MovedArray& difference) {
  MovedArray even = difference;
  even.array.channel = difference.array.channel.unaryExpr([](const std::complex<double>& h) {
    const double size = std::abs(h);
    return size > 0 ? h / size : h;
  });
  return even;
}

constexpr std::size_t kMinPackets = 16;

void fill_peaks(AoaEstimate& estimate, MovedArray& one_way, AoaParams params) {
  const AoaProfileKind kind = profile_kind(params);
  // Only the Bartlett profile is a sum over subarrays; the others use the whole aperture.
  if (kind != AoaProfileKind::kBartlett) params.subarray_m = std::max(params.subarray_m, 2 * one_way.way_m);
  std::vector<WavePath> waves;
  if (!one_way.is_difference) waves = align_delays(one_way, params);
  const MovedArray even = one_way.is_difference ? amplitude_equalised(one_way) : two_way_product(one_way);
  const AzimuthProfile profile =
      kind == AoaProfileKind::kMusic ? music_profile(one_way, params) : bartlett_profile(even, params);
  const bool is_sparse = kind == AoaProfileKind::kSparse;
  if (is_sparse && waves.empty())
    waves = find_paths(one_way.array, grid_for(one_way, params, params.azimuths),
                       delay_table(one_way.array.subcarrier_hz), params.model_paths);
  estimate.peaks = is_sparse ? peaks_of_waves(waves, one_way, params)
                             : find_peaks(profile, kind == AoaProfileKind::kMusic ? one_way : even, params);
  if (!one_way.is_difference && !is_sparse) mark_cross_terms(estimate.peaks, waves, one_way);
  const double most = *std::max_element(profile.power.begin(), profile.power.end());
  for (const double power : profile.power) estimate.profile.push_back(static_cast<float>(power / most));
  estimate.explained = estimate.peaks.front().explained;
}

}  // namespace

AoaResult estimate_aoa(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const AoaParams& params) {
  const ChannelTrack part = one_way_channel(track, begin, end);
  if (part.stamps.empty()) return {std::nullopt, AoaFailure::kTooFewPackets};
  MovedArray one_way = moved_array(part, trajectory, begin, end, params);
  if (one_way.rows.empty()) return {std::nullopt, AoaFailure::kNoOdometry};
  if (!one_way.is_difference && one_way.way_m < params.min_aperture_m)
    return {std::nullopt, AoaFailure::kNoMotion};
  if (one_way.extent_m > params.max_aperture_m) return {std::nullopt, AoaFailure::kTooWide};
  if (one_way.rows.size() < kMinPackets) return {std::nullopt, AoaFailure::kTooFewPackets};
  if (one_way.array.channel.squaredNorm() == 0) return {std::nullopt, AoaFailure::kZeroChannel};
  AoaEstimate estimate;
  const Stamp first = part.stamps[one_way.rows.front()], last = part.stamps[one_way.rows.back()];
  estimate.stamp = {first.ns + (last.ns - first.ns) / 2};
  estimate.T_frame_body = *trajectory.at(estimate.stamp);
  estimate.centre_m = one_way.array.centre_m;
  estimate.packets = one_way.rows.size();
  estimate.resolves_height = one_way.shape == ArrayShape::kSpace;
  fill_peaks(estimate, one_way, params);
  return {std::move(estimate), {}};
}

}  // namespace radioslam
