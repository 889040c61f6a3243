// Bytes of the messages between robots: numbers of fixed size in little endian order, and small whole numbers
// in base 128 (LEB128), as protocol buffers have them. A reader never reads beyond its bytes: after the first
// number that is not there, or is not finite, it returns zeros and `good()` is false.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "radioslam/base/little_endian.hpp"

namespace radioslam {

class WireWriter {
 public:
  void byte(std::uint8_t value) { bytes_ += static_cast<char>(value); }
  void whole(std::uint64_t value) {
    for (; value >= 0x80U; value >>= 7U) byte(static_cast<std::uint8_t>(value | 0x80U));
    byte(static_cast<std::uint8_t>(value));
  }
  void u32(std::uint32_t value) { append_little_endian(bytes_, value, sizeof(value)); }
  void f32(float value) { append_f32(bytes_, value); }
  void f64(double value) { append_f64(bytes_, value); }
  void append(std::string_view bytes) { bytes_ += bytes; }

  std::size_t size() const { return bytes_.size(); }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t byte() {
    if (bytes_.empty()) {
      good_ = false;
      return 0;
    }
    const auto value = static_cast<std::uint8_t>(bytes_.front());
    bytes_.remove_prefix(1);
    return value;
  }
  std::uint64_t whole() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 63; shift += 7) {
      const std::uint64_t next = byte();
      value |= (next & 0x7fU) << shift;
      if ((next & 0x80U) == 0) return value;
    }
    good_ = false;
    return 0;
  }
  std::uint32_t whole32() {
    const std::uint64_t value = whole();
    if (value > 0xffffffffU) good_ = false;
    return static_cast<std::uint32_t>(value);
  }
  /// A count of things that take at least `bytes_each`: never more than there is room for.
  std::size_t count(std::size_t bytes_each) {
    const std::uint64_t value = whole();
    if (value > bytes_.size() / bytes_each) good_ = false;
    return good_ ? static_cast<std::size_t>(value) : 0;
  }
  std::uint32_t u32() { return static_cast<std::uint32_t>(fixed(4)); }
  float f32() { return finite(std::bit_cast<float>(u32())); }
  double f64() { return finite(std::bit_cast<double>(fixed(8))); }
  std::string_view take(std::size_t count) {
    if (count > bytes_.size()) {
      good_ = false;
      count = 0;
    }
    const auto taken = bytes_.substr(0, count);
    bytes_.remove_prefix(count);
    return taken;
  }

  bool empty() const { return bytes_.empty(); }
  std::size_t left() const { return bytes_.size(); }
  bool good() const { return good_; }
  void refuse() { good_ = false; }

 private:
  std::uint64_t fixed(unsigned bytes) {
    std::uint64_t value = 0;
    for (unsigned k = 0; k < bytes; ++k) value |= std::uint64_t{byte()} << (8U * k);
    return value;
  }
  template <class Number>
  Number finite(Number value) {
    if (!std::isfinite(value)) good_ = false;
    return good_ ? value : Number{0};
  }

  std::string_view bytes_;
  bool good_ = true;
};

}  // namespace radioslam
