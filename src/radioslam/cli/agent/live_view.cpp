#include "radioslam/cli/agent/live_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/joint/uncertainty/position_uncertainty.hpp"
#include "radioslam/pipeline/collect_results.hpp"
#include "radioslam/pipeline/run_results.hpp"

namespace radioslam::cli {
namespace {

constexpr double kVoxel_m = 0.4;
constexpr std::size_t kMostOfCloud = 200, kCloudsAtOnce = 20;

/// One point a voxel, about the keyframe and turned by its heading alone.
std::vector<Eigen::Vector3f> thinned(const ScanPyramid& scan, const SE3& T_frame_body) {
  const Eigen::AngleAxisd level(-T_frame_body.yaw(), Eigen::Vector3d::UnitZ());
  const Eigen::Matrix3f R = (level.toRotationMatrix() * T_frame_body.rotation()).cast<float>();
  std::set<std::array<int, 3>> voxels;
  std::vector<Eigen::Vector3f> points;
  for (const Surfel& surfel : scan.all) {
    const Eigen::Vector3f at = R * surfel.position;
    const Eigen::Array3i voxel = (at.array() / static_cast<float>(kVoxel_m)).floor().cast<int>();
    if (voxels.insert({voxel[0], voxel[1], voxel[2]}).second) points.push_back(at);
  }
  const std::size_t stride = points.size() / kMostOfCloud + 1;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points.size(); k += stride) points[kept++] = points[k];
  points.resize(kept);
  return points;
}

/// Null where its temporary file cannot be read; the page does without it.
std::shared_ptr<const ScanPyramid> read(const StoredCloud& cloud) {
  try {
    return cloud.read();
  } catch (const InputError&) {
    return nullptr;
  }
}

std::optional<std::size_t> place_of(const std::vector<Stamp>& stamps, Stamp stamp) {
  const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp);
  if (found == stamps.end() || *found != stamp) return std::nullopt;
  return static_cast<std::size_t>(found - stamps.begin());
}

SE3 flattened(const SE3& pose, int dimension) { return dimension == 2 ? in_dimension<SE2>(pose) : pose; }

}  // namespace

template <class Pose>
void LiveView::solve(const TeamSolution<Pose>& solution) {
  const JointGraph<Pose>& joint = solution.team.joint;
  std::vector<RobotResult> robots = collect_robots(joint, joint.team.graph.poses, solution.team.alignment);
  const auto graph = graph_for_covariances(joint, params_.alignment.mixture).team.graph;
  if (const auto marginals = Marginals<Pose>::compute(graph)) {
    add_uncertainty(robots, joint, solution.team.alignment, *marginals);
    widen_by_unknown_motions(robots, joint, *marginals);
  }
  solved_.clear();
  for (std::size_t r = 0; r < joint.robots.size(); ++r) {
    const RobotVariables& robot = joint.robots[r];
    Solved& of = solved_[robot.id];
    of.stamps = robot.stamps;
    for (const PoseId at : robot.poses) of.poses.push_back(as_se3(joint.team.graph.poses[at.index()], 0));
    if (!robots[r].sigma_position_m.empty()) of.sigma_m = robots[r].sigma_position_m.back();
    if (!robots[r].sigma_team_m.empty()) of.sigma_team_m = robots[r].sigma_team_m.back();
  }
  lines_.clear();
  counts_.clear();
  const bool is_weighed = joint.bearing_weights.size() == joint.team.bearings.size();
  if (!is_weighed) return;
  for (ClosureResult& closure : collect_all_closures(solution.team)) {
    if (!closure.robot_i.valid() || !closure.robot_j.valid()) continue;
    ++counts_[{closure.kind, closure.status}];
    const std::string &i = joint.robots[closure.robot_i.index()].id,
                      &j = joint.robots[closure.robot_j.index()].id;
    lines_.push_back({std::move(closure), i, j});
  }
  std::stable_sort(lines_.begin(), lines_.end(), [](const Line& a, const Line& b) {
    return std::max(a.closure.stamp_i, a.closure.stamp_j) < std::max(b.closure.stamp_i, b.closure.stamp_j);
  });
}

/// The solution, if it is another one.
void LiveView::take(const AgentView& view) {
  std::visit(
      [&](const auto& solution) {
        if (!solution || solution.get() == solution_) return;
        using Solution = std::decay_t<decltype(*solution)>;
        dimension_ = std::is_same_v<Solution, TeamSolution<SE2>> ? 2 : 3;
        solve(*solution);
        held_ = solution;  // so that no other one is at its place
        solution_ = solution.get();
        const auto own = solved_.find(view.team.self);
        if (own != solved_.end() && own->second.sigma_m && own->second.sigma_team_m)
          sigmas_.push_back({own->second.stamps.back(), *own->second.sigma_m, *own->second.sigma_team_m});
      },
      view.solution);
}

std::size_t LiveView::number_of(const std::string& robot) {
  const auto found = std::find(names_.begin(), names_.end(), robot);
  if (found != names_.end()) return static_cast<std::size_t>(found - names_.begin());
  names_.push_back(robot);
  return names_.size() - 1;
}

