#include "radioslam/io/csi/intel5300_write.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "radioslam/base/check.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/intel5300_layout.hpp"
#include "radioslam/io/text/little_endian.hpp"

namespace radioslam {
namespace {

using namespace intel5300;

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

std::string write_intel5300(const CsiCapture& capture) {
  std::string out;
  for (std::size_t k = 0; k < capture.packets.size(); ++k)
    append_record(out, capture.packets[k], k, capture.bandwidth_hz == kWideBandwidth_hz);
  return out;
}

}  // namespace radioslam
