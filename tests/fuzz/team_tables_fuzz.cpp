#include "fuzzed.hpp"
#include "radioslam/io/mission/robot_tables.hpp"
#include "radioslam/io/mission/team_tables.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const TeamNames names{{{"a", RobotIndex(0)}, {"b", RobotIndex(1)}},
                          {{{"front", Eigen::Vector3d::UnitX()}}},
                          {{"A1", AnchorIndex(0)}}};
    // The first character selects the table, so that one corpus serves all of them.
    const Text table{text.name, text.content.substr(1)};
    switch (text.content[0]) {
      case 'r':
        read_ranges(table, names);
        return;
      case 'd':
        read_aoa(table, names);
        return;
      case 'm':
        read_matches(table, names);
        return;
      case 'f':
        read_fixes(table);
        return;
      default:
        read_anchors(table, names, 2);
    }
  });
}
