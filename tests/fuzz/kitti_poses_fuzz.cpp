#include "fuzzed.hpp"
#include "radioslam/io/lidar/kitti_sequence.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) { read_kitti_poses(text); });
}
