// One robot on the page: its paths, its uncertainty and its errors, thinned to the budget.
#pragma once

#include <string>
#include <vector>

#include "radioslam/report/page_data.hpp"

namespace radioslam {

/// What the run is judged by; all three are there, or none.
struct Judgement {
  const Truth* truth = nullptr;
  const TeamMetrics* estimate = nullptr;
  const TeamMetrics* dead_reckoning = nullptr;
};

/// How many poses and errors there are over all robots: what the budgets are shared by.
struct TeamTotals {
  std::size_t keyframes = 0;
  std::size_t truth_poses = 0;
  std::size_t errors = 0;
};
TeamTotals count_totals(const RunResult& result, const Judgement& judgement);

/// Everything the robots of a page have in common.
struct TrajectoryContext {
  int dimension = 2;
  Stamp start;
  SE3 T_page_estimate;  ///< into the frame the page is drawn in
  TeamTotals totals;
  Judgement judgement;
};

/// The keyframes of a robot that are drawn, as indices into its estimate.
std::vector<std::size_t> drawn_keyframes(const RobotResult& robot, const TeamTotals& totals,
                                         const ReportParams& params);

/// The robot's object; `component` is its place in RunResult::components.
PageData robot_data(const RobotResult& robot, std::size_t component, const TrajectoryContext& context,
                    const ReportParams& params);

/// Metres walked along a path.
double path_length_m(const Trajectory<SE3>& path, int dimension);

/// {"rmse_m", "mean_m", "median_m", "p90_m", "count"}, or null.
PageData statistics_data(const std::optional<ErrorStatistics>& statistics);

}  // namespace radioslam
