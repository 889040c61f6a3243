// Page data of one robot: its paths, uncertainty and errors, thinned to the budget.
#pragma once

#include <string>
#include <vector>

#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Truth, metrics and dead reckoning; all three are present, or none.
struct Evaluation {
  const Truth* truth = nullptr;
  const TeamMetrics* estimate = nullptr;
  const TeamMetrics* dead_reckoning = nullptr;
};

/// Numbers of poses and errors over all robots, between which budgets are divided.
struct TeamTotals {
  std::size_t keyframes = 0;
  std::size_t truth_poses = 0;
  std::size_t errors = 0;
};
TeamTotals count_totals(const RunResult& result, const Evaluation& evaluation);

/// Data common to all robots of a page.
struct TrajectoryContext {
  int dimension = 2;
  Stamp start;
  SE3 T_page_estimate;  ///< into the page's frame
  TeamTotals totals;
  Evaluation evaluation;
};

/// The drawn keyframes of a robot, as indices into its estimate.
std::vector<std::size_t> drawn_keyframes(const RobotResult& robot, const TeamTotals& totals,
                                         const ReportParams& params);

/// The robot's object; `component` is its index in RunResult::components.
PageData robot_data(const RobotResult& robot, std::size_t component, const TrajectoryContext& context,
                    const ReportParams& params);

/// Length of a path in metres.
double path_length_m(const Trajectory<SE3>& path, int dimension);

/// {"rmse_m", "mean_m", "median_m", "p90_m", "count"}, or null.
PageData statistics_data(const std::optional<ErrorStatistics>& statistics);

}  // namespace radioslam
