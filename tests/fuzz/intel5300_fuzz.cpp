#include "csi_checks.hpp"
#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/csi/intel5300.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  constexpr std::int64_t kSomeYear_ns = 4'000'000'000'000'000'000;  // the writer's seconds have 32 bits
  try {
    const CsiCapture capture = read_intel5300("input", std::string(data, data + size));
    check_capture(capture);
    for (const CsiPacket& packet : capture.packets)
      if (packet.stamp.ns > kSomeYear_ns) return 0;
    const CsiCapture again = read_intel5300("again", write_intel5300(capture));
    RADIOSLAM_CHECK(again.packets.size() == capture.packets.size(), "what is written reads back");
    for (std::size_t k = 0; k < again.packets.size(); ++k)
      RADIOSLAM_CHECK(again.packets[k].channel == capture.packets[k].channel &&
                          again.packets[k].stamp == capture.packets[k].stamp,
                      "as it was");
  } catch (const InputError&) {
  }
  return 0;
}
