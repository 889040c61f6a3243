#include "fuzzed.hpp"
#include "radioslam/base/check.hpp"
#include "radioslam/io/pyfg.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    std::visit(
        [](const auto& file) {
          std::size_t poses = 0;
          for (const Piece& piece : file.team.pieces) {
            RADIOSLAM_CHECK(piece.first_pose == poses, "pieces follow each other");
            poses += piece.pose_count;
          }
          RADIOSLAM_CHECK(poses == file.team.graph.poses.size() && poses == file.true_poses.size(),
                          "every pose belongs to a piece and has a truth");
        },
        read_pyfg(text));
  });
}
