#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const auto write = [](const WifiRecordings& r) { return format_wifi(r.receivers[0], r.access_points); };
    const std::string written = write(read_wifi({&text, 1}));
    const Text again = make_text("again", written);
    RADIOSLAM_CHECK(write(read_wifi({&again, 1})) == written, "scans stay");
  });
}
