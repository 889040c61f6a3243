#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/graph/g2o_team.hpp"

/// One file of a team, with its bad lines left out, and the same file twice.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const std::vector<Text> files{text, {"other", text.content}};
    for (const std::size_t count : {1U, 2U})
      std::visit(
          [](const auto& file) {
            std::size_t poses = 0;
            for (const TrajectorySegment& segment : file.team.segments) poses += segment.pose_count;
            RADIOSLAM_CHECK(poses == file.team.graph.poses.size() && poses == file.pose_ids.size(),
                            "every pose belongs to a segment and has its key");
          },
          read_g2o_team(std::span(files).first(count), StatedStarts::kUsed));
  });
}
