// Captures of a WiFi card in monitor mode (tcpdump, airodump-ng, Wireshark; pcap or pcapng, by libpcap),
// whose packets have radiotap headers: a row per beacon and probe response with its access point's BSSID, the
// level and the frequency the card was tuned to, as tshark shows them:
//
//   tshark -r FILE -Y 'wlan.fc.type_subtype == 8 || wlan.fc.type_subtype == 5' -T fields -E occurrence=f
//     -e frame.time_epoch -e wlan.bssid -e radiotap.channel.freq -e radiotap.dbm_antsignal
//
// Of several antennas the first value counts, which is the packet's. Times are the capturing machine's, which
// all packets have, not those of the card (TSFT). Left out and counted: packets whose level no driver told,
// headers that are cut off or malformed, and frames with a checksum the card found wrong. What a capture's
// end cuts off is left out with a warning.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "radioslam/base/fields.hpp"
#include "radioslam/io/wifi_log.hpp"

namespace radioslam {

struct WifiCaptureParams {
  bool every_frame = false;
  double scan_s = 0;
  double clock_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"every_frame", "", 0, 1, "every frame that names its transmitter counts, stations too"},
          self.every_frame);
    visit(
        Field{"scan_s", "s", 0, 3600, "so long is one scan: a radio's mean level over it; 0: every frame is"},
        self.scan_s);
    visit(
        Field{"clock_offset_s", "s", -4e9, 4e9, "added to every time: from the log's clock to the mission's"},
        self.clock_offset_s);
  }
};

/// Refuses (InputError, with the byte) what is no capture, packets without radiotap headers, and impossible
/// lengths.
WifiLog read_wifi_capture(const std::filesystem::path& path, const WifiCaptureParams& params);
/// The same of bytes in memory.
WifiLog read_wifi_capture(const std::string& name, std::string_view bytes, const WifiCaptureParams& params);

}  // namespace radioslam
