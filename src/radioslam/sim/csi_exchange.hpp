// Packets and answers between two WiFi cards, as both write them down.
//
// The asker sends a packet at t; the answerer measures it and answers at t + g, where g jitters; the asker
// measures the answer, which carries the packet's counter. With D the phase of the answerer's oscillator less
// the asker's, the two measure
//   at t:      h exp(-j D(t))            at t + g:  h exp(+j D(t + g)),
// each with the slope of its own detection delay, so that the product keeps h^2 exp(j 2 pi f g), f = D' / 2
// pi the answerer's carrier less the asker's. Frames are sent and answered by antenna 0; all antennas listen.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/csi.hpp"
#include "radioslam/sim/csi_card.hpp"
#include "radioslam/sim/csi_channel.hpp"

namespace radioslam {

/// T_common_body at a time in seconds.
using BodyAtTime = std::function<SE3(double t_s)>;

/// A card on a robot.
struct CsiRadio {
  MacAddress address;
  std::vector<Eigen::Vector3d> antennas_m;  ///< in the body frame, one to three
  BodyAtTime T_common_body;
  CsiCard card;
};

/// A packet that is sent.
struct AskedPacket {
  double t_s = 0;
  std::uint32_t counter = 0;
};

/// A packet that was heard, not yet stamped by the host.
struct HeardPacket {
  double t_s = 0;  ///< true time
  CsiPacket packet;
};

/// What the two ends of an exchange wrote down.
struct HeardPackets {
  std::vector<HeardPacket> by_asker;     ///< the answers
  std::vector<HeardPacket> by_answerer;  ///< what was asked
};

/// Everything around the two radios.
struct CsiAir {
  PathsBetween paths;  ///< asked for (asker's antenna, answerer's antenna)
  CsiBand band;
  CsiCardParams cards;
};

/// What comes of each packet depends on `rng` and its counter only.
HeardPackets exchange_packets(const CsiRadio& asker, const CsiRadio& answerer,
                              const std::vector<AskedPacket>& asked, const CsiAir& air, const Rng& rng);

/// A host's record of what its card heard: in the order of time, stamped in whole microseconds.
CsiCapture write_down(std::vector<HeardPacket> heard, const CsiAir& air, Rng rng);

}  // namespace radioslam
