// The first byte selects the encoding and type of a message; the rest is the message.
#include <array>

#include "radioslam/io/ros/ros_types.hpp"
#include "ros_checks.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace radioslam;
  constexpr std::array<const char*, 8> kTypes{"nav_msgs/Odometry",
                                              "geometry_msgs/PoseStamped",
                                              "geometry_msgs/TransformStamped",
                                              "tf2_msgs/TFMessage",
                                              "tf/tfMessage",
                                              "sensor_msgs/PointCloud2",
                                              "sensor_msgs/LaserScan",
                                              "sensor_msgs/Imu"};
  if (size == 0) return 0;
  const RosChannel channel{"/topic", kTypes[data[0] % kTypes.size()],
                           (data[0] & 0x80U) != 0 ? MessageEncoding::kRos1 : MessageEncoding::kCdr};
  const std::string bytes(data + 1, data + size);
  try {
    read_as_said({channel, {}, bytes, "input"});
  } catch (const InputError&) {
  }
  return 0;
}
