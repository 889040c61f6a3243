// Fixed-size numbers at given offsets in binary data, in little or big endian order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "radioslam/base/little_endian.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

enum class ByteOrder { kLittle, kBig };

/// Random access to numbers in bytes, without bounds checks.
class ByteView {
 public:
  ByteView(std::string_view bytes, ByteOrder order) : bytes_(bytes), order_(order) {}

  std::size_t size() const { return bytes_.size(); }
  std::uint8_t u8(std::size_t at) const { return static_cast<std::uint8_t>(bytes_[at]); }
  int i8(std::size_t at) const { return static_cast<std::int8_t>(u8(at)); }
  std::uint16_t u16(std::size_t at) const { return static_cast<std::uint16_t>(number(at, 2)); }
  int i16(std::size_t at) const { return static_cast<std::int16_t>(u16(at)); }
  std::uint32_t u32(std::size_t at) const { return static_cast<std::uint32_t>(number(at, 4)); }
  std::int32_t i32(std::size_t at) const { return static_cast<std::int32_t>(u32(at)); }
  std::uint64_t u64(std::size_t at) const { return number(at, 8); }
  std::int64_t i64(std::size_t at) const { return static_cast<std::int64_t>(u64(at)); }
  float f32(std::size_t at) const { return std::bit_cast<float>(u32(at)); }
  double f64(std::size_t at) const { return std::bit_cast<double>(u64(at)); }
  /// The first byte is the most significant one, regardless of the byte order of numbers.
  MacAddress mac_address(std::size_t at) const { return {ByteView(bytes_, ByteOrder::kBig).number(at, 6)}; }

 private:
  std::uint64_t number(std::size_t at, std::size_t bytes) const {
    std::uint64_t value = 0;
    for (std::size_t k = 0; k < bytes; ++k)
      value = value << 8U | u8(order_ == ByteOrder::kBig ? at + k : at + bytes - 1 - k);
    return value;
  }

  std::string_view bytes_;
  ByteOrder order_;
};

}  // namespace radioslam
