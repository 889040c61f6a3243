// Serialises messages in plain CDR, little endian, as ROS 2 has them on the wire and in recordings: an
// encapsulation of four bytes, then numbers aligned to their size.
#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "radioslam/base/little_endian.hpp"

namespace radioslam {

class CdrWriter {
 public:
  CdrWriter& u8(std::uint8_t value) { return number(value, 1); }
  CdrWriter& u16(std::uint16_t value) { return number(value, 2); }
  CdrWriter& u32(std::uint32_t value) { return number(value, 4); }
  CdrWriter& i32(std::int32_t value) { return u32(static_cast<std::uint32_t>(value)); }
  CdrWriter& u64(std::uint64_t value) { return number(value, 8); }
  CdrWriter& f32(float value) { return u32(std::bit_cast<std::uint32_t>(value)); }
  CdrWriter& f64(double value) { return u64(std::bit_cast<std::uint64_t>(value)); }
  CdrWriter& text(std::string_view text) {
    u32(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text;
    bytes_ += '\0';
    return *this;
  }
  /// The number of elements that follow.
  CdrWriter& count(std::size_t elements) { return u32(static_cast<std::uint32_t>(elements)); }
  /// Unchanged.
  CdrWriter& append(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }

  std::string take() { return std::move(bytes_); }

 private:
  static constexpr std::size_t kEncapsulationBytes = 4;

  CdrWriter& number(std::uint64_t value, std::size_t size) {
    const std::size_t misaligned = (bytes_.size() - kEncapsulationBytes) % size;
    if (misaligned != 0) bytes_.append(size - misaligned, '\0');
    append_little_endian(bytes_, value, size);
    return *this;
  }

  std::string bytes_{"\0\1\0\0", kEncapsulationBytes};
};

}  // namespace radioslam
