// Reads numbers and texts out of bytes, one after the other; refuses to read beyond them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/byte_view.hpp"

namespace radioslam {

/// What the bytes are part of, for refusals.
struct BytesPlace {
  std::string_view file;
  std::string_view part = {};  ///< "a message of /scan", or nothing where the bytes are the file's own
  std::size_t begin = 0;       ///< of the bytes in the file, or in the part
};

class ByteCursor {
 public:
  ByteCursor(std::string_view bytes, ByteOrder order, const BytesPlace& place)
      : bytes_(bytes), view_(bytes, order), place_(place) {}

  bool empty() const { return at_ == bytes_.size(); }
  std::size_t left() const { return bytes_.size() - at_; }
  /// Where the next byte is, counted as the place counts.
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
  /// Bytes whose number precedes them as a u32.
  std::string_view counted() { return take(u32()); }
  std::string_view rest() { return take(left()); }

  [[noreturn]] void fail(const std::string& reason) const {
    throw InputError(std::string(place_.file), 0,
                     std::string(place_.part) + (place_.part.empty() ? "at byte " : ", at its byte ") +
                         std::to_string(position()) + ": " + reason);
  }

 private:
  std::size_t step(std::uint64_t count) {
    if (count > left()) fail("the data end early");
    const std::size_t begin = at_;
    at_ += static_cast<std::size_t>(count);
    return begin;
  }

  std::string_view bytes_;
  ByteView view_;
  BytesPlace place_;
  std::size_t at_ = 0;
};

}  // namespace radioslam
