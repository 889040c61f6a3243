// Appends numbers to binary output in little endian order.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

namespace radioslam {

/// Appends the lowest `bytes` bytes of an integer, padded with zeros beyond eight bytes.
inline void append_little_endian(std::string& out, std::uint64_t value, std::size_t bytes) {
  for (; bytes > 0; --bytes, value >>= 8U) out += static_cast<char>(value & 0xffU);
}

inline void append_f32(std::string& out, float value) {
  append_little_endian(out, std::bit_cast<std::uint32_t>(value), sizeof(value));
}

inline void append_f64(std::string& out, double value) {
  append_little_endian(out, std::bit_cast<std::uint64_t>(value), sizeof(value));
}

}  // namespace radioslam
