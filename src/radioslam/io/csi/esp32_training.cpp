#include "radioslam/io/csi/esp32_training.hpp"

#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

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

}  // namespace

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

}  // namespace radioslam