LiveRobot LiveView::place(const AgentView::Robot& robot, int dimension) const {
  LiveRobot placed{
      .id = robot.id, .frame = robot.frame.frame, .poses = {}, .sigma_m = {}, .sigma_team_m = {}};
  const auto add = [&](Stamp stamp, const SE3& pose) {
    placed.poses.push_back({stamp, pose.translation(), pose.yaw()});
  };
  std::size_t begin = 0;
  const auto solved = solved_.find(robot.id);
  if (solved != solved_.end() && !solved->second.poses.empty() && !robot.said.empty()) {
    const Solved& of = solved->second;
    // The solution as the published frame has it; they are one but for frames that are not the solution's
    // own.
    const SE3 T_frame_solution =
        robot.frame.T_frame_start * flattened(robot.said.front().pose, dimension) * of.poses.back().inverse();
    for (std::size_t k = 0; k < of.poses.size(); ++k) add(of.stamps[k], T_frame_solution * of.poses[k]);
    placed.sigma_m = of.sigma_m;
    placed.sigma_team_m = of.sigma_team_m;
    begin = 1;
  }
  for (std::size_t k = begin; k < robot.said.size(); ++k)
    add(robot.said[k].stamp, robot.frame.T_frame_start * flattened(robot.said[k].pose, dimension));
  return placed;
}

/// Of each kind and status all, or every second, or fourth ...
void LiveView::add_lines(LiveTeam& team) const {
  team.closures = counts_;
  std::size_t stride = 1;
  while (lines_.size() / stride > kMostLines) stride *= 2;
  std::map<std::pair<ClosureKind, ClosureStatus>, std::size_t> seen;
  for (const Line& line : lines_) {
    const ClosureResult& closure = line.closure;
    if (seen[{closure.kind, closure.status}]++ % stride != 0) continue;
    const auto i = place_of(solved_.at(line.robot_i).stamps, closure.stamp_i);
    const auto j = place_of(solved_.at(line.robot_j).stamps, closure.stamp_j);
    const auto number = [&](const std::string& robot) {
      return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), robot) - names_.begin());
    };
    if (i && j)
      team.lines.push_back(
          {closure.kind, closure.status, number(line.robot_i), *i, number(line.robot_j), *j});
  }
}

/// False where its keyframe is not shown yet.
bool LiveView::show_cloud(const AgentView::Cloud& cloud, const LiveTeam& team) {
  const std::size_t robot = number_of(cloud.robot);
  if (robot >= team.robots.size()) return false;
  const auto& poses = team.robots[robot].poses;
  const auto at = std::lower_bound(poses.begin(), poses.end(), cloud.keyframe,
                                   [](const LivePose& pose, Stamp stamp) { return pose.stamp < stamp; });
  if (at == poses.end() || at->stamp != cloud.keyframe) return false;
  const auto last = last_cloud_.find(cloud.robot);
  if (last != last_cloud_.end() && (last->second - at->position_m).norm() < kCloudStride_m) return true;
  last_cloud_[cloud.robot] = at->position_m;
  const auto scan = read(cloud.points);
  if (!scan) return true;
  const auto solved = solved_.find(cloud.robot);
  const auto k = solved == solved_.end() ? std::nullopt : place_of(solved->second.stamps, cloud.keyframe);
  const SE3 pose = k ? solved->second.poses[*k] : SE3();
  auto shown = std::make_shared<LiveCloud>();
  shown->robot = robot;
  shown->keyframe = cloud.keyframe;
  shown->points = thinned(*scan, pose);
  points_ += shown->points.size();
  clouds_.push_back(std::move(shown));
  return true;
}

/// A few at a time; beyond the bound none are added.
void LiveView::add_clouds(LiveTeam& team) {
  std::deque<AgentView::Cloud> later;
  for (std::size_t shown = clouds_.size(); !waiting_.empty() && clouds_.size() < shown + kCloudsAtOnce;) {
    AgentView::Cloud cloud = std::move(waiting_.front());
    waiting_.pop_front();
    if (points_ < kMostPoints && !show_cloud(cloud, team)) later.push_back(std::move(cloud));
  }
  waiting_.insert(waiting_.begin(), later.begin(), later.end());
  team.clouds = clouds_;
}

LiveTeam LiveView::next(AgentView view) {
  take(view);
  number_of(view.team.self);
  for (const AgentView::Robot& robot : view.robots) number_of(robot.id);
  LiveTeam team = std::move(view.team);
  team.dimension = dimension_;
  for (const std::string& name : names_)
    team.robots.push_back({.id = name, .frame = name, .poses = {}, .sigma_m = {}, .sigma_team_m = {}});
  for (const AgentView::Robot& robot : view.robots)
    team.robots[number_of(robot.id)] = place(robot, team.dimension);
  add_lines(team);
  std::move(view.clouds.begin(), view.clouds.end(), std::back_inserter(waiting_));
  add_clouds(team);
  team.sigmas = sigmas_;
  return team;
}

}  // namespace radioslam::cli
