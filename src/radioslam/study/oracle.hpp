// The best that could be asked of an estimate: maximum likelihood told which paths are direct, started from
// the truth. Every range counts fully, every angle measurement has its labelled direct path and no other, and
// the optimiser starts where the robots really were, so neither a wrong path nor a wrong minimum can spoil
// it. What is left is the noise. Matches take no part.
//
// Frame: the truth's, as far as the links tell. Cost: one optimisation of the joint graph.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/pipeline/params.hpp"

namespace radioslam {

/// The mission as it would be if every receiver knew: measurements with a labelled direct path keep that
/// path alone, the others are gone, and so are the matches.
Mission with_direct_paths_only(const Mission& mission, const Truth& truth);

/// Keyframes of every robot, by `params`' keyframes and graph; converges to the optimiser's own defaults.
/// Nothing where the truth does not cover the odometry, has no orientation, or leaves an anchor's place open.
std::optional<std::vector<EstimatedTrajectory>> oracle_estimate(const Mission& mission, const Truth& truth,
                                                                const RunParams& params);

}  // namespace radioslam
