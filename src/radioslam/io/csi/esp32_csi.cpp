#include "radioslam/io/csi/esp32_csi.hpp"

#include <cstddef>
#include <vector>

#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/csi_band.hpp"
#include "radioslam/io/csi/esp32_line.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

// Maps the CSI values of an ESP32 packet to subcarriers (ESP-IDF, "Wi-Fi Channel State Information"). The
// legacy training field comes first, then, for 802.11n, the high throughput field of one stream, or of two
// streams with space-time block code. The subcarriers of a 20 MHz field are ordered 0..31, -32..-1 from the
// carrier, or, if there is a secondary channel below or above, cover the half 0..63 or -64..-1 of both
// channels together. Those of a 40 MHz field are ordered 0..63, -64..-1, or 0..60, -60..-1 with block code.

/// The used subcarriers of one training field.
struct TrainingField {
  CapturedBand band;                ///< the carrier is the centre of the field's 20 or 40 MHz
  std::vector<std::size_t> places;  ///< index of each subcarrier's value among the packet's complex values
};

constexpr std::size_t kLegacyValues = 64;
constexpr double kNarrow_hz = 20e6, kWide_hz = 40e6;
constexpr int kNarrowCentre = 32;  ///< centre of either half of 40 MHz

double primary_carrier_hz(const TextLines& at, int channel) {
  if (const auto carrier_hz = carrier_of_channel_hz(channel)) return *carrier_hz;
  at.fail("channel " + std::to_string(channel) + " is not a channel of 2.4 or 5 GHz");
}

/// Number of complex values in the high throughput field of one stream.
int high_throughput_values(const Esp32Packet& packet) {
  if (packet.is_wide) return packet.is_stbc ? 121 : 128;
  if (!packet.is_stbc || packet.secondary == SecondaryChannel::kNone) return 64;
  return packet.secondary == SecondaryChannel::kBelow ? 63 : 62;
}

/// A field ordered from the carrier up, continued from the lowest subcarrier.
int wrapped_place(int subcarrier, int values) { return subcarrier < 0 ? subcarrier + values : subcarrier; }

/// A field of 20 MHz, alone or as the upper or lower half of 40 MHz; the lower half ends with subcarrier -1.
int narrow_place(const Esp32Packet& packet, int subcarrier, int values) {
  switch (packet.secondary) {
    case SecondaryChannel::kBelow:
      return subcarrier + kNarrowCentre;
    case SecondaryChannel::kAbove:
      return subcarrier - kNarrowCentre + values;
    default:
      return wrapped_place(subcarrier, values);
  }
}

template <class PlaceOf>
TrainingField field_of(const CapturedBand& band, std::size_t begin, const Esp32Packet& packet,
                       PlaceOf&& place_of) {
  constexpr std::size_t kInvalidValues = 2;
  TrainingField field{{band.carrier_hz, band.bandwidth_hz, {}}, {}};
  for (const int subcarrier : band.subcarriers) {
    const std::size_t place = begin + static_cast<std::size_t>(place_of(subcarrier));
    if (packet.is_first_word_invalid && place < kInvalidValues) continue;
    field.band.subcarriers.push_back(subcarrier);
    field.places.push_back(place);
  }
  return field;
}

TrainingField legacy_field(const Esp32Packet& packet, double primary_hz) {
  return field_of({primary_hz, kNarrow_hz, subcarriers_on_both_sides(1, 26)}, 0, packet,
                  [&](int k) { return narrow_place(packet, k, int{kLegacyValues}); });
}

TrainingField high_throughput_field(const Esp32Packet& packet, double primary_hz) {
  const int values = high_throughput_values(packet);
  if (!packet.is_wide)
    return field_of({primary_hz, kNarrow_hz, subcarriers_on_both_sides(1, 28)}, kLegacyValues, packet,
                    [&](int k) { return narrow_place(packet, k, values); });
  const double shift_hz = packet.secondary == SecondaryChannel::kAbove ? kNarrow_hz / 2 : -kNarrow_hz / 2;
  return field_of({primary_hz + shift_hz, kWide_hz, subcarriers_on_both_sides(2, 58)}, kLegacyValues, packet,
                  [&](int k) { return wrapped_place(k, values); });
}

