// Reads captures (tcpdump -w, port 5500) of Broadcom chips with the Nexmon CSI firmware (nexmon_csi.cpp
// describes their records). The records of one frame, from several cores and streams, form one packet: its
// antennas are the cores, its counter is the frame's sequence number (control frames have none). The chips do
// not report their clock, so clock_us is the host's. rssi[0] is that of the frame, in dBm.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads a whole pcap file. Refuses (InputError, with the byte offset) an empty file, other formats, link
/// types other than Ethernet, impossible packet lengths, and a capture without usable records. Left out with
/// a warning are a truncated last packet, packets without CSI, inconsistent records, and packets whose
/// channel, cores and streams differ from those with the most values.
CsiCapture read_nexmon_csi(const std::string& name, std::string_view bytes);

}  // namespace radioslam
