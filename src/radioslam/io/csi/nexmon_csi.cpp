#include "radioslam/io/csi/nexmon_csi.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstdint>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/csi_band.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/wifi/pcap.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

// Parses the UDP packets that Broadcom WiFi chips with the Nexmon CSI firmware (Schulz, Wegemer, Hollick:
// nexmon.org/csi) send for every frame, receiving core and spatial stream; little endian:
//   u16 0x1111, [i8 RSSI in dBm, u8 frame control | u16 0x1111, in the older firmware,] 6 bytes MAC, u16
//   sequence control, u16 core (three bits) and stream (three bits), u16 chanspec, u16 chip, and per
//   subcarrier, from the carrier up and on from the lowest, four bytes:
//     4339 and 43455c0: i16 real, i16 imaginary;
//     4358 and 4366c0: from the highest bit used on down sign, real, sign, imaginary, exponent (two's
//     complement) of 1, 8, 1, 8, 5 and of 1, 11, 1, 11, 6 bits.
// The newer firmware overwrites the values of a few subcarriers with information on the frame.

/// The CSI of one stream at one core.
struct NexmonRecord {
  MacAddress sender;
  std::uint16_t sequence_control = 0;  ///< of the frame: number * 16 + fragment; 0 if it has none
  std::uint8_t core = 0, stream = 0;
  std::uint16_t chanspec = 0;
  std::uint16_t chip = 0;
  std::optional<int> rssi_dbm;                ///< absent in the older firmware
  std::optional<std::uint8_t> frame_control;  ///< first of its two bytes; absent in the older firmware
  std::string_view values;

  std::complex<float> value(int subcarrier) const;
};

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

std::complex<float> NexmonRecord::value(int subcarrier) const {
  const ByteView view(values, ByteOrder::kLittle);
  const auto count = static_cast<int>(values.size() / kBytesPerValue);
  const std::size_t at = kBytesPerValue * static_cast<std::size_t>((subcarrier + count) % count);
  const FloatBits bits = format_of(chip)->bits;
  if (bits.mantissa != 0) return unpack(view.u32(at), bits);
  return {static_cast<float>(view.i16(at)), static_cast<float>(view.i16(at + 2))};
}

/// Whether a UDP payload begins like such a packet.
bool is_nexmon_record(std::string_view payload) {
  return payload.size() >= 2 && ByteView(payload, ByteOrder::kLittle).u16(0) == kNexmonMagic;
}

/// Refuses (InputError with byte `at` of the file) a truncated payload, unknown chips, chanspecs other than
/// 20, 40 and 80 MHz at 2.4 or 5 GHz, and a number of values that does not match the chanspec.
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

/// The subcarriers that are used by packets of every kind: at 20 MHz those of 802.11a (-26 to 26), at 40 and
/// 80 MHz those of 802.11n and ac; for the newer firmware without +2, which it overwrites.
CapturedBand nexmon_band(const NexmonRecord& record) {
  constexpr int kWrittenOver = 2;
  const Width& width = *width_of(record.chanspec);
  CapturedBand band{*carrier_of(record.chanspec), width.bandwidth_hz,
                    subcarriers_on_both_sides(width.nearest, width.furthest)};
  // At 20 MHz the firmware overwrites subcarriers beyond those used here.
  if (record.rssi_dbm && width.nearest == kWrittenOver) std::erase(band.subcarriers, kWrittenOver);
  return band;
}

constexpr std::uint16_t kNexmonPort = 5500;
/// The records of one frame are about 0.1 ms apart; later ones belong to another frame.
constexpr double kMaxFrame_s = 5e-3;
constexpr unsigned kControlFrame = 1;

using CoreAndStream = std::pair<int, int>;
CoreAndStream place_of(const NexmonRecord& record) { return {record.core, record.stream}; }

/// The records of one frame.
struct NexmonFrame {
  Stamp stamp;
  std::vector<NexmonRecord> records;

  bool takes(const NexmonRecord& next, Stamp at) const {
    const NexmonRecord& first = records.front();
    return next.sender == first.sender && next.sequence_control == first.sequence_control &&
           next.chanspec == first.chanspec && next.chip == first.chip &&
           next.frame_control == first.frame_control &&
           next.rssi_dbm.has_value() == first.rssi_dbm.has_value() && at >= stamp &&
           seconds_between(stamp, at) < kMaxFrame_s &&
           std::none_of(records.begin(), records.end(),
                        [&](const NexmonRecord& record) { return place_of(record) == place_of(next); });
  }
};

/// The band, cores and streams of a packet.
struct NexmonShape {
  CapturedBand band;
  std::uint16_t chip = 0;
  std::set<int> cores, streams;
  friend auto operator<=>(const NexmonShape&, const NexmonShape&) = default;
};

