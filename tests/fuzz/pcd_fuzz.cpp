#include "lidar_checks.hpp"
#include "radioslam/io/lidar/pcd.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  try {
    const LidarScan scan = read_pcd({"input", std::string(data, data + size)}, {1'574'407'123'500'000'000});
    check_scan(scan);
    const LidarScan again = read_pcd({"written", format_pcd(scan)}, {});
    RADIOSLAM_CHECK(again.points.size() == scan.points.size(), "a scan's own file holds its points");
  } catch (const InputError&) {
  }
  return 0;
}
