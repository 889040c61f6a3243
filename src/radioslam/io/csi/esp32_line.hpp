// Parses one line with CSI of an ESP32's serial output, as printed by ESP32-CSI-Tool (Hernandez and Bulut)
// and by Espressif's esp-csi (get-started/csi_recv):
//   CSI_DATA,role,mac,rssi,rate,sig_mode,mcs,bandwidth,smoothing,not_sounding,aggregation,stbc,fec_coding,sgi,
//     noise_floor,ampdu_cnt,channel,secondary_channel,local_timestamp,ant,sig_len,rx_state,real_time_set,
//     real_timestamp,len,[i r i r ... ]
//   CSI_DATA,id,mac,...,rx_state,len,first_word,"[i,r,i,r,...]"
// A header line `type,...` names the columns; without one, the layout is recognised by the number of columns.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

enum class SecondaryChannel : std::uint8_t { kNone = 0, kAbove = 1, kBelow = 2 };  // values of ESP-IDF

/// One packet as reported by the ESP32.
struct Esp32Packet {
  MacAddress sender;
  int rssi_dbm = 0, noise_dbm = 0;
  bool is_high_throughput = false;  ///< 802.11n
  bool is_wide = false;             ///< 40 MHz
  bool is_stbc = false;             ///< two streams with space-time block code
  int channel = 0;
  SecondaryChannel secondary = SecondaryChannel::kNone;
  std::uint32_t clock_us = 0;
  std::optional<Stamp> host_stamp;  ///< if the host has set the chip's clock
  std::optional<std::uint32_t> counter;
  bool is_first_word_invalid = true;
  std::size_t values_stated = 0;    ///< number stated by the chip; a build may print only the first 128
  std::vector<std::int8_t> values;  ///< imaginary, real, imaginary, ...
};

/// The names of the columns before the values, updated by header lines.
class Esp32Columns {
 public:
  /// Reads the names of a header line; false for any other line.
  bool take_header(std::string_view line);
  /// The names for a line with this number of fields before its values. Refuses numbers that match neither
  /// the header nor a known layout.
  const std::vector<std::string>& names(const TextLines& at, std::size_t fields) const;

 private:
  std::vector<std::string> header_;
};

/// Offset of the CSI data in a line, which may follow output of another task of the chip; npos without CSI
/// data.
std::size_t esp32_data_begin(std::string_view line);

/// Reads the line's data. Refuses (InputError with the line) a truncated or inconsistent line, and the
/// columns of the ESP32-C5 and -C6, which do not define the order of the subcarriers.
Esp32Packet read_esp32_line(const TextLines& at, const Esp32Columns& columns);

}  // namespace radioslam
