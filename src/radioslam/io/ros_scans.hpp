// The laser scans of one topic of a ROS recording, whose first messages show in what unit the points' times
// are (point_times.hpp).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/ros_types.hpp"

namespace radioslam {

/// Takes the scans one by one, in any order, each stamp once: they need not fit into memory.
using RosScanSink = std::function<void(Stamp, const LidarScan&)>;

/// Hands the scans on in the order of their messages, the first ten only after the tenth has come or with
/// finish().
class RosScans {
 public:
  using Take = std::function<void(const RosMessage&, RosScan)>;

  explicit RosScans(Take take) : take_(std::move(take)) {}

  /// A message of a scan type, all of one channel. Refuses what read_ros_scan refuses.
  void take(const RosMessage& message);
  void finish();

  /// What a user should know about the times, one line each.
  std::vector<std::string> notes() const;

 private:
  struct Held {
    RosChannel channel;
    Stamp stamp;
    std::string bytes, file;

    RosMessage message() const { return {channel, stamp, bytes, file}; }
  };

  void find_unit();
  void hand_on(const RosMessage& message);

  Take take_;
  std::vector<Held> held_;
  bool has_unit_ = false;
  std::optional<PointTimeUnit> unit_;
  std::optional<std::string> unusual_;  ///< of the unit, what there is to say
  std::map<PointClock, std::size_t> clocks_;
  std::string topic_;
};

}  // namespace radioslam
