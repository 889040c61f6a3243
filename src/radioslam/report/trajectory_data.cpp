#include "radioslam/report/trajectory_data.hpp"

#include <algorithm>
#include <cstdint>

#include "radioslam/base/statistics.hpp"

namespace radioslam {
namespace {

std::size_t budget(int maximum) { return static_cast<std::size_t>(std::max(maximum, 2)); }

const RobotTruth* truth_of(const std::string& id, const Truth* truth) {
  if (truth == nullptr) return nullptr;
  for (const auto& robot : truth->robots)
    if (robot.id == id) return &robot;
  return nullptr;
}

const RobotMetrics* metrics_of(const std::string& id, const TeamMetrics* metrics) {
  if (metrics == nullptr) return nullptr;
  for (const auto& robot : metrics->robots)
    if (robot.id == id) return &robot;
  return nullptr;
}

PageData path_data(const Trajectory<SE3>& path, const std::vector<std::size_t>& kept, const SE3& T_page_path,
                   const TrajectoryContext& context) {
  PageData t = PageData::array(), x = t, y = t, z = t;
  for (const std::size_t i : kept) {
    const Eigen::Vector3d p = T_page_path * path[i].pose.translation();
    t.push_back(rounded_seconds(seconds_between(context.start, path[i].stamp)));
    x.push_back(rounded_metres(p.x()));
    y.push_back(rounded_metres(p.y()));
    z.push_back(rounded_metres(p.z()));
  }
  PageData data{{"t", std::move(t)}, {"x", std::move(x)}, {"y", std::move(y)}};
  if (context.dimension == 3) data["z"] = std::move(z);
  return data;
}

PageData error_data(const std::vector<PointError>& errors, const TrajectoryContext& context,
                    const ReportParams& params) {
  PageData t = PageData::array(), along = t, error = t, sigma = t;
  const std::size_t limit = part_of_budget(errors.size(), context.totals.errors, budget(params.max_errors));
  for (const std::size_t i : evenly_spaced(errors.size(), limit)) {
    t.push_back(rounded_seconds(seconds_between(context.start, errors[i].stamp)));
    along.push_back(rounded_metres(errors[i].along_m));
    error.push_back(rounded_metres(errors[i].error_m));
    if (errors[i].sigma_team_m) sigma.push_back(rounded_metres(*errors[i].sigma_team_m));
  }
  PageData data{{"t", std::move(t)}, {"along_m", std::move(along)}, {"error_m", std::move(error)}};
  if (!sigma.empty()) data["sigma_m"] = std::move(sigma);
  return data;
}

PageData sigma_data(const std::vector<double>& sigma_m, const std::vector<std::size_t>& kept) {
  PageData sigma = PageData::array();
  for (const std::size_t i : kept) sigma.push_back(rounded_metres(sigma_m[i]));
  return sigma;
}

void add_paths(PageData& data, const RobotResult& robot, const TrajectoryContext& context,
               const ReportParams& params) {
  const auto kept = drawn_keyframes(robot, context.totals, params);
  data["estimate"] = path_data(robot.estimate, kept, context.T_page_estimate, context);
  if (robot.sigma_position_m.size() == robot.estimate.size() && !robot.sigma_position_m.empty()) {
    data["sigma_m"] = sigma_data(robot.sigma_position_m, kept);
    data["sigma_team_m"] = sigma_data(robot.sigma_team_m, kept);
    data["sigma_median_m"] = rounded_metres(upper_median(robot.sigma_team_m));
  }
  const std::size_t poses = robot.odometry.size();
  const auto limit = part_of_budget(poses, context.totals.keyframes, budget(params.max_poses));
  data["odometry"] = path_data(robot.odometry, evenly_spaced(poses, limit), context.T_page_estimate, context);
}

PageData fixes_data(const FixResult& fixes) {
  return {{"used", fixes.used}, {"rejected", fixes.rejected}, {"unused", fixes.unused}};
}

void add_evaluation(PageData& data, const RobotResult& robot, const TrajectoryContext& context,
                    const ReportParams& params) {
  const Evaluation& evaluation = context.evaluation;
  if (const auto* truth = truth_of(robot.id, evaluation.truth); truth != nullptr && !truth->poses.empty()) {
    const std::size_t poses = truth->poses.size();
    const auto limit = part_of_budget(poses, context.totals.truth_poses, budget(params.max_poses));
    data["truth"] = path_data(truth->poses, evenly_spaced(poses, limit), SE3(), context);
  }
  if (const auto* metrics = metrics_of(robot.id, evaluation.estimate)) {
    data["ate"] = statistics_data(metrics->ate);
    data["coverage"] = rounded(metrics->coverage, 4);
    data["errors"] = error_data(metrics->errors, context, params);
  }
  if (const auto* metrics = metrics_of(robot.id, evaluation.dead_reckoning)) {
    data["dead_reckoning"] = statistics_data(metrics->ate);
    data["dead_reckoning_errors"] = error_data(metrics->errors, context, params);
  }
}

}  // namespace

TeamTotals count_totals(const RunResult& result, const Evaluation& evaluation) {
  TeamTotals totals;
  for (const auto& robot : result.robots) totals.keyframes += robot.estimate.size();
  if (evaluation.truth != nullptr)
    for (const auto& robot : evaluation.truth->robots) totals.truth_poses += robot.poses.size();
  if (evaluation.estimate != nullptr)
    for (const auto& robot : evaluation.estimate->robots) totals.errors += robot.errors.size();
  return totals;
}

std::vector<std::size_t> drawn_keyframes(const RobotResult& robot, const TeamTotals& totals,
                                         const ReportParams& params) {
  const std::size_t count = robot.estimate.size();
  return evenly_spaced(count, part_of_budget(count, totals.keyframes, budget(params.max_poses)));
}

PageData robot_data(const RobotResult& robot, std::size_t component, const TrajectoryContext& context,
                    const ReportParams& params) {
  const bool moves = !robot.estimate.empty();
  PageData data{{"id", robot.id},
                {"component", component},
                {"placed", robot.placed},
                {"keyframes", robot.estimate.size()},
                {"walked_m", rounded_metres(path_length_m(robot.estimate, context.dimension))},
                {"duration_s", moves ? rounded_seconds(seconds_between(robot.estimate.front().stamp,
                                                                       robot.estimate.back().stamp))
                                     : PageData(0.0)},
                {"yaw_drift_per_m_rad", rounded_relative(robot.yaw_drift_per_m_rad)},
                {"scale_error", rounded_relative(robot.scale_error)}};
  add_paths(data, robot, context, params);
  add_evaluation(data, robot, context, params);
  if (robot.fixes) data["fixes"] = fixes_data(*robot.fixes);
  return data;
}

double path_length_m(const Trajectory<SE3>& path, int dimension) {
  double length_m = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Eigen::Vector3d step = path[i].pose.translation() - path[i - 1].pose.translation();
    length_m += dimension == 2 ? step.head<2>().norm() : step.norm();
  }
  return length_m;
}

PageData statistics_data(const std::optional<ErrorStatistics>& statistics) {
  if (!statistics) return nullptr;
  return {{"rmse_m", rounded_metres(statistics->rmse_m)},
          {"mean_m", rounded_metres(statistics->mean_m)},
          {"median_m", rounded_metres(statistics->median_m)},
          {"p90_m", rounded_metres(statistics->p90_m)},
          {"count", statistics->count}};
}

}  // namespace radioslam
