// Sequential reader of the values in a serialised ROS message: ROS 1 (little endian, unaligned) or the Common
// Data Representation (CDR) of ROS 2 (either byte order, numbers aligned to their size after a header of four
// bytes).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "radioslam/base/stamp.hpp"
#include "radioslam/io/ros/ros_recording.hpp"
#include "radioslam/io/text/byte_cursor.hpp"

namespace radioslam {

/// std_msgs/Header.
struct RosHeader {
  Stamp stamp;
  std::string frame;  ///< without a leading slash
};

/// The header's stamp, or the recording time if it has none.
Stamp time_of(const RosMessage& message, const RosHeader& header);

/// Every read throws InputError (with topic and byte) if the message ends before the value.
class RosMessageReader {
 public:
  /// Refuses an encapsulation other than plain CDR.
  explicit RosMessageReader(const RosMessage& message);

  bool boolean() { return cursor_.u8() != 0; }
  std::uint8_t u8() { return cursor_.u8(); }
  std::uint16_t u16() { return align(2), cursor_.u16(); }
  std::int32_t i32() { return align(4), cursor_.i32(); }
  std::uint32_t u32() { return align(4), cursor_.u32(); }
  float f32() { return align(4), cursor_.f32(); }
  std::uint64_t u64() { return align(8), cursor_.u64(); }
  double f64() { return align(8), cursor_.f64(); }
  std::string text();
  std::string frame();
  RosHeader header();
  /// The number of elements that follow; refused if the message is too short for them at `min_bytes` each.
  std::size_t count(std::size_t min_bytes);
  /// The next bytes, unchanged.
  std::string_view take(std::size_t bytes) { return cursor_.take(bytes); }

  ByteOrder order() const { return order_; }
  [[noreturn]] void fail(const std::string& reason) const { cursor_.fail(reason); }

 private:
  void align(std::size_t bytes);

  bool is_cdr_;
  ByteOrder order_;
  std::string part_;
  ByteCursor cursor_;
};

}  // namespace radioslam
