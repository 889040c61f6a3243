#include <algorithm>

#include "radioslam/base/check.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/io/wifi/sensor_data_log.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    const PhoneLog log = read_sensor_data_log(make_tool_output("input", std::string(data, data + size)));
    RADIOSLAM_CHECK(log.begin < log.end, "a recording lasts");
    const auto& force = log.motion.specific_force_mps2;
    RADIOSLAM_CHECK(std::is_sorted(force.begin(), force.end(),
                                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; }),
                    "time runs forward");
  } catch (const InputError&) {
  }
  return 0;
}
