#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/mission/tum.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const Trajectory<SE3> trajectory = read_tum(text);
    const Trajectory<SE3> again = read_tum(make_text("again", format_tum(trajectory)));
    RADIOSLAM_CHECK(again.size() == trajectory.size(), "poses stay");
    for (std::size_t k = 0; k < again.size(); ++k)
      RADIOSLAM_CHECK(again[k].stamp == trajectory[k].stamp, "stamps are exact");
  });
}
