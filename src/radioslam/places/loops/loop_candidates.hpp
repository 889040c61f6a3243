// Candidates for intra-robot loop closures: keyframe pairs that may have seen the same place.
//
// A candidate is the nearest keyframe of every earlier segment of the trajectory that may pass a keyframe:
// its distance, less `sigmas` standard deviations of their relative position, is below a radius.
// Cost: the graph's marginals, and all pairs of keyframes by their distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/graph/marginals.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/places/keyframe_contexts.hpp"
#include "radioslam/places/loops/scan_loop.hpp"

namespace radioslam {

/// A keyframe pair to try, with the current estimate of its relative pose; i is the earlier one.
struct LoopCandidate {
  std::size_t i = 0, j = 0;
  UncertainPose<SE3> T_i_j;
};

/// Pairs of keyframes that were tried, with the standard deviation of their relative position then; 0: never
/// again.
using TriedPairs = std::map<std::pair<std::size_t, std::size_t>, double>;

class LoopCandidates {
 public:
  /// Keeps a reference to `keyframes`, which must outlive it. `tried`: of the same keyframes before.
  LoopCandidates(const ScanKeyframes& keyframes, const ScanLoopParams& params, TriedPairs tried = {})
      : keyframes_(keyframes), params_(params), path_m_(path_lengths(keyframes)), tried_(std::move(tried)) {}

  /// By this estimate of the keyframes' poses. Pairs that were candidates before are left out unless they
  /// were doubtful and are predicted much better now.
  std::vector<LoopCandidate> find(const PoseGraph<SE3>& graph);
  /// Leaves all but the `most` of greatest worth of what the last search found, with this estimate, to another
  /// one; whether there were any. Those that would join parts of the trajectory come first.
  bool leave_out(std::size_t most, const PoseGraph<SE3>& graph, std::vector<LoopCandidate>& found);
  /// Standard deviation of the relative position of two keyframes, by the estimate of the last search. Of one
  /// `i` with many `j` it costs one solution. Thread-safe.
  double sigma_m(std::size_t i, std::size_t j) const;
  /// Covariance of keyframe j's pose relative to each, the earlier one first, by the estimate of the last
  /// search; at the cost of one solution.
  std::vector<SE3::Jacobian> covariances_with(std::size_t j) const;
  /// Whether the last search had an estimate with covariances.
  bool has_covariances() const { return marginals_.has_value(); }
  /// What came of a candidate.
  void note(const ScanLoop& tried);
  const std::vector<double>& path_m() const { return path_m_; }
  const TriedPairs& tried() const { return tried_; }

 private:
  double radius_of(std::size_t k) const {
    return params_.radius_ratio * keyframes_.clouds[k].median_range_m();
  }
  /// The nearest keyframe of every earlier segment of the trajectory that may pass keyframe j.
  std::vector<std::size_t> revisits(std::size_t j, const std::vector<SE3>& poses) const;
  /// Of their relative pose; of keyframes in parts of the trajectory that nothing joins, by what they may
  /// have moved in between, with any orientation. `in_one_part`: if they are in the same.
  SE3::Jacobian relative_covariance(std::size_t i, std::size_t j, const SE3::Jacobian& in_one_part) const;
  std::shared_ptr<const std::vector<double>> sigmas_with(std::size_t i) const;
  /// Standard deviation of the motions between two keyframes that nothing measured.
  double unknown_motion_m(std::size_t i, std::size_t j) const;
  bool is_candidate(const UncertainPose<SE3>& T_i_j, double radius_m) const;

  const ScanKeyframes& keyframes_;
  ScanLoopParams params_;
  std::vector<double> path_m_;
  std::optional<Marginals<SE3>> marginals_;
  mutable std::mutex sigmas_mutex_;
  mutable std::map<std::size_t, std::shared_ptr<const std::vector<double>>>
      sigmas_;                         ///< of the last asked for
  std::vector<std::int32_t> part_of_;  ///< per keyframe, the part of the trajectory that holds together
  TriedPairs tried_;
};

}  // namespace radioslam
