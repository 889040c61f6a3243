// Groups of loops that agree with one another along the odometry, at both ends: they are right or wrong
// together. Agreement is that of the way round two loops and the odometry between their ends, which depends
// on no solution.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/joint/closures/loop_choice.hpp"

namespace radioslam {

template <class Pose>
class AgreeingLoops {
 public:
  /// Measurements are copied: solutions come and go.
  explicit AgreeingLoops(const LoopChoice<Pose>& choice);
  AgreeingLoops(const AgreeingLoops&) = delete;
  AgreeingLoops& operator=(const AgreeingLoops&) = delete;

  /// Each loop is in one group. Indices of loops.
  std::vector<std::vector<std::size_t>> groups();

  /// Squared norm of what the way round two loops and the odometry between their ends fails to close by;
  /// nothing across a gap.
  std::optional<double> disagreement(std::size_t a, std::size_t b) const;

 private:
  std::size_t low(std::size_t loop) const;
  std::size_t high(std::size_t loop) const;
  std::size_t root(std::size_t k);
  UncertainPose<Pose> measured(std::size_t loop) const;
  std::optional<UncertainPose<Pose>> way(std::size_t i, std::size_t j) const;
  bool agree(std::size_t a, std::size_t b) const;

  const LoopChoice<Pose> choice_;
  std::vector<const RelativePoseFactor<Pose>*> step_;  ///< to each pose from the one before it, or null
  std::vector<std::size_t> parent_;
};

}  // namespace radioslam
