#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "radioslam/base/check.hpp"
#include "radioslam/lidar/clouds/packed_cloud.hpp"
#include "radioslam/records/record_codec.hpp"
#include "radioslam/team/agent.hpp"

namespace radioslam {
namespace {

constexpr int kMostMessages = 32;
constexpr std::string_view kNext = "\n--\n";  // between messages

void hear(std::string_view bytes) {
  static const RunParams params;
  Agent agent("a", 2, params, {}, {1, {}});
  FactsRecord facts;
  facts.lidar_range_m = facts.lidar_view_rad = 1;
  agent.say(encode(Record(facts)));
  agent.note_kept();
  for (int k = 0; k < kMostMessages && !bytes.empty(); ++k) {
    const std::string_view message = bytes.substr(0, bytes.find(kNext));
    bytes.remove_prefix(std::min(bytes.size(), message.size() + kNext.size()));
    const Stamp now = Stamp::from_seconds(0.5 * k);
    const auto decoded = decode_message(message);
    if (const auto* received = std::get_if<ReceivedMessage>(&decoded)) {
      const auto again = decode_message(encode(received->sender, received->message));
      RADIOSLAM_CHECK(std::holds_alternative<ReceivedMessage>(again), "what was read is written and read");
      if (const auto* cloud = std::get_if<CloudMessage>(&received->message))
        unpacked_from_elsewhere(cloud->packed);
      agent.hear(received->sender, message, now);
    }
    agent.hear("b", message, now);
    agent.note_kept();
    for (const SentMessage& sent : agent.step(now).messages)
      RADIOSLAM_CHECK(std::holds_alternative<ReceivedMessage>(decode_message(sent.bytes)),
                      "what an agent sends is understood");
  }
  RADIOSLAM_CHECK(agent.logs().extents().at("a").records == 1, "nobody adds to this robot's log");
}

}  // namespace
}  // namespace radioslam

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(data, data + size);
  radioslam::hear(bytes);
  return 0;
}
