// One line of an ESP32's serial output that tells channel state information, as ESP32-CSI-Tool (Hernandez and
// Bulut) and Espressif's esp-csi (get-started/csi_recv) print it:
//   CSI_DATA,role,mac,rssi,rate,sig_mode,mcs,bandwidth,smoothing,not_sounding,aggregation,stbc,fec_coding,sgi,
//     noise_floor,ampdu_cnt,channel,secondary_channel,local_timestamp,ant,sig_len,rx_state,real_time_set,
//     real_timestamp,len,[i r i r ... ]
//   CSI_DATA,id,mac,...,rx_state,len,first_word,"[i,r,i,r,...]"
// A header line, `type,...`, names the columns; without one they are told apart by their number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

enum class SecondaryChannel : std::uint8_t { kNone = 0, kAbove = 1, kBelow = 2 };  // as ESP-IDF has them

/// One packet as the ESP32 tells it.
struct Esp32Packet {
  MacAddress sender;
  int rssi_dbm = 0, noise_dbm = 0;
  bool is_high_throughput = false;  ///< 802.11n
  bool is_wide = false;             ///< 40 MHz
  bool is_stbc = false;             ///< two streams by space time block code
  int channel = 0;
  SecondaryChannel secondary = SecondaryChannel::kNone;
  std::uint32_t clock_us = 0;
  std::optional<Stamp> host_stamp;  ///< where a host has set its clock
  std::optional<std::uint32_t> counter;
  bool is_first_word_invalid = true;
  std::size_t values_told = 0;      ///< that the card measured; a build may print only the first 128
  std::vector<std::int8_t> values;  ///< imaginary, real, imaginary, ...
};

/// The names of the columns before the values, from header lines as they come.
class Esp32Columns {
 public:
  /// Takes the names of a header line; false for a line that is none.
  bool take_header(std::string_view line);
  /// The names for a line of so many fields before its values. Refuses numbers of fields that neither the
  /// header nor a known layout has.
  const std::vector<std::string>& names(const TextLines& at, std::size_t fields) const;

 private:
  std::vector<std::string> header_;
};

/// Where a line's data begin, behind what another task of the chip printed in front of them; npos if it has
/// none.
std::size_t esp32_data_begin(std::string_view line);

/// Reads the line's data. Refuses (InputError with the line) one that is torn or contradicts itself, and
/// columns of the ESP32-C5 and -C6, which do not tell in which order the subcarriers come.
Esp32Packet read_esp32_line(const TextLines& at, const Esp32Columns& columns);

}  // namespace radioslam
