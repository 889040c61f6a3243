// The samples of a recorded robot, in the order in which they are known.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "radioslam/front_end/front_end.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"

namespace radioslam {

class RecordedSamples {
 public:
  /// Keeps references. Scans are read when they are taken.
  RecordedSamples(const Mission& mission, RobotIndex self);

  /// When the next sample is known; nothing after the last one.
  std::optional<Stamp> next() const;
  Sample take();
  /// Leaves out those that are known before.
  void skip_before(Stamp begin);
  double share_taken() const { return static_cast<double>(taken_) / static_cast<double>(total_); }

 private:
  /// One kind of recordings.
  struct Stream {
    std::vector<Stamp> stamps;  ///< at which they are known, in order
    std::function<Sample(std::size_t)> sample;
    std::size_t taken = 0;

    bool is_over() const { return taken == stamps.size(); }
  };
  static std::vector<Stream> streams_of(const Mission& mission, RobotIndex self);
  template <class Items, class Keep>
  static Stream stream_of(const Items& items, const Keep& keep);
  template <class Items>
  static Stream stream_of(const Items& items);
  std::size_t first() const;

  std::vector<Stream> streams_;
  std::size_t taken_ = 0, total_ = 0;
};

/// What the robot has recorded its motion with.
MotionSources sources_of(const Robot& robot);

/// After the front end's finish(): what hindsight makes of the motion.
void amend_with_hindsight(FrontEnd& front_end, const TrackedScans& tracked, const Robot& robot,
                          const ScanStageParams& params);

}  // namespace radioslam
