// What arrives for the thread that owns a robot's agent, from all others: bounded.
//
// Messages of other robots beyond kMostMessages or kMostBytes, or beyond a quarter of these from one of them,
// are left out and counted; what a log lacks is asked for again. The robot's own front end waits instead.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "radioslam/cli/agent/mission_clock.hpp"
#include "radioslam/io/dds/team_channel.hpp"
#include "radioslam/io/ros/ros_output.hpp"
#include "radioslam/team/agent.hpp"

namespace radioslam::cli {

/// A pose of the robot in the frame of its odometry, to be published.
struct BodyPose {
  Stamp stamp;
  SE3 T_start_body;
  std::string body_frame, odometry_frame;   ///< the latter: of the recorded odometry; empty without
  std::optional<SE3> T_odometry_body = {};  ///< as recorded
};

/// What the front end has said since the last time.
struct FrontEndNews {
  std::vector<std::string> records = {};
  std::string recorded =
      {};  ///< odometry at the last of their keyframes, if it follows scans: encode_recorded
  std::vector<std::pair<Stamp, StoredCloud>> clouds = {};
  std::optional<ScannerFacts> scanner = {};
  std::vector<FrontEndEvent> events = {};
  std::vector<BodyPose> poses = {};
  bool is_over = false;  ///< no more comes

  bool empty() const {
    return records.empty() && clouds.empty() && events.empty() && poses.empty() && !is_over;
  }
};

/// Messages that a worker has made.
using PublishedMap = std::vector<RosPublication>;

/// The last: why a thread ended.
using Arrival =
    std::variant<TeamMessage, FrontEndNews, AnyGrownEstimate, ScanResult, PublishedMap, std::exception_ptr>;

class Inbox {
 public:
  static constexpr std::size_t kMostMessages = 4096, kMostBytes = std::size_t{16} << 20U, kMostNews = 256;

  /// From another robot.
  void hear(TeamMessage message);
  /// From a thread of this robot; waits while there is too much of it.
  void push(Arrival arrival);
  /// What has arrived, as soon as there is something, or nothing by then.
  std::deque<Arrival> take(SteadyClock::time_point until);
  /// Messages that were left out, by their senders.
  std::map<std::string, std::size_t> left_out() const;
  /// Nobody takes any more.
  void close();

 private:
  struct Waiting {
    std::size_t messages = 0, bytes = 0;
  };

  bool has_room(const TeamMessage& message);

  mutable std::mutex mutex_;
  std::condition_variable arrived_, taken_;
  std::deque<Arrival> waiting_;
  Waiting of_all_;
  std::map<std::string, Waiting> of_robot_;  ///< since the last take
  std::map<std::string, std::size_t> left_out_;
  std::size_t news_ = 0;
  bool is_closed_ = false;
};

}  // namespace radioslam::cli
