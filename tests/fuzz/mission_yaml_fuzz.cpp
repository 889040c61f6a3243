#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const std::string written = format_mission_yaml(read_mission_yaml(text, "name").mission);
    const MissionFile again = read_mission_yaml(make_text("again", written), "name");
    RADIOSLAM_CHECK(!again.mission.robots.empty(), "robots stay");
  });
}
