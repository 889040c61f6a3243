// Where a robot's front end gets its samples: a recording at the pace of the mission's clock, or ROS 2.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "radioslam/cli/agent/inbox.hpp"
#include "radioslam/front_end/front_end.hpp"

namespace radioslam::cli {

/// All but conclude() is called by the front end's thread alone.
class SampleSource {
 public:
  virtual ~SampleSource() = default;

  /// Waits until it is known what the robot measures its motion by; nothing if it concludes before.
  virtual std::optional<MotionSources> begin() = 0;
  /// The mission that the front end knows, without its recordings; after begin(). It may grow.
  virtual const Mission& names() const = 0;
  virtual RobotIndex self() const = 0;
  /// Whether the odometry of a program that was started again is in the frame of the one before.
  virtual bool odometry_goes_on() const = 0;

  /// Waits for the next sample; nothing when there are no more.
  virtual std::optional<Sample> next() = 0;
  /// Where what the user should know goes, in words that follow the robot's name.
  void set_say(std::function<void(std::string)> say) { say_ = std::move(say); }
  /// A pose of the front end, with what is known of its frames.
  virtual BodyPose published(const OnlinePose& pose) const { return {pose.stamp, pose.T_start_body, {}, {}}; }

  /// No more samples come. By any thread.
  virtual void conclude() = 0;

 protected:
  void say(std::string note) const {
    if (say_) say_(std::move(note));
  }

 private:
  std::function<void(std::string)> say_;
};

}  // namespace radioslam::cli
