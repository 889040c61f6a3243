// Angles of arrival from what a radio heard while it moved: from channels to peaks.
//
//   snapshots    the channel of every packet, and where the antenna was
//   one way      offsets undone: the square root of the product both ways, or the ratio of two antennas
//   slopes       each packet's own delay taken off against the few waves that explain the channel
//   profile      how strongly a wave from each direction is in the channel: Bartlett, MUSIC or sparse paths
//   peaks        refined below the grid's step, with sigma, relative power, and what they may be instead
//
// A way that is straight, to within what turns no phase, tells one angle, to itself: its directions are taken
// as level, and each may be its mirror image, left for right. A level way does not tell up from down. What
// antennas against each other hear of several paths holds products of theirs as well, which are not told from
// paths: with a pair the false peaks stand unnamed, and none may be the direct one.
// Source: theory as in WSR (Jadhav et al., section 4); the square root, the slopes against a path model and
// the sub-arcs are ours (docs/decisions.md). Frame: the trajectory's. Units: rad, m, dB.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/radio/synthetic_array.hpp"
#include "radioslam/radio/two_way_channel.hpp"

namespace radioslam {

struct ArrivalParams {
  TwoWayParams two_way;
  std::string profile = "bartlett";  ///< bartlett, music or sparse
  int azimuths = 360;                ///< of the grid; peaks are refined below its step
  double most_elevation_rad = 0.7;   ///< up and, where the motion leaves its plane, down
  double nearest_source_m = 2;       ///< waves are as bent as from there, or less
  double subarray_m = 0.25;          ///< the way's pieces, half overlapping, whose profiles are added
  double least_step_m = 5e-4;        ///< a packet counts once the antenna has moved so far since the last
  double least_way_m = 0.15;         ///< a shorter way tells no direction
  double most_extent_m = 4;          ///< a wider one has no one direction, and takes long
  int model_paths = 8;               ///< waves that each packet's delay is measured against
  int model_passes = 4;
  int peaks = 4;                  ///< at most
  double sigma_floor_rad = 0.03;  ///< of antennas' places and clocks, beside what the channel tells

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    TwoWayParams::visit_fields(self.two_way, visit);
    visit(Field{"profile", "", 0, 0, "what finds directions", "bartlett|music|sparse"}, self.profile);
    visit(Field{"azimuths", "", 36, 3600, "of the profile's grid"}, self.azimuths);
    visit(Field{"most_elevation_rad", "rad", 0, 1.57, "searched up, and down where the motion is not plane"},
          self.most_elevation_rad);
    visit(Field{"nearest_source_m", "m", 0.5, 1e6, "spherical waves are tried down to this distance"},
          self.nearest_source_m);
    visit(Field{"subarray_m", "m", 0.05, 1e6, "pieces of the way whose profiles are added"}, self.subarray_m);
    visit(Field{"least_step_m", "m", 0, 0.1, "between packets that count"}, self.least_step_m);
    visit(Field{"least_way_m", "m", 0.01, 100, "shorter ways are not measured"}, self.least_way_m);
    visit(Field{"most_extent_m", "m", 0.1, 30, "wider ways are not measured; the time grows with the cube"},
          self.most_extent_m);
    visit(Field{"model_paths", "", 1, 32, "waves against which packets' delays are measured"},
          self.model_paths);
    visit(Field{"model_passes", "", 0, 20, "rounds of that"}, self.model_passes);
    visit(Field{"peaks", "", 1, 16, "most directions of one measurement"}, self.peaks);
    visit(Field{"sigma_floor_rad", "rad", 0, 1, "of the antennas' places and the clocks"},
          self.sigma_floor_rad);
  }
};

/// A direction in the trajectory's frame.
struct ArrivalDirection {
  double azimuth_rad = 0, elevation_rad = 0;
};

/// One direction that a wave came from.
struct ArrivalPeak {
  double azimuth_rad = 0;          ///< in the trajectory's frame
  double elevation_rad = 0;        ///< likewise; of a level way up, though down is as likely
  double sigma_rad = 0;            ///< of the azimuth
  double elevation_sigma_rad = 0;  ///< half a turn over the root of three where the way does not tell
  double power_db = 0;             ///< to the strongest peak
  double curvature_per_m = 0;      ///< one over the source's distance, as far as the wave shows it
  double explained = 0;            ///< share of the channel that this wave alone explains, 0 to 1
  std::optional<ArrivalDirection>
      mirror;             ///< as likely: the other side of a straight way, or of a way's plane
  bool is_ghost = false;  ///< a product of two paths, between them
};

/// What one window of packets tells of one transmitter.
struct ArrivalEstimate {
  Stamp stamp;                     ///< the middle of the packets
  SE3 T_frame_body;                ///< of the receiver then
  Eigen::Vector3d centre_m;        ///< mean place of the antenna: directions are seen from there
  std::size_t packets = 0;         ///< that count
  std::vector<ArrivalPeak> peaks;  ///< the strongest first, at least one
  std::vector<float> profile;      ///< power over azimuth from -pi, the strongest 1
  double explained = 0;            ///< the strongest peak's
  bool tells_height = false;       ///< the way leaves its level by enough for signed elevations
};

/// Channels and where they were measured, free of the oscillators' phases.
struct ChannelTrack {
  std::vector<Stamp> stamps;  ///< increasing
  Eigen::MatrixXcd channel;   ///< packets x subcarriers
  std::vector<double> subcarrier_hz;
  double carrier_hz = 0;
  bool is_two_way = false;  ///< the product of both ways, else an antenna against another
  Eigen::Vector3d lever_arm_m =
      Eigen::Vector3d::Zero();  ///< antenna in the body frame; of a pair the difference
};

struct TwoWayTrack {
  std::optional<ChannelTrack> track;
  NoTwoWay reason = NoTwoWay::kTooFewExchanges;  ///< where there is none
};

/// From both ends' captures.
TwoWayTrack two_way_track(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers,
                          double carrier_hz, const Eigen::Vector3d& antenna_m, const TwoWayParams& params);

/// Antenna `first` against `second`, h_first conj(h_second), of every packet from `sender` (of any where
/// absent).
std::optional<ChannelTrack> antenna_pair_track(const CsiCapture& receiver, std::optional<MacAddress> sender,
                                               double carrier_hz,
                                               const std::vector<Eigen::Vector3d>& antennas_m, int first,
                                               int second);

enum class NoArrival {
  kNoMotion,
  kTooFewPackets,
  kNoOdometry,
  kTooWide,  ///< the way, beyond most_extent_m
  kSilent    ///< the channel is zero throughout
};

struct ArrivalResult {
  std::optional<ArrivalEstimate> estimate;
  NoArrival reason = NoArrival::kNoMotion;  ///< where there is none
};

/// Of all packets between two stamps.
ArrivalResult estimate_arrival(const ChannelTrack& track, const Trajectory<SE3>& trajectory, Stamp begin,
                               Stamp end, const ArrivalParams& params);

}  // namespace radioslam
