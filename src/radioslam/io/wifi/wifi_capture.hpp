// Reads WiFi captures in monitor mode (tcpdump, airodump-ng, Wireshark; pcap or pcapng, via libpcap) with
// radiotap headers. Each beacon and probe response gives a row with the BSSID of its access point, its level
// and the frequency the card was tuned to, equal to the output of
//
//   tshark -r FILE -Y 'wlan.fc.type_subtype == 8 || wlan.fc.type_subtype == 5' -T fields -E occurrence=f
//     -e frame.time_epoch -e wlan.bssid -e radiotap.channel.freq -e radiotap.dbm_antsignal
//
// If there are several levels (one per antenna), the first one is used, which is the packet's. Times are
// those of the capturing machine, which all packets have, not those of the card (TSFT). Left out and counted
// are packets without a level, truncated or malformed headers, and frames with a wrong checksum. A truncated
// packet at the end of the file is left out with a warning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "radioslam/base/fields.hpp"
#include "radioslam/io/wifi/wifi_log.hpp"

namespace radioslam {

// Reads radiotap headers, which WiFi drivers put before captured packets (radiotap.org); little endian:
//
//   u8 version 0, u8 -, u16 length, u32 present [, u32 present ...], the fields that are present
//
// Bit k of `present` means that field k is present; fields are aligned to their size from the start of the
// header. Bit 31: another word follows. Bit 29: that word counts from field 0 again (values per antenna after
// those of the packet). Bit 30: that word belongs to a vendor, whose fields state their length. Reading stops
// at a field of unknown size. (libtins 4.0 reads only the first word reliably: it does not know fields from
// 22 on and misplaces the fields after a vendor's.)

/// The fields that are read; for repeated fields the first value.
struct Radiotap {
  std::size_t length = 0;  ///< offset of the 802.11 frame
  std::optional<int> signal_dbm;
  std::optional<int> frequency_mhz;
  bool bad_checksum = false;  ///< the card reported a wrong frame checksum
};

/// Nothing if the header is incomplete or its fields exceed its length.
std::optional<Radiotap> read_radiotap(std::string_view packet);

struct WifiCaptureParams {
  bool every_frame = false;
  double scan_s = 0;
  double clock_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(every_frame, "", 0, 1,
                    "use every frame that names its transmitter, including stations, not only beacons and "
                    "probe responses");
    RADIOSLAM_FIELD(
        scan_s, "s", 0, 3600,
        "duration of a scan, over which each radio's level is averaged; 0 makes every frame a scan");
    RADIOSLAM_FIELD(clock_offset_s, "s", -4e9, 4e9,
                    "offset added to every time, from the log's clock to the mission's");
  }
};

/// Refuses (InputError, with the byte) other files, packets without radiotap headers, and impossible lengths.
WifiLog read_wifi_capture(const std::filesystem::path& path, const WifiCaptureParams& params);
/// The same for bytes in memory; `name` is used in messages.
WifiLog read_wifi_capture(const std::string& name, std::string_view bytes, const WifiCaptureParams& params);

}  // namespace radioslam
