// What a robot's agent publishes on topics of ROS 2, below /ROBOT/radioslam/ and on /tf:
//   odom     nav_msgs/Odometry                its pose by odometry, which never jumps
//   path     nav_msgs/Path                    its keyframes as the team's estimate has them
//   map      sensor_msgs/PointCloud2          the map of the robots in its frame, as far as it has their
//   scans grid     nav_msgs/OccupancyGrid           the same from above markers
//   visualization_msgs/MarkerArray   the trajectories in its frame, and closures between them
// The frame of the team is FIRST/map, of the first of its robots. The robot's odometry lies in it at
// T_frame_start, which moves where the estimate does.
//
// Where the robot's drivers have odometry, /tf has what AMCL has: FIRST/map to the frame of that odometry, so
// that the pose in FIRST/map is the estimate's. Else it has ROBOT/odom to the body.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/cli/agent/inbox.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/ros_node/ros_publisher.hpp"

namespace radioslam::cli {

class AgentPublisher {
 public:
  static constexpr double kTransform_s = 0.05, kPath_s = 1, kMap_s = 10;

  /// `space`: the robot's namespace. Keeps references.
  AgentPublisher(std::string robot, std::string space, std::string transforms, const RunParams& params,
                 const RosPublisher& publisher);

  std::vector<RosOutputTopic> topics() const;

  /// A pose of the robot, whose odometry lies there.
  void add(const BodyPose& pose, const PublishedFrame& frame);
  /// What is due. Work that is, for another thread; it gives what add() takes.
  std::optional<std::function<PublishedMap()>> step(const Agent& agent, Stamp now);
  void add(const PublishedMap& map);

 private:
  std::string topic(const char* name) const { return space_ + "/radioslam/" + name; }
  RosPublication publication(const char* name, const char* type, Stamp stamp, std::string cdr) const;
  void publish_transforms(const BodyPose& pose, const PublishedFrame& frame, const std::string& smooth,
                          const std::string& body);
  void publish_path(const Agent& agent, Stamp now) const;
  void publish_markers(const Agent& agent, Stamp now) const;
  std::function<PublishedMap()> map_job(const Agent& agent, Stamp now) const;

  std::string robot_, space_, transforms_;
  const RunParams& params_;
  const RosPublisher& publisher_;
  std::optional<Stamp> transformed_, stepped_, mapped_;
  bool is_mapping_ = false;
};

}  // namespace radioslam::cli
