#include <algorithm>
#include <cmath>

#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/wifi/phone_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const PhoneLog log = read_phone_log(text);
    const auto forward = [](const auto& samples) {
      return std::is_sorted(samples.begin(), samples.end(),
                            [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    };
    RADIOSLAM_CHECK(log.begin < log.end, "a walk lasts");
    RADIOSLAM_CHECK(forward(log.motion.specific_force_mps2) && forward(log.motion.angular_rate_radps) &&
                        forward(log.motion.orientation) && forward(log.waypoints),
                    "time runs forward");
    for (const auto& sample : log.motion.orientation)
      RADIOSLAM_CHECK(std::abs(sample.R_enu_device.norm() - 1) < 1e-9, "orientations are rotations");
    for (const auto& entry : log.wifi) RADIOSLAM_CHECK(!entry.bssid.empty(), "an access point has an id");
  });
}
