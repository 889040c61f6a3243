#include "radioslam/radio/aoa/aoa_channel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "radioslam/radio/aoa/delay_alignment.hpp"
#include "radioslam/radio/channel/square_root_channel.hpp"
#include "radioslam/radio/channel/subcarrier_slopes.hpp"

namespace radioslam {

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

MovedArray two_way_product(const MovedArray& one_way) {
  MovedArray both = one_way;
  both.array.channel = one_way.array.channel.unaryExpr([](const std::complex<double>& h) {
    const double power = std::norm(h);
    return power > 0 ? h * h / power : h;
  });
  both.array.wavenumber_radpm *= 2;
  return both;
}

MovedArray amplitude_equalised(const MovedArray& difference) {
  MovedArray even = difference;
  even.array.channel = difference.array.channel.unaryExpr([](const std::complex<double>& h) {
    const double size = std::abs(h);
    return size > 0 ? h / size : h;
  });
  return even;
}

}  // namespace radioslam
