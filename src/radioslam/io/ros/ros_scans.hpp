// Reads the laser scans of one topic of a ROS recording; the unit of the points' times is determined from the
// first messages (point_times.hpp).
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/ros/ros_types.hpp"

namespace radioslam {

/// Receives the scans one by one, in any order, with unique stamps, so that they need not fit into memory.
using RosScanSink = std::function<void(Stamp, const LidarScan&)>;

/// Passes the scans on in the order of their messages; the first ten are held back until the tenth or
/// finish().
class RosScans {
 public:
  using Take = std::function<void(const RosMessage&, RosScan)>;

  explicit RosScans(Take take) : take_(std::move(take)) {}

  /// Adds a message of a scan type; all must be of one channel. Refuses whatever read_ros_scan refuses.
  void take(const RosMessage& message);
  void finish();

  /// Notes for the user on the points' times, one line each.
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
  std::optional<std::string> unit_note_;  ///< note if the unit is not the nominal one
  std::map<PointClock, std::size_t> clocks_;
  std::string topic_;
};

}  // namespace radioslam
