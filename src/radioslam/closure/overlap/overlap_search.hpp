// Overlap search: all pairs of poses of different robots whose views could overlap. The result is exactly
// that of testing every pair, by branch and bound over both robots' trees of pose intervals
// (overlap_tree.hpp), which excludes or accepts whole pairs of intervals (overlap_bounds.hpp). Source:
// Wi-Closure (Wang et al., III-B), which splits boxes with one global bound.
//
// Frame k is that of the robot listed first. Robots without any connection have no candidates. Cost:
// near-linear in poses plus pairs kept for crossing trajectories; n_a n_b if every pair is close. The output
// is independent of the number of threads: the first levels are expanded breadth-first into a fixed number of
// tasks.
#pragma once

#include <functional>
#include <vector>

#include "radioslam/closure/overlap/overlap_joint.hpp"
#include "radioslam/closure/overlap/overlap_link.hpp"
#include "radioslam/closure/overlap/overlap_params.hpp"
#include "radioslam/closure/overlap/overlap_tree.hpp"

namespace radioslam {

enum class SearchMethod {
  kTree,
  kExhaustive,  ///< tests every pair; same result
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
  using Tree = OverlapTree<typename Source::View::Pose>;

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
