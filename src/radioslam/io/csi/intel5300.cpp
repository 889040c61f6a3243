#include "radioslam/io/csi/intel5300.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "radioslam/base/check.hpp"
#include "radioslam/base/input_error.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

constexpr std::uint8_t kChannelCode = 187;
constexpr std::size_t kSubcarriers = 30, kSkippedBits = 3, kBitsPerValue = 16;
constexpr std::size_t kStockHeader = 20, kLongHeader = 38;
constexpr std::size_t kMaxAntennas = 3;
constexpr unsigned kWideChannelFlag = 0x800;

constexpr std::size_t bytes_of_channel(std::size_t antennas, std::size_t streams) {
  return (kSubcarriers * (antennas * streams * kBitsPerValue + kSkippedBits) + 7) / 8;
}

/// Little endian numbers, without bounds checks.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}
  std::size_t size() const { return bytes_.size(); }
  std::uint8_t u8(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }
  int i8(std::size_t at) const { return static_cast<signed char>(bytes_[at]); }
  std::uint16_t u16(std::size_t at) const { return static_cast<std::uint16_t>(u8(at) | (u8(at + 1) << 8U)); }
  std::uint32_t u32(std::size_t at) const {
    return u16(at) | (static_cast<std::uint32_t>(u16(at + 2)) << 16U);
  }
  /// The eight bits that begin at this bit.
  int i8_at_bit(std::size_t bit) const {
    const unsigned shift = bit % 8;
    const unsigned low = u8(bit / 8), high = shift == 0 ? 0U : u8(bit / 8 + 1);
    return static_cast<signed char>(((low >> shift) | (high << (8 - shift))) & 0xffU);
  }

 private:
  std::string_view bytes_;
};

/// The antenna of each of the card's receive chains; the identity if the stored order is invalid.
std::array<std::size_t, kMaxAntennas> antenna_order(unsigned code, std::size_t antennas) {
  std::array<std::size_t, kMaxAntennas> order{code & 3U, (code >> 2U) & 3U, (code >> 4U) & 3U};
  auto sorted = order;
  std::sort(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(antennas));
  for (std::size_t k = 0; k < antennas; ++k)
    if (sorted[k] != k) std::iota(order.begin(), order.end(), std::size_t{0});
  return order;
}

class Reader {
 public:
  Reader(const std::string& name, std::string_view bytes) : name_(name), bytes_(bytes) {}

