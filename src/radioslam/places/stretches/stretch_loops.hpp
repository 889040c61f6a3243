// Loop closures of a robot with a planar scanner, between stretches of its way.
//
// A single planar scan sees little: looking back along a corridor it shares nothing with one that looked
// ahead. So stretches are compared, of scans that odometry joins, by the grids of what they saw.
//
//   proposed   for a stretch j, all poses that the estimate holds possible on the grids of all earlier
//              stretches, by branch and bound over all of them at once (stretch_search.hpp). How far the
//              estimate may be off decides how many stretches these are, and nothing else
//   refined    by registration of the scans' surfels
//   tested     against what is free: where both saw, what is occupied on the one is so on the other, as
//              often as with successive stretches of this drive; and against each other, by how well they fit
//              and by how likely they were, as in loop_verification.hpp
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/places/loops/expected_place.hpp"
#include "radioslam/places/loops/loop_candidates.hpp"
#include "radioslam/places/loops/loop_verification.hpp"
#include "radioslam/places/stretches/stretch_search.hpp"

namespace radioslam {

class StretchLoops {
 public:
  static constexpr double kHalf_m = 10;  ///< path length of a stretch to either side of its middle

  /// Keeps references to all of them, which must outlive it.
  StretchLoops(const ScanKeyframes& keyframes, const LoopCandidates& candidates,
               const LoopVerification& registration, const ScanLoopParams& params);

  /// Whether these keyframes are so far apart on the way that stretches around them share no scan.
  bool covers(std::size_t i, std::size_t j) const;
  /// By this estimate, that of the candidates' last search. Stretches near an accepted closure of `known` are
  /// left out, and those tried before unless they are predicted much better now.
  std::vector<ScanLoop> find(const PlacedKeyframes& robot, const std::vector<ScanLoop>& known);

 private:
  struct Target {
    std::size_t anchor;        ///< index of the stretch
    UncertainPose<SE3> T_i_j;  ///< predicted
  };
  struct Fit {
    const Target* target = nullptr;
    SE2 T_i_j;
    StretchLikeness likeness;
    double likelihood = 0;  ///< relative to the best
    double weight = 0;      ///< with the prediction
  };

  std::vector<Target> targets_of(std::size_t source, const std::vector<SE3>& poses) const;
  ScanLoop closure_of(std::size_t source, const PlacedKeyframes& robot,
                      const std::vector<Target>& targets) const;
  /// The places where it fits.
  std::vector<Fit> fits_of(std::size_t source, const PlacedKeyframes& robot,
                           const std::vector<Target>& targets) const;
  /// Sorts them by weight.
  void weigh(std::vector<Fit>& fits) const;
  double doubt_of(const std::vector<Fit>& weighed, double range_m) const;
  /// Median of stretches one after the other.
  double nominal_agreement() const;

  const ScanKeyframes& keyframes_;
  const LoopCandidates& candidates_;
  const LoopVerification& registration_;
  ScanLoopParams params_;
  std::vector<std::size_t> anchors_;  ///< keyframes in the middle of stretches
  std::vector<std::unique_ptr<const StretchGrid>> grids_;
  double nominal_ = 1;
  std::map<std::size_t, double> tried_;  ///< per stretch, the standard deviation then
};

}  // namespace radioslam
