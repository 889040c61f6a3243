#include "radioslam/cli/agent/agent_publisher.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/map/team_map.hpp"

namespace radioslam::cli {
namespace {

constexpr const char *kOdometry = "nav_msgs/msg/Odometry", *kPath = "nav_msgs/msg/Path",
                     *kGrid = "nav_msgs/msg/OccupancyGrid", *kCloud = "sensor_msgs/msg/PointCloud2",
                     *kMarkers = "visualization_msgs/msg/MarkerArray",
                     *kTransforms = "tf2_msgs/msg/TFMessage";
constexpr std::size_t kMostPathPoses = 10000;

std::string frame_id(const PublishedFrame& frame) { return frame.frame + "/map"; }

using Trajectories = std::map<std::string, Trajectory<SE3>>;

/// The robots of the largest frame if this robot is among them; else it alone, by its odometry.
Trajectories shown_trajectories(const Agent& agent) {
  Trajectories shown;
  for (EstimatedTrajectory& robot : agent.estimate().largest_frame())
    shown.emplace(robot.id, std::move(robot.poses));
  if (shown.contains(agent.name())) return shown;
  shown.clear();
  std::vector<StampedPose<SE3>> own;
  const auto keyframes = agent.estimate().keyframes().find(agent.name());
  const SE3 T_frame_start = agent.frame_of(agent.name()).T_frame_start;
  if (keyframes != agent.estimate().keyframes().end())
    for (const auto& [stamp, pose] : keyframes->second.said) own.push_back({stamp, T_frame_start * pose});
  shown.emplace(agent.name(), Trajectory<SE3>(std::move(own)));
  return shown;
}

/// Every k-th pose, and the last one.
std::vector<StampedPose<SE3>> thinned(const Trajectory<SE3>& poses) {
  const std::size_t step = poses.size() / kMostPathPoses + 1;
  std::vector<StampedPose<SE3>> kept;
  for (std::size_t k = 0; k < poses.size(); k += step) kept.push_back(poses[k]);
  if (!poses.empty() && kept.back().stamp != poses.back().stamp) kept.push_back(poses.back());
  return kept;
}

RosLines way_of(const std::string& robot, const Trajectory<SE3>& poses, std::size_t number) {
  constexpr float kColours[][3] = {
      {0.1F, 0.5F, 0.9F}, {0.9F, 0.5F, 0.1F}, {0.2F, 0.7F, 0.3F}, {0.7F, 0.3F, 0.7F}};
  const auto& colour = kColours[number % std::size(kColours)];
  RosLines lines{"robot " + robot, {colour[0], colour[1], colour[2]}, 0.05, {}};
  const auto shown = thinned(poses);
  for (std::size_t k = 1; k < shown.size(); ++k)
    lines.segments.emplace_back(shown[k - 1].pose.translation(), shown[k].pose.translation());
  return lines;
}

/// The scans of these robots as a mission has them.
std::vector<MappedRobot> mapped_robots(const std::map<std::string, ScansSoFar>& scans,
                                       const Trajectories& team, const RunParams& params) {
  std::vector<MappedRobot> robots;
  for (const auto& [id, of] : scans) {
    std::vector<StoredCloud> clouds;
    LidarLog log;
    for (const auto& [stamp, cloud] : of.clouds()) {
      if (!team.at(id).covers(stamp) || cloud.empty()) continue;
      log.stamps.push_back(stamp);
      clouds.push_back(cloud);
    }
    if (clouds.empty()) continue;
    log.read = [clouds = std::move(clouds)](std::size_t k) {
      LidarScan scan;
      for (const Surfel& surfel : clouds[k].read()->all) scan.points.push_back(surfel.position);
      return scan;
    };
    const ScannerGeometry geometry = scanner_geometry(log, of.scanner().kind, params.scans.lidar.points);
    robots.push_back({id, std::move(log), team.at(id), of.scanner().kind, geometry});
  }
  return robots;
}

}  // namespace

AgentPublisher::AgentPublisher(std::string robot, std::string space, std::string transforms,
                               const RunParams& params, const RosPublisher& publisher)
    : robot_(std::move(robot)),
      space_(std::move(space)),
      transforms_(std::move(transforms)),
      params_(params),
      publisher_(publisher) {}

std::vector<RosOutputTopic> AgentPublisher::topics() const {
  return {{topic("odom"), kOdometry},   {topic("path"), kPath, true}, {topic("map"), kCloud, true},
          {topic("grid"), kGrid, true}, {topic("markers"), kMarkers}, {transforms_, kTransforms}};
}

RosPublication AgentPublisher::publication(const char* name, const char* type, Stamp stamp,
                                           std::string cdr) const {
  return {topic(name), type, ros_definition_of(type), stamp, std::move(cdr)};
}

void AgentPublisher::add(const BodyPose& pose, const PublishedFrame& frame) {
  const std::string smooth = robot_ + (pose.odometry_frame.empty() ? "/odom" : "/radioslam_odom");
  const std::string body = pose.body_frame.empty() ? robot_ + "/base_link" : pose.body_frame;
  if (publisher_.wants(topic("odom")))
    publisher_.publish(publication("odom", kOdometry, pose.stamp,
                                   odometry_cdr({pose.stamp, smooth, body, pose.T_start_body})));
  const bool is_due = !transformed_ || seconds_between(*transformed_, pose.stamp) >= kTransform_s;
  if (is_due && publisher_.wants(transforms_)) publish_transforms(pose, frame, smooth, body);
}

void AgentPublisher::publish_transforms(const BodyPose& pose, const PublishedFrame& frame,
                                        const std::string& smooth, const std::string& body) {
  transformed_ = pose.stamp;
  const std::string map = frame_id(frame);
  std::vector<RosTransform> transforms{{pose.stamp, map, smooth, frame.T_frame_start}};
  if (pose.odometry_frame.empty())
    transforms.push_back({pose.stamp, smooth, body, pose.T_start_body});
  else if (pose.T_odometry_body)
    transforms.push_back({pose.stamp, map, pose.odometry_frame,
                          frame.T_frame_start * pose.T_start_body * pose.T_odometry_body->inverse()});
  publisher_.publish(
      {transforms_, kTransforms, ros_definition_of(kTransforms), pose.stamp, transforms_cdr(transforms)});
}

std::optional<std::function<PublishedMap()>> AgentPublisher::step(const Agent& agent, Stamp now) {
  if (stepped_ && seconds_between(*stepped_, now) < kPath_s) return std::nullopt;
  stepped_ = now;
  if (publisher_.wants(topic("path"))) publish_path(agent, now);
  if (publisher_.wants(topic("markers"))) publish_markers(agent, now);
  const bool is_due =
      !is_mapping_ && agent.clouds() > 0 && (!mapped_ || seconds_between(*mapped_, now) >= kMap_s);
  if (!is_due || (!publisher_.wants(topic("map")) && !publisher_.wants(topic("grid")))) return std::nullopt;
  is_mapping_ = true;
  return map_job(agent, now);
}

void AgentPublisher::publish_path(const Agent& agent, Stamp now) const {
  const auto shown = shown_trajectories(agent);
  const RosHeader header{now, frame_id(agent.frame_of(robot_))};
  publisher_.publish(publication("path", kPath, now, path_cdr(header, thinned(shown.at(robot_)))));
}

void AgentPublisher::publish_markers(const Agent& agent, Stamp now) const {
  const auto shown = shown_trajectories(agent);
  std::vector<RosLines> lines;
  for (const auto& [robot, poses] : shown) lines.push_back(way_of(robot, poses, lines.size()));
  RosLines accepted{"closures", {0.1F, 0.8F, 0.1F}, 0.03, {}},
      rejected{"rejected closures", {0.8F, 0.1F, 0.1F}, 0.02, {}};
  for (const JudgedClosure& closure : agent.estimate().closures()) {
    const auto i = shown.find(closure.i), j = shown.find(closure.j);
    if (i == shown.end() || j == shown.end()) continue;
    const auto from = i->second.at(closure.stamp_i), to = j->second.at(closure.stamp_j);
    if (from && to)
      (closure.is_accepted ? accepted : rejected)
          .segments.emplace_back(from->translation(), to->translation());
  }
  lines.push_back(std::move(accepted));
  lines.push_back(std::move(rejected));
  const RosHeader header{now, frame_id(agent.frame_of(robot_))};
  publisher_.publish(publication("markers", kMarkers, now, lines_cdr(header, lines)));
}

std::function<PublishedMap()> AgentPublisher::map_job(const Agent& agent, Stamp now) const {
  const auto shown = shown_trajectories(agent);
  std::map<std::string, ScansSoFar> scans;
  for (const auto& [robot, poses] : shown)
    if (const ScansSoFar* of = agent.scans().scans_of(robot)) scans.emplace(robot, *of);
  const RosHeader header{now, frame_id(agent.frame_of(robot_))};
  return [this, shown, scans, header] {
    PublishedMap made;
    auto robots = mapped_robots(scans, shown, params_);
    if (robots.empty()) return made;
    const TeamMap map(std::move(robots), params_.scans.lidar.points, params_.map);
    made.push_back(publication("map", kCloud, header.stamp, cloud_cdr(header, map.result().points)));
    made.push_back(publication("grid", kGrid, header.stamp, grid_cdr(header, map.result().grid)));
    return made;
  };
}

void AgentPublisher::add(const PublishedMap& map) {
  is_mapping_ = false;
  mapped_ = stepped_;
  for (const RosPublication& publication : map) publisher_.publish(publication);
}

}  // namespace radioslam::cli
