// The one way of everything that a robot publishes: messages with their topics, types and definitions, to
// whoever wants them.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/io/dds/dds_topic.hpp"
#include "radioslam/io/ros/ros_output.hpp"

namespace radioslam {

class RosSink {
 public:
  virtual ~RosSink() = default;
  /// Whether messages of the topic would be seen; what nobody wants is not made.
  virtual bool wants(const std::string& topic) const = 0;
  virtual void take(const RosPublication& publication) = 0;
};

class RosPublisher {
 public:
  /// Keeps a reference.
  void add(RosSink& sink) { sinks_.push_back(&sink); }
  bool wants(const std::string& topic) const {
    return std::any_of(sinks_.begin(), sinks_.end(), [&](const RosSink* sink) { return sink->wants(topic); });
  }
  void publish(const RosPublication& publication) const {
    for (RosSink* sink : sinks_)
      if (sink->wants(publication.topic)) sink->take(publication);
  }

 private:
  std::vector<RosSink*> sinks_;
};

/// A topic that is announced before anything is published.
struct RosOutputTopic {
  std::string name, type;  ///< "/a/radioslam/odom", "nav_msgs/msg/Odometry"
  bool is_kept = false;    ///< late subscribers get the last message
};

/// Publishes by DDS; a topic is wanted while somebody reads it.
class DdsSink : public RosSink {
 public:
  /// Keeps a reference to the domain.
  DdsSink(DdsDomain& domain, const std::vector<RosOutputTopic>& topics);

  bool wants(const std::string& topic) const override;
  void take(const RosPublication& publication) override;

 private:
  std::map<std::string, std::unique_ptr<DdsWriter>> writers_;
};

}  // namespace radioslam
