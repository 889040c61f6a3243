// Properties of every capture that a reader accepts.
#pragma once

#include "radioslam/base/check.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

inline void check_capture(const CsiCapture& capture) {
  RADIOSLAM_CHECK(!capture.packets.empty(), "an empty capture is refused");
  for (const CsiPacket& packet : capture.packets) {
    RADIOSLAM_CHECK(packet.channel.rows() == packet.antennas * packet.streams,
                    "a row per antenna and stream");
    RADIOSLAM_CHECK(packet.channel.cols() == static_cast<Eigen::Index>(capture.subcarrier_hz.size()),
                    "a column per subcarrier");
    RADIOSLAM_CHECK(packet.channel.allFinite(), "every value is a number");
  }
}

}  // namespace radioslam
