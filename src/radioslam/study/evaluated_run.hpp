// Evaluated run: runs the pipeline on a mission with known truth and reduces it to the figures of studies.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/eval/closures.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/pipeline/pipeline.hpp"

namespace radioslam {

struct EvaluatedRun {
  std::optional<double> ate_m;       ///< RMSE of the most likely hypothesis
  std::optional<double> best_ate_m;  ///< RMSE of the best hypothesis
  double weight = 1;                 ///< of the most likely hypothesis
  double coverage = 0;               ///< ratio of the true poses covered by the most likely hypothesis
  PairCounts candidates;             ///< true: the views overlap by the run's own min_shared_view
  double distances_evaluated = 0;
  double search_s = 0;                        ///< the overlap search, with its covariances
  double total_s = 0;                         ///< all stages
  std::vector<EstimatedTrajectory> estimate;  ///< of the most likely hypothesis
};

/// Ratio of the true pairs that were kept; nothing if there are none.
std::optional<double> recall(const PairCounts& counts);
/// Ratio of the false pairs that were rejected; nothing if there are none.
std::optional<double> rejected_false(const PairCounts& counts);

EvaluatedRun run_and_evaluate(const Mission& mission, const Truth& truth, const RunParams& params,
                              const RunOptions& options);
/// The same from what recordings measured; the time that took is not in it.
EvaluatedRun run_and_evaluate(const Mission& mission, const MeasuredRecordings& recordings,
                              const Truth& truth, const RunParams& params, const RunOptions& options);

/// The mission without its ranges and angles.
Mission without_radio(const Mission& mission);

/// ATE of odometry alone, every robot from its known start; nothing if a start is unknown.
std::optional<double> dead_reckoning_ate_m(const Mission& mission, const Truth& truth);

/// RMSE after one rigid alignment of the whole team; nothing if there is nothing to compare.
std::optional<double> ate_rmse_m(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                 int dimension);

}  // namespace radioslam
