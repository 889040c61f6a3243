#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/run_folder.hpp"
#include "radioslam/io/run_tables.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const std::vector<std::string> ids = {"a", "b"};
    if (text.content.front() == '{' || text.content.front() == '[') {
      read_json(text);
    } else if (text.content.front() == '#') {
      read_candidates(text, ids);
    } else {
      const std::string written = format_closures(read_closures(text, ids), ids);
      const auto again = read_closures(make_text("again", written), ids);
      RADIOSLAM_CHECK(format_closures(again, ids) == written, "closures stay");
    }
  });
}
