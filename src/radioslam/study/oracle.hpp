// Oracle estimate, a lower bound on the error: maximum likelihood with known direct paths, started from the
// truth and, where one is given, from an estimate; the likelier result counts.
//
// Every range has full weight, every angle measurement contains only its labelled direct path, and the
// optimizer starts at the true poses, so that neither outliers nor local minima matter and only noise
// remains. With few links the true poses may still lie beside a local minimum, hence the second start.
// Matches are not used. Frame: the truth's or the estimate's, as far as it is observable. Cost: one
// optimization of the joint graph per start.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/pipeline/params.hpp"

namespace radioslam {

/// The mission with known direct paths: angle measurements with a labelled direct path keep only that, the
/// others and all matches are removed.
Mission with_direct_paths_only(const Mission& mission, const Truth& truth);

/// Keyframes of every robot, by `params`' keyframes and graph; with the optimizer's own default tolerances.
/// `other_start` is used if it covers the odometry of every robot. Nothing if the truth does not cover the
/// odometry, has no orientation, or leaves an anchor's position unknown.
std::optional<std::vector<EstimatedTrajectory>> oracle_estimate(
    const Mission& mission, const Truth& truth, const RunParams& params,
    const std::vector<EstimatedTrajectory>& other_start = {});

}  // namespace radioslam
