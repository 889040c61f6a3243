// Sequential reader of numbers and texts in binary data, with a bounds check on every read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/byte_view.hpp"

namespace radioslam {

/// Where the bytes come from, for error messages.
struct ByteSource {
  std::string_view file;
  std::string_view part = {};  ///< "a message of /scan"; empty if the bytes are those of the file itself
  std::size_t begin = 0;       ///< offset of the bytes in the file or in the part
};

class ByteCursor {
 public:
  ByteCursor(std::string_view bytes, ByteOrder order, const ByteSource& place)
      : bytes_(bytes), view_(bytes, order), place_(place) {}

  bool empty() const { return at_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - at_; }
  /// Offset of the next byte in the file or in the part.
  std::size_t position() const { return place_.begin + at_; }

  std::uint8_t u8() { return view_.u8(step(1)); }
  std::uint16_t u16() { return view_.u16(step(2)); }
  std::uint32_t u32() { return view_.u32(step(4)); }
  std::int32_t i32() { return view_.i32(step(4)); }
  std::uint64_t u64() { return view_.u64(step(8)); }
  float f32() { return view_.f32(step(4)); }
  double f64() { return view_.f64(step(8)); }

  std::string_view take(std::uint64_t count) {
    const std::size_t begin = step(count);
    return bytes_.substr(begin, static_cast<std::size_t>(count));
  }
  /// Bytes preceded by their number as a u32.
  std::string_view counted() { return take(u32()); }
  std::string_view rest() { return take(left()); }
  /// Skips zero bytes; returns their number.
  std::size_t skip_zeros() {
    const std::size_t begin = at_;
    while (at_ < bytes_.size() && bytes_[at_] == 0) ++at_;
    return at_ - begin;
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(std::string(place_.file), 0,
                     std::string(place_.part) + (place_.part.empty() ? "at byte " : ", at its byte ") +
                         std::to_string(position()) + ": " + reason);
  }

 private:
  std::size_t step(std::uint64_t count) {
    if (count > left()) fail("unexpected end of the data");
    const std::size_t begin = at_;
    at_ += static_cast<std::size_t>(count);
    return begin;
  }

  std::string_view bytes_;
  ByteView view_;
  ByteSource place_;
  std::size_t at_ = 0;
};

}  // namespace radioslam