/// The legacy field and, if present, the (first) high throughput field. The first two values are left out if
/// the chip marks them as invalid or does not state their validity. Refuses (InputError with the line)
/// numbers of values that do not match these fields, and unknown channels. Chips configured to omit the
/// legacy field are not recognised.
std::vector<TrainingField> training_fields(const TextLines& at, const Esp32Packet& packet) {
  const double primary_hz = primary_carrier_hz(at, packet.channel);
  if (packet.is_high_throughput && packet.is_wide && packet.secondary == SecondaryChannel::kNone)
    at.fail("a 40 MHz packet on a channel without a secondary channel");
  std::vector<TrainingField> fields{legacy_field(packet, primary_hz)};
  const std::size_t values = packet.values.size() / 2;
  if (packet.values.size() == 2 * kLegacyValues) return fields;
  const auto more = static_cast<std::size_t>(high_throughput_values(packet));
  const bool fits = values == kLegacyValues + more || (packet.is_stbc && values == kLegacyValues + 2 * more);
  if (!packet.is_high_throughput || !fits || packet.values.size() % 2 != 0)
    at.fail(std::to_string(packet.values.size()) + " values do not match any packet of this kind");
  fields.push_back(high_throughput_field(packet, primary_hz));
  return fields;
}

/// A packet and its training fields.
struct Esp32Measurement {
  Esp32Packet packet;
  std::vector<TrainingField> fields;
};

CsiPacket packet_of(const Esp32Packet& said, const std::vector<std::size_t>& places) {
  CsiPacket packet;
  packet.clock_us = said.clock_us;
  packet.stamp = said.host_stamp.value_or(Stamp{std::int64_t{said.clock_us} * kNanosecondsPerMicrosecond});
  packet.sender = said.sender;
  packet.counter = said.counter;
  packet.rssi[0] = said.rssi_dbm;
  packet.noise_dbm = said.noise_dbm;
  packet.antennas = packet.streams = 1;
  packet.channel.resize(1, static_cast<Eigen::Index>(places.size()));
  for (std::size_t k = 0; k < places.size(); ++k)
    packet.channel(0, static_cast<Eigen::Index>(k)) = {static_cast<float>(said.values[2 * places[k] + 1]),
                                                       static_cast<float>(said.values[2 * places[k]])};
  return packet;
}

class Esp32Reader {
 public:
  Esp32Reader(const std::string& name, std::string_view bytes) : text_{name, std::string(bytes)} {}

  CsiCapture read() {
    if (text_.content.empty()) text_.fail(0, "the file is empty");
    for (TextLines lines(text_); lines.next();) read_line(lines);
    if (measurements_.empty()) {
      torn_.throw_first();
      text_.fail(0, "contains no line with CSI_DATA");
    }
    CsiCapture capture = capture_of_most_measured();
    add_warnings(capture);
    return capture;
  }

 private:
  void read_line(const TextLines& at) {
    if (columns_.take_header(at.line()) || trim(at.line()).empty()) return;
    if (esp32_data_begin(at.line()) == std::string_view::npos) {
      ++others_;
      return;
    }
    try {
      Esp32Packet packet = read_esp32_line(at, columns_);
      std::vector<TrainingField> fields = training_fields(at, packet);
      measurements_.push_back({std::move(packet), std::move(fields)});
    } catch (const InputError& error) {
      torn_.add(error);
    }
  }

  CsiCapture capture_of_most_measured() const {
    MeasuredShapes<CapturedBand> bands;
    for (const Esp32Measurement& measurement : measurements_)
      for (const TrainingField& field : measurement.fields) bands.add(field.band, field.places.size());
    const CapturedBand& kept = bands.most_frequent();
    CsiCapture capture = capture_of(kept);
    for (const Esp32Measurement& measurement : measurements_)
      for (const TrainingField& field : measurement.fields)
        if (field.band == kept) {
          capture.packets.push_back(packet_of(measurement.packet, field.places));
          break;
        }
    return capture;
  }

  void add_warnings(CsiCapture& capture) const {
    const auto warn = [&](std::size_t count, const std::string& what) {
      if (count > 0) capture.warnings.push_back(text_.name + ": " + std::to_string(count) + what);
    };
    warn(others_, " lines without CSI are skipped");
    if (torn_.count() > 0) capture.warnings.push_back(torn_.warning(text_.name, "line"));
    warn(measurements_.size() - capture.packets.size(),
         " packets on another channel or without the most frequent training field are left out");
  }

  Text text_;
  Esp32Columns columns_;
  std::vector<Esp32Measurement> measurements_;
  std::size_t others_ = 0;
  SkippedRecords torn_;
};

}  // namespace

bool is_esp32_csi(std::string_view bytes) { return esp32_data_begin(bytes) != std::string_view::npos; }

CsiCapture read_esp32_csi(const std::string& name, std::string_view bytes) {
  return Esp32Reader(name, bytes).read();
}

}  // namespace radioslam
