#include "radioslam/cli/commands/evaluated_estimate.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
#include <variant>

#include "radioslam/cli/commands/evaluation.hpp"
#include "radioslam/graph/gauge.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam::cli {
namespace {

constexpr std::uint64_t kMaxIndex = 9'000'000'000;  // seconds that fit into a stamp

bool is_g2o(const std::string& path) {
  const std::filesystem::path file(path);
  return (has_zstd_extension(file) ? file.stem() : file).extension() == ".g2o";
}

template <class Pose>
std::size_t count_parts(const PoseGraph<Pose>& graph) {
  std::vector<std::int32_t> first = connected_components(graph).of_pose;
  std::sort(first.begin(), first.end());
  return static_cast<std::size_t>(std::unique(first.begin(), first.end()) - first.begin());
}

template <class Pose>
EvaluatedEstimate estimate_in(const G2oGraph<Pose>& file, const Text& text) {
  EvaluatedEstimate estimate;
  estimate.dimension = Pose::kDim;
  std::map<std::string, std::map<std::uint64_t, SE3>> robots;
  for (std::size_t k = 0; k < file.pose_ids.size(); ++k) {
    const PoseIndex at = place_of_key(file.pose_ids[k]);
    if (!file.pose_has_value[k]) continue;
    if (at.place > kMaxIndex)
      text.fail(0, "vertex " + std::to_string(file.pose_ids[k]) + " is no index along a trajectory");
    robots[at.robot].emplace(at.place, as_se3(file.graph.poses[k], 0));
  }
  if (robots.empty()) text.fail(0, "has no VERTEX lines of poses");
  for (const auto& [id, poses] : robots) {
    std::vector<StampedPose<SE3>> rows;
    for (const auto& [place, pose] : poses)
      rows.push_back({Stamp::from_seconds(static_cast<double>(place)), pose});
    estimate.run.robots.push_back({id, Trajectory<SE3>(std::move(rows))});
  }
  if (const std::size_t parts = count_parts(file.graph); parts > 1)
    estimate.notes.push_back(text.name + ": no edges tie its " + std::to_string(parts) +
                             " parts together; they are compared as if they had one frame");
  return estimate;
}

int dimension_of(const RunFolder& run) {
  const auto found = run.summary.is_object() ? run.summary.find("dimension") : run.summary.end();
  return found != run.summary.end() && *found == 2 ? 2 : 3;
}

Mission mission_of(const EvaluatedEstimate& estimate) {
  Mission mission;
  mission.dimension = estimate.dimension;
  for (const EstimatedTrajectory& robot : estimate.run.robots) mission.robots.emplace_back().id = robot.id;
  return mission;
}

RobotTruth& truth_of(const std::string& id, const EvaluatedEstimate& estimate, Truth& truth) {
  const auto is_it = [&](const RobotTruth& robot) { return robot.id == id; };
  const auto found = std::find_if(truth.robots.begin(), truth.robots.end(), is_it);
  if (found != truth.robots.end()) return *found;
  std::string names;
  for (const EstimatedTrajectory& robot : estimate.run.robots)
    names += (names.empty() ? "" : ", ") + robot.id;
  throw InputError("--truth", 0, "robot '" + id + "' is not in the estimate, whose robots are " + names);
}

}  // namespace

EvaluatedEstimate read_estimate(const std::string& path) {
  if (is_g2o(path)) {
    const Text text = read_zstd_text(path);
    const AnyG2oGraph graph = read_g2o(text, RepairInformation::kYes, BadLines::kSkip);
    return std::visit([&](const auto& file) { return estimate_in(file, text); }, graph);
  }
  EvaluatedEstimate estimate{read_run(path), 3, {}};
  estimate.dimension = dimension_of(estimate.run);
  estimate.notes = frame_notes(estimate.run.robots, estimate.run.components, estimate.run.unplaced);
  if (estimate.run.summary.is_null())
    estimate.notes.push_back(path +
                             " has no summary.json: every .tum file is taken as a robot, all in one frame");
  return estimate;
}

void use_given_truth(const std::vector<std::string>& truths, const EvaluatedEstimate& estimate,
                     MissionInput& input) {
  if (input.mission.robots.empty()) input.mission = mission_of(estimate);
  if (input.truth.robots.empty())
    for (const Robot& robot : input.mission.robots) input.truth.robots.emplace_back().id = robot.id;
  for (const std::string& given : truths) {
    const std::size_t sign = given.find('=');
    if (sign == std::string::npos || sign == 0 || sign + 1 == given.size())
      throw InputError("--truth", 0, "'" + given + "' is not ROBOT=FILE");
    RobotTruth& truth = truth_of(given.substr(0, sign), estimate, input.truth);
    truth = read_robot_truth(given.substr(sign + 1), truth.id);
  }
}

}  // namespace radioslam::cli
