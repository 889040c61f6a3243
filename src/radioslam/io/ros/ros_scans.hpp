// Reads the laser scans of one topic of a ROS recording.
//
// From the first ten messages, which are held back until then, it finds the unit of the points' times
// (point_times.hpp) and whether messages are slices of sweeps (mission/sweep_slices.hpp), which are gathered
// into one scan per sweep. A message that cannot be read is left out and noted; if none can, the first one's
// error is thrown.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/ros/ros_types.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/mission/sweep_slices.hpp"

namespace radioslam {

/// Receives the scans one by one, in any order, with unique stamps, so that they need not fit into memory.
using RosScanSink = std::function<void(Stamp, const LidarScan&)>;

/// Passes the scans on in the order of their messages.
class RosScans {
 public:
  using Take = std::function<void(Stamp, RosScan)>;

  explicit RosScans(Take take) : take_(std::move(take)) {}

  /// Adds a message of a scan type; all must be of one channel.
  void take(const RosMessage& message);
  /// Refuses (InputError) a topic none of whose messages can be read.
  void finish();

  /// Whether scans are passed on as they come.
  bool has_begun() const { return has_begun_; }
  std::size_t unreadable() const { return unreadable_.count(); }

  /// Notes for the user on the points' times, slices and unreadable messages, one line each.
  std::vector<std::string> notes() const;

 private:
  struct Held {
    RosChannel channel;
    Stamp stamp;
    std::string bytes, file;

    RosMessage message() const { return {channel, stamp, bytes, file}; }
  };
  struct Read {
    Stamp stamp;
    RosScan scan;
  };

  void begin();
  void find_unit();
  void find_slices(const std::vector<Read>& scans);
  std::optional<Read> read(const RosMessage& message);
  void hand_on(Read read);
  void hand_on(std::vector<StampedScan> sweeps);
  void note_slices(std::vector<std::string>& notes) const;

  Take take_;
  std::vector<Held> held_;
  bool has_begun_ = false;
  std::optional<PointTimeUnit> unit_;
  bool are_frozen_ = false;               ///< absolute times do not advance from scan to scan
  std::optional<std::string> unit_note_;  ///< note if the unit is not the nominal one
  std::map<PointClock, std::size_t> clocks_;
  std::optional<SweepAssembler> sweeps_;  ///< if the messages are slices
  SliceMotion slices_;
  RosScan last_;  ///< without points: header and range of the slices
  SkippedRecords unreadable_;
  std::size_t readable_ = 0;
  std::string topic_;
};

}  // namespace radioslam
