#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/run/run_tables.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const std::vector<std::string> ids = {"a", "b"};
    // Robots without poses: their keyframes are unknown, so any stamp is accepted.
    const std::vector<EstimatedTrajectory> robots = {{"a", {}}, {"b", {}}};
    if (text.content.front() == '{' || text.content.front() == '[') {
      read_json(text);
    } else if (text.content.front() == '#') {
      read_candidates(text, robots);
    } else {
      const std::string written = format_closures(read_closures(text, robots), ids);
      const auto again = read_closures(make_text("again", written), robots);
      RADIOSLAM_CHECK(format_closures(again, ids) == written, "closures stay");
    }
  });
}
