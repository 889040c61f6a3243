// A run of the pipeline on a mission whose truth is known, in the few numbers that sweeps and tables need.
#pragma once

#include <optional>

#include "radioslam/eval/closures.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/pipeline/pipeline.hpp"

namespace radioslam {

struct JudgedRun {
  std::optional<double> ate_m;       ///< rmse of the likeliest team
  std::optional<double> best_ate_m;  ///< of the best one of it and the alternatives
  double weight = 1;                 ///< of the likeliest team
  double coverage = 0;               ///< of the truth's poses, by the likeliest team
  PairCounts candidates;             ///< true: nearer than the sum of the two LiDAR ranges
  double distances_evaluated = 0;
  double search_s = 0;  ///< the overlap search, with its covariances
  double total_s = 0;   ///< all stages
};

/// Share of the true pairs that were kept; nothing where there are none.
std::optional<double> recall(const PairCounts& counts);
/// Share of the false pairs that were not kept; nothing where there are none.
std::optional<double> false_rejected(const PairCounts& counts);

JudgedRun run_and_judge(const Mission& mission, const Truth& truth, const RunParams& params,
                        const RunOptions& options);

/// Of odometry alone, every robot from its known start; nothing where a start is unknown.
std::optional<double> dead_reckoning_ate_m(const Mission& mission, const Truth& truth);

/// RMSE after one rigid alignment of the whole team; nothing where nothing can be compared.
std::optional<double> ate_rmse_m(const std::vector<EstimatedTrajectory>& estimate, const Truth& truth,
                                 int dimension);

}  // namespace radioslam
