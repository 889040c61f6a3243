#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/graph/jrl.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    std::visit(
        [](const auto& file) {
          const auto& graph = file.team.graph;
          RADIOSLAM_CHECK(file.pose_ids.size() == graph.poses.size(), "every pose has its key");
          RADIOSLAM_CHECK(file.labels.empty() || file.labels.size() == graph.relative_poses.size(),
                          "every relative pose has a label");
          RADIOSLAM_CHECK(file.true_poses.empty() || file.true_poses.size() == graph.poses.size(),
                          "every pose has a place for its true value");
        },
        read_jrl(text));
  });
}
