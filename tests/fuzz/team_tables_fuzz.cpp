#include "fuzzed.hpp"
#include "radioslam/io/team_tables.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const TeamNames names{{"a", "b"}, {"A1"}};
    // The first character chooses the table, so that one corpus serves all.
    switch (text.content[0]) {
      case 'r':
        return check_ranges({text.name, text.content.substr(1)}, names);
      case 'd':
        return check_angles({text.name, text.content.substr(1)}, names);
      case 'm':
        return check_matches({text.name, text.content.substr(1)}, names);
      default:
        read_anchor_ids({text.name, text.content.substr(1)}, names);
    }
  });
}
