#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/graph/pyfg.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    std::visit(
        [](const auto& file) {
          std::size_t poses = 0;
          for (const TrajectorySegment& segment : file.team.segments) {
            RADIOSLAM_CHECK(segment.first_pose == poses, "segments follow one another");
            poses += segment.pose_count;
          }
          RADIOSLAM_CHECK(poses == file.team.graph.poses.size() && poses == file.true_poses.size(),
                          "every pose belongs to a segment and has a true value");
        },
        read_pyfg(text));
  });
}
