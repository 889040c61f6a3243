// A robot's subscriptions: each topic is read as its publishers have it, as soon as one is announced, by the
// type and reliability of theirs; what stays away is said.
//
// Not to be used by several threads at once. `take` is called by threads of Cyclone's, possibly several at a
// time; it should be quick and must not throw.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/dds/dds_topic.hpp"
#include "radioslam/ros_node/notes_once.hpp"
#include "radioslam/ros_node/robot_topics.hpp"
#include "radioslam/ros_node/ros_arrival.hpp"

namespace radioslam {

class RosSubscriptions {
 public:
  /// After which a topic that sends nothing is said; the latter: of radio measurements.
  static constexpr double kQuiet_s = 5, kRadioQuiet_s = 60;
  using Take = std::function<void(RosArrival)>;
  using Clock = std::function<Stamp()>;  ///< the robot's, which may be called by any thread

  /// Keeps a reference to the domain.
  RosSubscriptions(DdsDomain& domain, const RobotTopics& topics, Clock clock, Take take);

  /// Follows what is announced; to be called now and then, with the host's time.
  void look(Stamp now);
  /// What the user should know, in words that follow the robot's name; since the last call.
  std::vector<std::string> take_notes() { return notes_.take(); }

 private:
  struct Subscription {
    std::size_t number = 0;  ///< of RosArrival
    std::string topic;
    std::vector<std::string_view> types;
    RobotTopicKind kind = RobotTopicKind::kOdometry;
    bool is_stated = false, is_watched = true;
    DdsReliability reliability = DdsReliability::kReliable;
    DdsDurability durability = DdsDurability::kVolatile;
    std::string type = {};
    std::unique_ptr<std::atomic<std::int64_t>>
        last_ns;  ///< when a message has come, by the host's clock; 0: never
    std::unique_ptr<DdsReader> reader = {};
  };

  void add(Subscription subscription);
  void follow(Subscription& subscription, const std::vector<DdsEndpoint>& writers);
  void open(Subscription& subscription);
  void watch(const Subscription& subscription, const std::vector<DdsEndpoint>& writers, Stamp now);
  void watch_motion(const std::vector<DdsEndpoint>& writers, Stamp now);

  DdsDomain& domain_;
  Clock clock_;
  Take take_;
  std::vector<Subscription> subscriptions_;
  std::optional<Stamp> begin_;
  NotesOnce notes_;
};

/// The host's clock: nanoseconds since 1970.
Stamp host_time();

}  // namespace radioslam
