// Messages to exchange, and what has arrived.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "io/ros/ros_bytes.hpp"
#include "radioslam/io/dds/dds_names.hpp"
#include "radioslam/io/dds/dds_topic.hpp"
#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {

inline const std::string kOdometry = dds_type("nav_msgs/msg/Odometry"),
                         kCloud = dds_type("sensor_msgs/msg/PointCloud2");

inline std::string odometry_at(double x) {
  RosBytes bytes(MessageEncoding::kCdr);
  bytes.header(100, 5, "odom")
      .text("base_link")
      .f64s({x, 2, 3, 0, 0, 0, 1})
      .f64s(std::vector<double>(36, 0.25));
  return bytes.f64s({0, 0, 0, 0, 0, 0}).f64s(std::vector<double>(36, 0.5)).bytes();
}

/// PointCloud2 with x, y, z as f32.
inline std::string cloud(std::size_t points) {
  RosBytes bytes(MessageEncoding::kCdr);
  bytes.header(100, 5, "lidar").u32(1).u32(points).u32(3);
  for (unsigned k = 0; k < 3; ++k) bytes.text(std::string(1, "xyz"[k])).u32(4 * k).u8(7).u32(1);
  bytes.u8(0).u32(12).u32(12 * points).u32(12 * points);
  for (std::size_t k = 0; k < 3 * points; ++k) bytes.f32(static_cast<float>(k % 1000) / 8);
  return bytes.u8(1).bytes();
}

/// What a reader has been given, from any thread.
class Received {
 public:
  DdsReader::Take take() {
    return [this](const DdsReader::Sample& sample) {
      const std::lock_guard lock(mutex_);
      samples_.emplace_back(sample.cdr);
    };
  }
  std::size_t count() const {
    const std::lock_guard lock(mutex_);
    return samples_.size();
  }
  std::string at(std::size_t k) const {
    const std::lock_guard lock(mutex_);
    return samples_.at(k);
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> samples_;
};

inline RosPose pose_of(const std::string& cdr) {
  const RosChannel channel{"/odom", "nav_msgs/Odometry"};
  return read_ros_pose({channel, Stamp{0}, cdr, "wire"});
}

}  // namespace radioslam
