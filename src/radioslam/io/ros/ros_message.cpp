#include "radioslam/io/ros/ros_message.hpp"

#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kEncapsulationBytes = 4;

bool is_cdr(const RosMessage& message) { return message.channel.encoding == MessageEncoding::kCdr; }

/// CDR header: 0 0 means big endian, 0 1 little endian; anything else is not plain CDR.
ByteOrder order_of(const RosMessage& message) {
  const bool is_big = is_cdr(message) && message.bytes.starts_with(std::string_view("\0\0", 2));
  return is_big ? ByteOrder::kBig : ByteOrder::kLittle;
}

}  // namespace

Stamp time_of(const RosMessage& message, const RosHeader& header) {
  return header.stamp != Stamp{} ? header.stamp : message.stamp;
}

RosMessageReader::RosMessageReader(const RosMessage& message)
    : is_cdr_(is_cdr(message)),
      order_(order_of(message)),
      part_("a message of " + message.channel.topic),
      cursor_(message.bytes, order_, {message.file, part_}) {
  if (!is_cdr_) return;
  const std::string_view encapsulation = cursor_.take(kEncapsulationBytes);
  if (encapsulation[0] != 0 || static_cast<unsigned char>(encapsulation[1]) > 1)
    cursor_.fail("not encoded as plain CDR");
}

void RosMessageReader::align(std::size_t bytes) {
  if (!is_cdr_) return;
  const std::size_t over = (cursor_.position() - kEncapsulationBytes) % bytes;
  if (over > 0) cursor_.take(bytes - over);
}

std::string RosMessageReader::text() {
  std::string_view bytes = cursor_.take(u32());
  if (is_cdr_ && !bytes.empty()) bytes.remove_suffix(1);  // terminating zero
  return std::string(bytes);
}

std::string RosMessageReader::frame() {
  std::string name = text();
  return name.starts_with('/') ? name.substr(1) : name;
}

RosHeader RosMessageReader::header() {
  if (!is_cdr_) u32();  // seq
  const std::int64_t seconds = is_cdr_ ? std::int64_t{i32()} : std::int64_t{u32()};
  const Stamp stamp{seconds * kNanosecondsPerSecond + u32()};
  return {stamp, frame()};
}

std::size_t RosMessageReader::count(std::size_t min_bytes) {
  const std::size_t elements = u32();
  if (elements > cursor_.left() / min_bytes)
    cursor_.fail("the message ends within its " + std::to_string(elements) + " elements");
  return elements;
}

}  // namespace radioslam
