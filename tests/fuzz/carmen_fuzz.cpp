#include "lidar_checks.hpp"
#include "radioslam/io/lidar/carmen.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  return fuzz_reader(data, size, [](const Text& text) {
    const Robot robot = read_carmen(text, "a").mission.robots.at(0);
    for (std::size_t k = 0; k < robot.lidar.size(); ++k) {
      check_scan(robot.lidar.read(k));
      RADIOSLAM_CHECK(robot.lidar.stamps[k] == robot.odometry[k].stamp, "each scan has its odometry");
    }
  });
}
