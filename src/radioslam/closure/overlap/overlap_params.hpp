// Parameters, inputs and results of the overlap search.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/overlap/overlap_distance.hpp"

namespace radioslam {

struct OverlapParams {
  double max_mahalanobis = 1.5;      ///< D
  std::string distance = "minimum";  ///< minimum: d_min; seed: d* (overlap_distance.hpp)

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(max_mahalanobis, "", 0.001, 1000,
                          "largest distance of two views from overlapping, in standard deviations; higher "
                          "values keep more pairs");
    RADIOSLAM_FIELD(distance, "", 0, 0,
                    "kind of overlap distance; minimum: to the nearest point (Mahalanobis metric); seed: "
                    "along the line of sight, reproduces Wi-Closure (Wang et al.)",
                    "minimum|seed");
  }
};

inline OverlapDistance overlap_distance(const OverlapParams& params) {
  return params.distance == "seed" ? OverlapDistance::kLineOfSight : OverlapDistance::kMinimum;
}

/// Range of a robot's sensor and its horizontal field of view about body x.
struct OverlapSensor {
  double range_m = 30;
  double view_rad = 2 * std::numbers::pi;
};

/// A pair of poses of different robots, robot_a listed before robot_b, whose views could overlap.
struct OverlapCandidate {
  std::uint32_t robot_a = 0, robot_b = 0;
  std::uint32_t pose_a = 0, pose_b = 0;  ///< indices into the source's list of searched poses
  double distance_m = 0;
  double mahalanobis = 0;
  bool operator==(const OverlapCandidate&) const = default;
};

/// Statistics of a search.
struct OverlapCounts {
  std::uint64_t pairs = 0;  ///< of poses of different robots
  std::uint64_t kept = 0;
  std::uint64_t distances_evaluated = 0;  ///< between poses: of pairs, and of boxes' middle poses
  std::uint64_t boxes_visited = 0;        ///< pairs of boxes

  OverlapCounts& operator+=(const OverlapCounts& other) {
    pairs += other.pairs;
    kept += other.kept;
    distances_evaluated += other.distances_evaluated;
    boxes_visited += other.boxes_visited;
    return *this;
  }
};

/// Ordered by robots, then poses.
struct OverlapCandidates {
  std::vector<OverlapCandidate> candidates;
  OverlapCounts counts;
};

}  // namespace radioslam
