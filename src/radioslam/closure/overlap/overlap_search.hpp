// Overlap search: all pairs of poses of different robots whose views could overlap: touch, or share a given
// part of their area. The result is exactly that of testing every pair, by branch and bound over both robots'
// trees of pose intervals (overlap_tree.hpp), which excludes or accepts whole pairs of intervals
// (overlap_bounds.hpp). Source: Wi-Closure (Wang et al., III-B), which splits boxes with one global bound.
//
// Frame k is that of the robot listed first. Robots without any connection have no candidates. Cost:
// near-linear in poses plus pairs kept for crossing trajectories; n_a n_b if every pair is close. The output
// is independent of the number of threads: the first levels are expanded breadth-first into a fixed number of
// tasks.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/overlap/overlap_distance.hpp"
#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/closure/overlap/overlap_tree.hpp"
#include "radioslam/closure/overlap/overlap_view.hpp"

namespace radioslam {

// Parameters, inputs and results of the overlap search.

struct OverlapParams {
  double max_mahalanobis = 1.5;      ///< D
  double min_shared_view = 0;        ///< intersection over union; 0: the views touch (overlap_view.hpp)
  std::string distance = "minimum";  ///< minimum: d_min; seed: d* (overlap_distance.hpp)

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(max_mahalanobis, "", 0.001, 1000,
                          "largest distance of two views from overlapping, in standard deviations; higher "
                          "values keep more pairs");
    RADIOSLAM_BASIC_FIELD(min_shared_view, "", 0, 1,
                          "smallest intersection over union of two views that overlap; 0: they touch; 0.18: "
                          "two scanners of 30 m within 35 m");
    RADIOSLAM_FIELD(distance, "", 0, 0,
                    "kind of overlap distance; minimum: to the nearest point (Mahalanobis metric); seed: "
                    "along the line of sight, reproduces Wi-Closure (Wang et al.)",
                    "minimum|seed");
  }
};

inline OverlapDistance overlap_distance(const OverlapParams& params) {
  return params.distance == "seed" ? OverlapDistance::kLineOfSight : OverlapDistance::kMinimum;
}

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

/// Of two robots.
void sort_by_poses(std::vector<OverlapCandidate>& candidates);

enum class SearchMethod {
  kTree,
  kExhaustive,   ///< tests every pair; same result
  kDistributed,  ///< the tree search by messages between robots (overlap_exchange.hpp); same result
};

/// Receives the candidates of two robots, sorted by their poses.
using TakeOverlaps = std::function<void(std::vector<OverlapCandidate>)>;

/// A team's search, one robot at a time: a large team's candidates are too many to hold at once. `Source`:
/// LinkCovariance or JointCovariance of SE2 or SE3. Refers to the source.
template <OverlapSource Source>
class TeamOverlapSearch {
 public:
  /// One sensor per robot.
  TeamOverlapSearch(const Source& source, std::vector<OverlapSensor> sensors, const OverlapParams& params,
                    SearchMethod method);

  /// Searches robot a against every robot listed later, and hands over the candidates pair of robots by pair
  /// of robots.
  OverlapCounts search(std::uint32_t a, const TakeOverlaps& take) const;

 private:
  using Poses = typename Source::Poses;
  using View = typename Poses::View;
  using Tree = OverlapTree<typename View::Pose>;

  const Source& source_;
  std::vector<OverlapSensor> sensors_;
  OverlapParams params_;
  SearchMethod method_;
  std::vector<Tree> trees_;  ///< of all poses of each robot but the first
};

/// The whole team's, in one list.
template <OverlapSource Source>
OverlapCandidates search_overlaps(const Source& source, const std::vector<OverlapSensor>& sensors,
                                  const OverlapParams& params);
/// The same results by testing every pair.
template <OverlapSource Source>
OverlapCandidates search_overlaps_exhaustively(const Source& source,
                                               const std::vector<OverlapSensor>& sensors,
                                               const OverlapParams& params);

}  // namespace radioslam