  CsiCapture read() {
    if (bytes_.empty()) throw InputError(name_, 0, "the file is empty");
    while (at_ < bytes_.size()) {
      const std::size_t left = bytes_.size() - at_;
      if (left < 3) return end_torn();
      const std::size_t length =
          static_cast<std::size_t>(Bytes(bytes_).u8(at_)) << 8U | Bytes(bytes_).u8(at_ + 1);
      if (length == 0) fail("a record of zero bytes");
      if (length > left - 2) return end_torn();
      const std::uint8_t code = Bytes(bytes_).u8(at_ + 2);
      if (code == kChannelCode) read_packet(Bytes(bytes_.substr(at_ + 3, length - 1)));
      at_ += 2 + length;
    }
    if (capture_.packets.empty()) fail_at(0, "contains no record of an Intel 5300 card");
    return end();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const { fail_at(at_, reason); }
  [[noreturn]] void fail_at(std::size_t at, const std::string& reason) const {
    throw InputError(name_, 0, "at byte " + std::to_string(at) + ": " + reason);
  }

  CsiCapture end_torn() {
    if (capture_.packets.empty()) fail("not a capture of an Intel 5300 card");
    capture_.warnings.push_back(name_ + ": at byte " + std::to_string(at_) +
                                ": the last record is truncated and left out");
    return end();
  }

  CsiCapture end() {
    if (other_width_ > 0)
      capture_.warnings.push_back(name_ + ": " + std::to_string(other_width_) +
                                  " packets of another bandwidth than the first one are left out");
    return std::move(capture_);
  }

  void read_packet(const Bytes& record) {
    if (record.size() < kStockHeader) fail("a record of only " + std::to_string(record.size()) + " bytes");
    const std::size_t antennas = record.u8(8), streams = record.u8(9), channel_bytes = record.u16(16);
    if (antennas < 1 || antennas > kMaxAntennas || streams < 1 || streams > kMaxAntennas)
      fail("a record of " + std::to_string(antennas) + " antennas and " + std::to_string(streams) +
           " streams");
    if (channel_bytes != bytes_of_channel(antennas, streams))
      fail(std::to_string(channel_bytes) + " bytes for the channels of " + std::to_string(antennas) +
           " antennas and " + std::to_string(streams) + " streams, but these need " +
           std::to_string(bytes_of_channel(antennas, streams)));
    const std::size_t header = record.size() - std::min(record.size(), channel_bytes);
    if (header != kStockHeader && header != kLongHeader)
      fail("a header of " + std::to_string(header) + " bytes, but 20 or 38 are expected");
    if (!is_of_first_width((record.u16(18) & kWideChannelFlag) != 0)) {
      ++other_width_;
      return;
    }
    CsiPacket packet;
    packet.clock_us = record.u32(0);
    packet.stamp = {std::int64_t{packet.clock_us} * kNanosecondsPerMicrosecond};
    packet.antennas = static_cast<int>(antennas);
    packet.streams = static_cast<int>(streams);
    packet.rssi = {record.u8(10), record.u8(11), record.u8(12)};
    packet.noise_dbm = record.i8(13);
    packet.gain_control_db = record.u8(14);
    if (header == kLongHeader) {
      packet.stamp = {std::int64_t{record.u32(20)} * kNanosecondsPerSecond +
                      std::int64_t{record.u32(24)} * kNanosecondsPerMicrosecond};
      packet.sender.emplace();
      for (std::size_t k = 28; k < 34; ++k) packet.sender->value = packet.sender->value << 8U | record.u8(k);
      packet.counter = record.u32(34);
    }
    packet.channel = read_channel(record, header, antennas, streams, antenna_order(record.u8(15), antennas));
    capture_.packets.push_back(std::move(packet));
  }

  bool is_of_first_width(bool wide) {
    if (capture_.packets.empty()) {
      wide_ = wide;
      capture_.subcarrier_hz = grouped_subcarriers_hz(wide ? ChannelWidth::k40MHz : ChannelWidth::k20MHz);
      capture_.bandwidth_hz = wide ? 40e6 : 20e6;
    }
    return wide == wide_;
  }

  static Eigen::MatrixXcf read_channel(const Bytes& record, std::size_t header, std::size_t antennas,
                                       std::size_t streams,
                                       const std::array<std::size_t, kMaxAntennas>& order) {
    Eigen::MatrixXcf channel(static_cast<Eigen::Index>(antennas * streams), Eigen::Index{kSubcarriers});
    std::size_t bit = 8 * header;
    for (Eigen::Index k = 0; k < channel.cols(); ++k) {
      bit += kSkippedBits;
      for (std::size_t chain = 0; chain < antennas; ++chain)
        for (std::size_t stream = 0; stream < streams; ++stream, bit += kBitsPerValue)
          channel(static_cast<Eigen::Index>(stream * antennas + order[chain]), k) = {
              static_cast<float>(record.i8_at_bit(bit)), static_cast<float>(record.i8_at_bit(bit + 8))};
    }
    return channel;
  }

  const std::string& name_;
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool wide_ = false;
  std::size_t other_width_ = 0;
  CsiCapture capture_;
};

constexpr unsigned kAntennasInOrder = 0b100100;  ///< two bits per chain: chain k uses antenna k
constexpr unsigned kRateAndFlags = 0x101;        ///< as in recorded files: legacy rate, antenna A
constexpr double kWideBandwidth_hz = 40e6;
constexpr std::size_t kBitsPerByte = 8;

void append_byte(std::string& out, int value, int least, int most) {
  out.push_back(static_cast<char>(std::clamp(value, least, most)));
}

/// Writes bits in the card's order, lowest bit of a byte first, into zeroed bytes.
class BitWriter {
 public:
  explicit BitWriter(std::size_t bytes) : bytes_(bytes, '\0') {}
  void skip(std::size_t bits) { at_ += bits; }
  void add(std::uint8_t value) {
    const unsigned shift = at_ % kBitsPerByte;
    or_into(at_ / kBitsPerByte, static_cast<unsigned>(value) << shift);
    if (shift > 0) or_into(at_ / kBitsPerByte + 1, static_cast<unsigned>(value) >> (kBitsPerByte - shift));
    at_ += kBitsPerByte;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void or_into(std::size_t byte, unsigned bits) {
    bytes_[byte] = static_cast<char>(static_cast<unsigned char>(bytes_[byte]) | (bits & 0xffU));
  }
  std::string bytes_;
  std::size_t at_ = 0;
};

std::uint8_t eight_bits(float value) {
  constexpr float kMin = std::numeric_limits<std::int8_t>::min();
  constexpr float kMax = std::numeric_limits<std::int8_t>::max();
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, kMin, kMax)));
}

