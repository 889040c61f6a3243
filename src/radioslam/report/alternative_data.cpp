#include "radioslam/report/alternative_data.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/report/thinning.hpp"

namespace radioslam {
namespace {

PageData path(const Trajectory<SE3>& poses, std::size_t limit, const TrajectoryContext& context) {
  PageData x = PageData::array(), y = x, z = x;
  for (const std::size_t k : evenly_spaced(poses.size(), limit)) {
    const Eigen::Vector3d p = context.T_page_estimate * poses[k].pose.translation();
    x.push_back(rounded(p.x(), 2));
    y.push_back(rounded(p.y(), 2));
    z.push_back(rounded(p.z(), 2));
  }
  PageData data{{"x", std::move(x)}, {"y", std::move(y)}};
  if (context.dimension == 3) data["z"] = std::move(z);
  return data;
}

std::size_t poses_of_all(const std::vector<HypothesisResult>& alternatives) {
  std::size_t poses = 0;
  for (const HypothesisResult& other : alternatives)
    for (const RobotResult& robot : other.robots) poses += robot.estimate.size();
  return poses;
}

}  // namespace

PageData alternative_data(const RunResult& result, const TrajectoryContext& context,
                          const ReportParams& params) {
  const auto budget = static_cast<std::size_t>(std::max(params.max_alternative_poses, 2));
  const std::size_t total = poses_of_all(result.alternatives);
  PageData list = PageData::array();
  for (const HypothesisResult& other : result.alternatives) {
    PageData robots = PageData::array();
    for (const RobotResult& robot : other.robots)
      robots.push_back(path(robot.estimate, part_of_budget(robot.estimate.size(), total, budget), context));
    PageData data{{"weight", rounded(other.weight, 4)}, {"robots", std::move(robots)}};
    if (const Truth* truth = context.judgement.truth) {
      const auto metrics =
          evaluate_trajectories(team_estimate(other.robots, result), *truth, context.dimension);
      data["ate_rmse_m"] = metrics.ate ? rounded_metres(metrics.ate->rmse_m) : PageData();
    }
    list.push_back(std::move(data));
  }
  return list;
}

}  // namespace radioslam