/// The packet of a frame; nothing unless every core has a record of every stream.
std::optional<NexmonShape> shape_of(const NexmonFrame& frame) {
  NexmonShape shape{nexmon_band(frame.records.front()), frame.records.front().chip, {}, {}};
  for (const NexmonRecord& record : frame.records) {
    shape.cores.insert(record.core);
    shape.streams.insert(record.stream);
  }
  if (shape.cores.size() * shape.streams.size() != frame.records.size()) return std::nullopt;
  return shape;
}

std::optional<std::uint32_t> counter_of(const NexmonRecord& record) {
  if (record.frame_control && (*record.frame_control >> 2U & 3U) == kControlFrame) return std::nullopt;
  return record.sequence_control;
}

CsiPacket nexmon_packet(const NexmonFrame& frame, const NexmonShape& shape) {
  constexpr int kNoiseNotMeasured = -127;
  const NexmonRecord& first = frame.records.front();
  CsiPacket packet;
  packet.stamp = frame.stamp;
  packet.clock_us = static_cast<std::uint32_t>(frame.stamp.ns / kNanosecondsPerMicrosecond);
  packet.sender = first.sender;
  packet.counter = counter_of(first);
  packet.rssi[0] = first.rssi_dbm.value_or(0);
  packet.noise_dbm = kNoiseNotMeasured;
  packet.antennas = static_cast<int>(shape.cores.size());
  packet.streams = static_cast<int>(shape.streams.size());
  const auto columns = static_cast<Eigen::Index>(shape.band.subcarriers.size());
  packet.channel.resize(static_cast<Eigen::Index>(frame.records.size()), columns);
  for (const NexmonRecord& record : frame.records) {
    const auto antenna = std::distance(shape.cores.begin(), shape.cores.find(record.core));
    const auto stream = std::distance(shape.streams.begin(), shape.streams.find(record.stream));
    for (Eigen::Index k = 0; k < columns; ++k)
      packet.channel(stream * packet.antennas + antenna, k) =
          record.value(shape.band.subcarriers[static_cast<std::size_t>(k)]);
  }
  return packet;
}

class NexmonReader {
 public:
  NexmonReader(const std::string& name, std::string_view bytes) : name_(name), packets_(name, bytes) {}

  CsiCapture read() {
    while (const auto packet = packets_.next()) read_record(*packet);
    if (frames_.empty()) refuse();
    CsiCapture capture = capture_of_most_measured();
    add_warnings(capture);
    return capture;
  }

 private:
  void read_record(const PcapPacket& packet) {
    const auto payload = packets_.udp_payload(packet, kNexmonPort);
    if (!payload || !is_nexmon_record(*payload)) {
      ++others_;
      return;
    }
    try {
      add(read_nexmon_record(name_, packet.at, *payload), packet.stamp);
    } catch (const InputError& error) {
      unusable_.add(error);
    }
  }

  void add(const NexmonRecord& record, Stamp stamp) {
    if (frames_.empty() || !frames_.back().takes(record, stamp)) frames_.push_back({stamp, {}});
    frames_.back().records.push_back(record);
  }

  [[noreturn]] void refuse() const {
    unusable_.throw_first();
    throw InputError(name_, 0,
                     "at byte " + std::to_string(packets_.at()) +
                         (packets_.is_truncated() ? ": the first packet is truncated"
                                                  : ": the pcap file contains no packet of Nexmon CSI"));
  }

  CsiCapture capture_of_most_measured() {
    MeasuredShapes<NexmonShape> shapes;
    for (const NexmonFrame& frame : frames_)
      if (const auto shape = shape_of(frame))
        shapes.add(*shape, frame.records.size() * shape->band.subcarriers.size());
    if (shapes.empty())
      throw InputError(name_, 0, "no frame has a record of every stream from every core that received it");
    const NexmonShape& kept = shapes.most_frequent();
    CsiCapture capture = capture_of(kept.band);
    for (const NexmonFrame& frame : frames_)
      if (shape_of(frame) == kept) capture.packets.push_back(nexmon_packet(frame, kept));
    return capture;
  }

  void add_warnings(CsiCapture& capture) const {
    const auto warn = [&](const std::string& what) { capture.warnings.push_back(name_ + ": " + what); };
    if (others_ > 0) warn(std::to_string(others_) + " packets without CSI are skipped");
    if (unusable_.count() > 0) capture.warnings.push_back(unusable_.warning(name_, "record"));
    if (const std::size_t more = frames_.size() - capture.packets.size(); more > 0)
      warn(std::to_string(more) +
           " frames whose channel, cores or streams differ from most frames are left out");
    if (packets_.is_truncated())
      warn("at byte " + std::to_string(packets_.at()) + ": the last packet is truncated and left out");
  }

  const std::string& name_;
  PcapReader packets_;
  std::vector<NexmonFrame> frames_;
  std::size_t others_ = 0;
  SkippedRecords unusable_;
};

}  // namespace

CsiCapture read_nexmon_csi(const std::string& name, std::string_view bytes) {
  return NexmonReader(name, bytes).read();
}

}  // namespace radioslam