std::string channel_bytes(const CsiPacket& packet) {
  const auto antennas = static_cast<std::size_t>(packet.antennas);
  const auto streams = static_cast<std::size_t>(packet.streams);
  BitWriter bits(bytes_of_channel(antennas, streams));
  for (Eigen::Index k = 0; k < packet.channel.cols(); ++k) {
    bits.skip(kSkippedBits);
    for (std::size_t antenna = 0; antenna < antennas; ++antenna)
      for (std::size_t stream = 0; stream < streams; ++stream) {
        const auto value = packet.channel(static_cast<Eigen::Index>(stream * antennas + antenna), k);
        bits.add(eight_bits(value.real()));
        bits.add(eight_bits(value.imag()));
      }
  }
  return bits.bytes();
}

void append_host_part(std::string& out, const CsiPacket& packet) {
  const std::int64_t us = packet.stamp.ns / kNanosecondsPerMicrosecond;
  RADIOSLAM_CHECK(us >= 0 && us / kMicrosecondsPerSecond <= std::numeric_limits<std::uint32_t>::max(),
                  "seconds since the epoch in 32 bits");
  append_little_endian(out, static_cast<std::uint64_t>(us / kMicrosecondsPerSecond), 4);
  append_little_endian(out, static_cast<std::uint64_t>(us % kMicrosecondsPerSecond), 4);
  for (std::size_t byte = MacAddress::kBytes; byte > 0; --byte)
    out.push_back(static_cast<char>(packet.sender->value >> (kBitsPerByte * (byte - 1)) & 0xffU));
  append_little_endian(out, *packet.counter, 4);
}

void append_record(std::string& out, const CsiPacket& packet, std::size_t place, bool is_wide) {
  RADIOSLAM_CHECK(packet.antennas >= 1 && packet.antennas <= int{kMaxAntennas} && packet.streams >= 1 &&
                      packet.streams <= int{kMaxAntennas} &&
                      packet.channel.rows() == packet.antennas * packet.streams &&
                      packet.channel.cols() == Eigen::Index{kSubcarriers},
                  "a channel with the dimensions of the card");
  const std::string channel = channel_bytes(packet);
  std::string body;
  append_little_endian(body, packet.clock_us, 4);
  append_little_endian(body, place, 2);
  append_little_endian(body, 0, 2);
  append_byte(body, packet.antennas, 0, 255);
  append_byte(body, packet.streams, 0, 255);
  for (const int rssi : packet.rssi) append_byte(body, rssi, 0, 255);
  append_byte(body, packet.noise_dbm, -128, 127);
  append_byte(body, packet.gain_control_db, 0, 255);
  body.push_back(static_cast<char>(kAntennasInOrder));
  append_little_endian(body, channel.size(), 2);
  append_little_endian(body, kRateAndFlags | (is_wide ? kWideChannelFlag : 0U), 2);
  if (packet.sender && packet.counter) append_host_part(body, packet);
  body += channel;
  const std::size_t length = body.size() + 1;
  out.push_back(static_cast<char>(length >> kBitsPerByte));
  out.push_back(static_cast<char>(length & 0xffU));
  out.push_back(static_cast<char>(kChannelCode));
  out += body;
}

}  // namespace

CsiCapture read_intel5300(const std::string& name, std::string_view bytes) {
  return Reader(name, bytes).read();
}

std::string write_intel5300(const CsiCapture& capture) {
  std::string out;
  for (std::size_t k = 0; k < capture.packets.size(); ++k)
    append_record(out, capture.packets[k], k, capture.bandwidth_hz == kWideBandwidth_hz);
  return out;
}

}  // namespace radioslam
