// Where a scan of one robot is expected among another's keyframes, by the team's estimate and by the other
// likely alignments.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/places/closure_worth.hpp"
#include "radioslam/joint/places/proposal.hpp"
#include "radioslam/joint/places/scanned_robot.hpp"
#include "radioslam/joint/team_estimate.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

template <class Pose>
class PlacePredictions {
 public:
  using Poses = std::vector<Pose>;

  /// Keeps a reference to `team`, which must outlive it.
  PlacePredictions(const TeamEstimate<Pose>& team, const RadioAlignmentParams& params);

  /// False where the graph leaves poses open.
  bool exist() const { return marginals_.has_value(); }
  /// The number of other alignments that are searched, too.
  std::size_t others() const;

  /// Of the robot's scanned keyframe k.
  SE3 pose(const Poses& poses, const ScannedRobot& robot, std::size_t k) const {
    return as_se3(poses[robot.nodes[k].index()], 0) * robot.T_node_scan[k];
  }
  /// Of j in the frame of i; its covariance is that of the graph's own alignment.
  UncertainPose<SE3> relative_pose(const Poses& poses, const std::vector<ScannedRobot>& robots,
                                   const Proposal& pair) const;
  /// The same by the alignments that are searched, but for the pair's own.
  std::vector<ExpectedPlace::Alternative> by_others(const std::vector<ScannedRobot>& robots,
                                                    const Proposal& pair) const;
  /// Nothing unless they exist.
  std::optional<PredictedPoses<Pose>> of_graph() const;

 private:
  const TeamEstimate<Pose>& team_;
  std::optional<Marginals<Pose>> marginals_;
  double temperature_ = 1;
};

}  // namespace radioslam
