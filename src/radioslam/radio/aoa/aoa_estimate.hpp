// Angle-of-arrival estimation by synthetic aperture: from the CSI that a moving receiver recorded of one
// transmitter, and the receiver's trajectory, to an AoA profile and its peaks.
//
//   snapshots    channel of every packet and position of the antenna
//   phases       oscillator offsets removed: square root of the two-way product, or difference of antennas
//   delays       each packet's own delay estimated against a multipath model and removed
//   profile      power over directions: Bartlett, MUSIC or sparse paths
//   peaks        refined below the grid's step, with sigma, relative power and mirror solution
//
// A straight trajectory observes only the angle to itself: sources are taken as level, and each has a mirror
// solution, left for right. A level trajectory cannot resolve up from down. Under multipath the channel of an
// antenna pair contains cross terms of the paths: they appear as spurious peaks that are not flagged, and the
// direct path may have no peak.
// Source: WSR (Jadhav et al., section 4); docs/decisions describes the square root, the delays against a
// path model and the subarrays. Frame: the trajectory's. Units: rad, m, dB.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/radio/aoa/aoa_types.hpp"
#include "radioslam/radio/channel/two_way_channel.hpp"

namespace radioslam {

/// Directions to one transmitter, from one window of packets.
struct AoaEstimate {
  Stamp stamp;                   ///< middle between first and last packet
  SE3 T_frame_body;              ///< receiver's pose at `stamp`
  Eigen::Vector3d centre_m;      ///< mean antenna position, from which directions are measured
  std::size_t packets = 0;       ///< used
  std::vector<AoaPeak> peaks;    ///< strongest first, at least one
  std::vector<float> profile;    ///< power over azimuth from -pi, maximum 1
  double explained = 0;          ///< the strongest peak's
  bool resolves_height = false;  ///< heights vary enough for signed elevations
};

struct TwoWayTrack {
  std::optional<ChannelTrack> track;
  TwoWayFailure reason = TwoWayFailure::kTooFewExchanges;  ///< valid where there is no track
};

/// Two-way channel of `sender`, from the captures of both ends.
TwoWayTrack two_way_track(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers,
                          double carrier_hz, const Eigen::Vector3d& antenna_m, const TwoWayParams& params);

/// Difference of two antennas, h_first conj(h_second), of every packet from `sender` (from any sender where
/// absent).
std::optional<ChannelTrack> antenna_pair_track(const CsiCapture& receiver, std::optional<MacAddress> sender,
                                               double carrier_hz,
                                               const std::vector<Eigen::Vector3d>& antennas_m, int first,
                                               int second);

enum class AoaFailure {
  kNoMotion,
  kTooFewPackets,
  kNoOdometry,
  kTooWide,     ///< aperture exceeds max_aperture_m
  kZeroChannel  ///< all channels are zero
};

struct AoaResult {
  std::optional<AoaEstimate> estimate;
  AoaFailure reason = AoaFailure::kNoMotion;  ///< valid where there is no estimate
};

/// AoA estimate from all packets between two stamps.
AoaResult estimate_aoa(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin, Stamp end,
                       const AoaParams& params);

}  // namespace radioslam
