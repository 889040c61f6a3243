#include <cmath>

#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/wifi/iw_ftm.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const IwFtmParams params;
    const IwFtmLog log = read_iw_ftm(text, params);
    for (std::size_t k = 0; k < log.ranges.size(); ++k) {
      const FtmRange& range = log.ranges[k];
      RADIOSLAM_CHECK(range.range_m >= 0 && range.range_m <= params.max_range_m, "a plausible distance");
      RADIOSLAM_CHECK(std::isfinite(range.sigma_m) && range.sigma_m >= params.min_sigma_m, "a sigma");
      RADIOSLAM_CHECK(k == 0 || log.ranges[k - 1].stamp <= range.stamp, "in the order of time");
      RADIOSLAM_CHECK(range.bssid.size() == 17, "an address");
    }
    RADIOSLAM_CHECK(log.disagreeing <= log.ranges.size(), "among the ranges");
  });
}
