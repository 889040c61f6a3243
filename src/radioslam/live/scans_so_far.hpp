// What a robot's scans say up to a time: its keyframes with their clouds, in the odometry as it was known,
// and the loops found among them so far.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "radioslam/front_end/replay.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/places/loops/scan_loops.hpp"
#include "radioslam/records/record.hpp"

namespace radioslam {

/// A robot's keyframes as its log says them.
struct LoggedKeyframes {
  std::vector<StampedPose<SE3>> said;     ///< T_start_body, as it was said first: its frame does not jump
  std::vector<UncertainPose<SE3>> steps;  ///< to each from the one before, with amendments

  void add(const KeyframeRecord& keyframe);
  void add(const AmendmentRecord& amendment);
};

class ScansSoFar {
 public:
  /// Of a robot that has been replayed; without scans, it has none.
  explicit ScansSoFar(const ReplayedRobot& robot);

  /// Whether there are scans among these keyframes.
  bool has_any(const LoggedKeyframes& known) const;
  /// The scans among these keyframes; searches loops of those that came since the last call.
  ScanOdometry update(const LoggedKeyframes& known, const ScanLoopSearch& search, const Progress& progress);
  /// As found by the last update.
  const ScanLoops& loops() const { return loops_; }

 private:
  std::vector<Stamp> stamps_;
  ScanKeyframes all_;  ///< their poses are those of hindsight, and not used
  ScanLoops loops_;
};

/// What the scans of these robots say among the keyframes known of them, with the loops of each.
MeasuredScans measured_so_far(std::map<std::string, ScansSoFar>& scans, const std::vector<Robot>& robots,
                              const std::map<std::string, LoggedKeyframes>& keyframes,
                              const ScanLoopSearch& search, const Progress& progress);

}  // namespace radioslam
