// Covariances of relative poses by radio links, before closures between robots join the graph.
#pragma once

#include <optional>

#include "radioslam/graph/marginals.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"

namespace radioslam {

template <class Pose>
struct RadioCovariance {
  Marginals<Pose> marginals;
  double temperature = 1;  ///< factor on covariances, since links share errors

  typename Pose::Jacobian relative_pose(PoseId i, PoseId j) const {
    return temperature * marginals.relative_pose(i, j);
  }
};

/// Nothing if the team was not placed by radio links or the estimate's covariances are singular.
template <class Pose>
std::optional<RadioCovariance<Pose>> radio_covariance(const JointGraph<Pose>& joint,
                                                      const TeamAlignment<Pose>& alignment,
                                                      const RadioAlignmentParams& params);

}  // namespace radioslam
