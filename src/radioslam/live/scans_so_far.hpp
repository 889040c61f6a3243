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

/// What a robot's scanner is like.
struct ScannerFacts {
  ScannerKind kind = ScannerKind::kSpatial;
  double nominal_inlier_ratio = 1, spacing_m = 0.25;
};

class ScansSoFar {
 public:
  explicit ScansSoFar(const ScannerFacts& scanner = {}) : scanner_(scanner) {}
  /// Of a robot that has been replayed; without scans, it has none.
  explicit ScansSoFar(const ReplayedRobot& robot);

  void set_scanner(const ScannerFacts& scanner) { scanner_ = scanner; }
  const ScannerFacts& scanner() const { return scanner_; }
  /// The scan of a keyframe, in any order.
  void add(Stamp keyframe, StoredCloud cloud) { clouds_[keyframe] = std::move(cloud); }
  const std::map<Stamp, StoredCloud>& clouds() const { return clouds_; }

  /// Whether there are scans among these keyframes.
  bool has_any(const LoggedKeyframes& known) const;
  /// The scans among these keyframes; with `all`, every keyframe, those without a scan empty.
  ScanOdometry among(const LoggedKeyframes& known, bool all = false) const;
  /// The same; searches loops of those that came since the last call.
  ScanOdometry update(const LoggedKeyframes& known, const ScanLoopSearch& search, const Progress& progress);
  /// As found by the last update.
  const ScanLoops& loops() const { return loops_; }
  /// What an update of a copy found.
  void set_loops(ScanLoops loops) { loops_ = std::move(loops); }

 private:
  ScannerFacts scanner_;
  std::map<Stamp, StoredCloud> clouds_;
  ScanLoops loops_;
};

/// Adds a robot, the next of `measured`: its scans among these keyframes, updated, and its loops.
void add_updated(ScansSoFar& scans, const LoggedKeyframes& known, const ScanLoopSearch& search,
                 const Progress& progress, MeasuredScans& measured);

/// What the scans of these robots say among the keyframes known of them, with the loops of each.
MeasuredScans measured_so_far(std::map<std::string, ScansSoFar>& scans, const std::vector<Robot>& robots,
                              const std::map<std::string, LoggedKeyframes>& keyframes,
                              const ScanLoopSearch& search, const Progress& progress);

}  // namespace radioslam
