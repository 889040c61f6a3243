// Packet exchange between two WiFi cards: packets and answers, as recorded by both.
//
// The asker sends a packet at t; the answerer measures it and answers at t + g with jitter in g; the asker
// measures the answer, which carries the packet's counter. With D the phase of the answerer's oscillator
// minus the asker's, they measure
//   at t:      h exp(-j D(t))            at t + g:  h exp(+j D(t + g)),
// each with the slope of its own detection delay, so the product is h^2 exp(j 2 pi f g), where f = D' / (2
// pi) is the answerer's carrier minus the asker's. Frames are sent by antenna 0; all antennas receive.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/csi.hpp"
#include "radioslam/sim/sensors/csi_card.hpp"
#include "radioslam/sim/sensors/image_sources.hpp"

namespace radioslam {

// Channel state information of given paths: one complex number per subcarrier.
//
//   h_k = sum over paths of amplitude * exp(-j 2 pi (carrier + subcarrier_k) length / c)
// The paths are those of a room (image_sources.hpp), or plane waves from given directions.

inline constexpr double kLightSpeed_mps = 299'792'458;

/// Carrier and subcarriers of a channel.
struct CsiBand {
  double carrier_hz = 5.54e9;         ///< channel 108
  std::vector<double> subcarrier_hz;  ///< relative to the carrier
  double bandwidth_hz = 20e6;

  /// 20 MHz around a carrier, with the subcarriers that an Intel 5300 reports.
  static CsiBand intel5300(double carrier_hz);
};

/// All paths between two antennas in the common frame; directions are those seen from `here`.
using PathsBetween =
    std::function<std::vector<RadioPath>(const Eigen::Vector3d& here_m, const Eigen::Vector3d& there_m)>;

/// One row, one column per subcarrier.
Eigen::RowVectorXcd channel_of(const std::vector<RadioPath>& paths, const CsiBand& band);

/// A wave from a source at infinity, with the same direction everywhere.
struct PlaneWave {
  double azimuth_rad = 0;  ///< of the source, in the common frame
  double elevation_rad = 0;
  double power_db = 0;
  double delay_s = 0;  ///< at the common frame's origin
};

/// Plane waves, independent of the other antenna's position.
PathsBetween plane_wave_paths(std::vector<PlaneWave> waves);

/// The paths in a room.
PathsBetween room_paths(std::vector<WallSegment> walls, const ImageParams& params);

/// T_common_body at a time in seconds.
using BodyAtTime = std::function<SE3(double t_s)>;

/// A card on a robot.
struct CsiRadio {
  MacAddress address;
  std::vector<Eigen::Vector3d> antennas_m;  ///< in the body frame, one to three
  BodyAtTime T_common_body;
  CsiCard card;
};

/// A sent packet.
struct SentPacket {
  double t_s = 0;
  std::uint32_t counter = 0;
};

/// A received packet, not yet stamped by the host.
struct ReceivedPacket {
  double t_s = 0;  ///< true time
  CsiPacket packet;
};

/// The records of both ends of an exchange.
struct ReceivedPackets {
  std::vector<ReceivedPacket> by_asker;     ///< the answers
  std::vector<ReceivedPacket> by_answerer;  ///< the packets
};

/// The propagation and the cards' common parameters.
struct CsiMedium {
  PathsBetween paths;  ///< called with (asker's antenna, answerer's antenna)
  CsiBand band;
  CsiCardParams cards;
};

/// The outcome of each packet depends on `rng` and its counter only.
ReceivedPackets exchange_packets(const CsiRadio& asker, const CsiRadio& answerer,
                                 const std::vector<SentPacket>& asked, const CsiMedium& air, const Rng& rng);

/// A host's record of the packets that its card received, in temporal order, stamped in whole microseconds.
CsiCapture record_as_sent(std::vector<ReceivedPacket> received, const CsiMedium& air, Rng rng);

}  // namespace radioslam
