#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/intel5300.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    const CsiCapture capture = read_intel5300("input", std::string(data, data + size));
    RADIOSLAM_CHECK(!capture.packets.empty(), "an empty capture is refused");
    for (const CsiPacket& packet : capture.packets) {
      RADIOSLAM_CHECK(packet.channel.rows() == packet.antennas * packet.streams,
                      "a row per antenna and stream");
      RADIOSLAM_CHECK(packet.channel.cols() == static_cast<Eigen::Index>(capture.subcarrier_hz.size()),
                      "a column per subcarrier");
    }
  } catch (const InputError&) {
  }
  return 0;
}
