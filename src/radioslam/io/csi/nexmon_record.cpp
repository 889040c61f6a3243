#include "radioslam/io/csi/nexmon_record.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr std::uint16_t kNexmonMagic = 0x1111;
constexpr std::size_t kNexmonHeader = 18, kBytesPerValue = 4;

/// Widths of mantissa (with sign) and exponent; without a mantissa, the values are integers.
struct FloatBits {
  unsigned mantissa = 0, exponent = 0;
};
constexpr FloatBits kWholeNumbers{}, kShortFloats{9, 5}, kLongFloats{12, 6};

struct ChipFormat {
  std::uint16_t chip;
  FloatBits bits;
};
/// By Nexmon's chip numbers; 0xdead was used by the first firmware for the 4358.
constexpr std::array<ChipFormat, 5> kChips{{
    {1, kWholeNumbers},    // 4339
    {101, kWholeNumbers},  // 43455c0
    {3, kShortFloats},     // 4358
    {0xdead, kShortFloats},
    {106, kLongFloats},  // 4366c0
}};

const ChipFormat* format_of(std::uint16_t chip) {
  const auto* found =
      std::find_if(kChips.begin(), kChips.end(), [&](const ChipFormat& f) { return f.chip == chip; });
  return found == kChips.end() ? nullptr : found;
}

/// A channel width by its code in the chanspec, with the subcarriers in use.
struct Width {
  unsigned code;
  double bandwidth_hz;
  int subcarriers;  ///< total number
  int nearest, furthest;
};
constexpr std::array<Width, 3> kWidths{{{2, 20e6, 64, 1, 26}, {3, 40e6, 128, 2, 58}, {4, 80e6, 256, 2, 122}}};

const Width* width_of(std::uint16_t chanspec) {
  const unsigned code = chanspec >> 11U & 7U;
  const auto* found =
      std::find_if(kWidths.begin(), kWidths.end(), [&](const Width& w) { return w.code == code; });
  return found == kWidths.end() ? nullptr : found;
}

std::optional<double> carrier_of(std::uint16_t chanspec) {
  constexpr unsigned kAt2 = 0, kAt5 = 3;
  constexpr double kBetweenBands_hz = 4e9;
  const unsigned band = chanspec >> 14U;
  const auto carrier_hz = carrier_of_channel_hz(chanspec & 0xff);
  if (!carrier_hz || band != (*carrier_hz < kBetweenBands_hz ? kAt2 : kAt5)) return std::nullopt;
  return carrier_hz;
}

std::string hexadecimal(unsigned value) {
  std::string text;
  for (const unsigned shift : {12U, 8U, 4U, 0U}) text += "0123456789abcdef"[value >> shift & 0xfU];
  return "0x" + text;
}

/// The number whose sign and magnitude end at bit `low`.
float signed_magnitude(std::uint32_t word, unsigned low, unsigned bits, int exponent) {
  const std::uint32_t magnitude = word >> low & ((1U << (bits - 1)) - 1);
  const float value = std::ldexp(static_cast<float>(magnitude), exponent);
  return (word >> (low + bits - 1) & 1U) != 0 ? -value : value;
}

std::complex<float> unpack(std::uint32_t word, FloatBits bits) {
  const auto span = static_cast<int>(1U << bits.exponent);
  int exponent = static_cast<int>(word) & (span - 1);
  if (exponent >= span / 2) exponent -= span;
  return {signed_magnitude(word, bits.exponent + bits.mantissa, bits.mantissa, exponent),
          signed_magnitude(word, bits.exponent, bits.mantissa, exponent)};
}

[[noreturn]] void fail_at(const std::string& name, std::size_t at, const std::string& reason) {
  throw InputError(name, 0, "at byte " + std::to_string(at) + ": " + reason);
}

void check_known(const std::string& name, std::size_t at, const NexmonRecord& record) {
  if (format_of(record.chip) == nullptr)
    fail_at(name, at,
            "chip " + std::to_string(record.chip) +
                " is unknown; 1 (4339), 3 (4358), 101 (43455c0) and 106 (4366c0) are supported");
  const Width* width = width_of(record.chanspec);
  if (width == nullptr || !carrier_of(record.chanspec))
    fail_at(
        name, at,
        "chanspec " + hexadecimal(record.chanspec) + " is not supported; channels of 20, 40 and 80 MHz are");
  const std::size_t expected = kBytesPerValue * static_cast<std::size_t>(width->subcarriers);
  if (record.values.size() != expected)
    fail_at(name, at,
            std::to_string(record.values.size()) + " bytes of CSI, but " + std::to_string(expected) +
                " are expected for chanspec " + hexadecimal(record.chanspec));
}

}  // namespace

std::complex<float> NexmonRecord::value(int subcarrier) const {
  const ByteView view(values, ByteOrder::kLittle);
  const auto count = static_cast<int>(values.size() / kBytesPerValue);
  const std::size_t at = kBytesPerValue * static_cast<std::size_t>((subcarrier + count) % count);
  const FloatBits bits = format_of(chip)->bits;
  if (bits.mantissa != 0) return unpack(view.u32(at), bits);
  return {static_cast<float>(view.i16(at)), static_cast<float>(view.i16(at + 2))};
}

bool is_nexmon_record(std::string_view payload) {
  return payload.size() >= 2 && ByteView(payload, ByteOrder::kLittle).u16(0) == kNexmonMagic;
}

NexmonRecord read_nexmon_record(const std::string& name, std::size_t at, std::string_view payload) {
  if (payload.size() < kNexmonHeader)
    fail_at(name, at, "a record of only " + std::to_string(payload.size()) + " bytes");
  const ByteView view(payload, ByteOrder::kLittle);
  NexmonRecord record;
  if (view.u16(2) != kNexmonMagic) {
    record.rssi_dbm = view.i8(2);
    record.frame_control = view.u8(3);
  }
  record.sender = view.mac_address(4);
  record.sequence_control = view.u16(10);
  const unsigned core_and_stream = view.u8(12) | view.u8(13);  // some firmware versions swap the two
  record.core = core_and_stream & 7U;
  record.stream = core_and_stream >> 3U & 7U;
  record.chanspec = view.u16(14);
  record.chip = view.u16(16);
  record.values = payload.substr(kNexmonHeader);
  check_known(name, at, record);
  return record;
}

CapturedBand nexmon_band(const NexmonRecord& record) {
  constexpr int kWrittenOver = 2;
  const Width& width = *width_of(record.chanspec);
  CapturedBand band{*carrier_of(record.chanspec), width.bandwidth_hz,
                    subcarriers_on_both_sides(width.nearest, width.furthest)};
  // At 20 MHz the firmware overwrites subcarriers beyond those used here.
  if (record.rssi_dbm && width.nearest == kWrittenOver) std::erase(band.subcarriers, kWrittenOver);
  return band;
}

}  // namespace radioslam
