// Captures (tcpdump -w, port 5500) of Broadcom chips with Nexmon CSI's firmware; nexmon_record.hpp tells
// their format. Records of one frame, from several cores and streams, become one packet: its antennas are the
// cores, and of the frame's sequence control it has the counter (control frames have none). The chips tell no
// clock of their own: clock_us is the host's. rssi[0] is the frame's, in dBm.
#pragma once

#include <string>
#include <string_view>

#include "radioslam/mission/csi.hpp"

namespace radioslam {

/// Reads a whole pcap file. Refuses (InputError, with the byte's offset) an empty one, other files, other
/// links than Ethernet, impossible packet lengths, and a capture without any record that can be used. Left
/// out, each with a warning: a last packet that the file's end cut off, packets that are no records, records
/// that contradict themselves, and packets of another channel or other cores and streams than most values
/// were measured with.
CsiCapture read_nexmon_csi(const std::string& name, std::string_view bytes);

}  // namespace radioslam
