#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/graph/g2o.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const auto written = std::visit([](const auto& graph) { return format_g2o(graph); },
                                    read_g2o(text, RepairInformation::kYes));
    // The written text reads back as the same graph.
    const AnyG2oGraph again = read_g2o(make_text("again", written), RepairInformation::kYes);
    std::visit([](const auto& graph) { RADIOSLAM_CHECK(!graph.graph.poses.empty(), "poses stay"); }, again);
  });
}
