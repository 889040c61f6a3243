// A robot's log as an estimate in the plane reads it: record by record, from the first one on, in the order
// of their numbers. What does not fit those before it is left out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/records/record.hpp"
#include "radioslam/rendezvous/angle_evidence.hpp"

namespace radioslam {

/// Another robot as it was seen from a pose of this one.
struct Sighting {
  std::uint32_t keyframe = 0;
  std::string robot;
  Stamp stamp;
  SE2 T_i_j;
  SE2::Jacobian covariance = SE2::Jacobian::Identity();
  std::optional<AngleEvidence> evidence{};  ///< by the angles heard at both ends, once it is worked out
};

class ReadLog {
 public:
  explicit ReadLog(std::uint32_t life) : life_(life) {}

  void take(const Record& record);
  /// The robot has said all it measured until a time.
  void is_whole_until(Stamp stamp) { until_ = std::max(until_, stamp); }

  /// The robot's pose at a time; nothing before the first, and where a later one may not be known yet.
  std::optional<std::uint32_t> keyframe_at(Stamp stamp) const;
  /// Arrivals of another robot's packets at a pose, of those nearest to a time.
  std::vector<std::vector<ArrivalPath>> arrivals(const std::string& robot, std::uint32_t keyframe,
                                                 Stamp stamp) const;

  std::uint32_t life() const { return life_; }  ///< which recording of the robot it is
  Stamp until() const { return until_; }
  std::uint64_t records() const { return records_; }
  const std::optional<SE2>& start() const { return start_; }  ///< in the common frame, where it is known
  const std::vector<Stamp>& stamps() const { return stamps_; }
  /// From keyframe k - 1 to k; of the first, nothing.
  const std::vector<UncertainPose<SE2>>& steps() const { return steps_; }
  std::vector<Sighting>& sightings() { return sightings_; }
  const std::vector<Sighting>& sightings() const { return sightings_; }

 private:
  void take(const KeyframeRecord& keyframe);
  void take(const ClosureRecord& closure);
  void take(const AnglesRecord& angles);

  struct Heard {
    Stamp stamp;
    std::vector<ArrivalPath> paths;
  };
  std::uint32_t life_;
  std::uint64_t records_ = 0;
  Stamp until_{std::numeric_limits<std::int64_t>::min()};
  std::optional<SE2> start_;
  std::vector<Stamp> stamps_;
  std::vector<UncertainPose<SE2>> steps_;
  std::vector<Sighting> sightings_;
  std::map<std::pair<std::string, std::uint32_t>, std::vector<Heard>> heard_;
};

/// As records have them: in space, with what the plane does not know as good as known.
KeyframeRecord keyframe_of(std::uint32_t number, Stamp stamp, const SE2& step, double sigma_m,
                           double sigma_rad);
ClosureRecord closure_of(std::uint32_t keyframe, const Sighting& seen);
AnglesRecord angles_of(std::uint32_t keyframe, Stamp stamp, const std::string& from,
                       const std::vector<ArrivalPath>& paths);

/// Standard deviations per axis as a covariance; never zero.
SE2::Jacobian planar_covariance(double sigma_m, double sigma_rad);

}  // namespace radioslam
