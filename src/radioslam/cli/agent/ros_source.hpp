// A robot's samples from ROS 2, as its drivers publish them.
//
// Messages that the front end does not keep up with wait; beyond kMostBytes or kMostMessages the oldest are
// left out, counted and said.
#pragma once

#include <condition_variable>
#include <deque>
#include <mutex>

#include "radioslam/cli/agent/sample_source.hpp"
#include "radioslam/ros_node/robot_samples.hpp"

namespace radioslam::cli {

class RosSource : public SampleSource {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{64} << 20U, kMostMessages = 20000;

  explicit RosSource(RobotSamplesSetup setup) : samples_(std::move(setup)) {}

  /// By any thread.
  void add(RosArrival arrival);

  std::optional<MotionSources> begin() override;
  const Mission& names() const override { return samples_.names(); }
  RobotIndex self() const override { return samples_.self(); }
  bool odometry_goes_on() const override { return false; }  // it may have moved while nobody looked
  std::optional<Sample> next() override;
  BodyPose published(const OnlinePose& pose) const override;
  void conclude() override;

 private:
  bool read_arrivals();
  void say_notes(bool is_behind);

  RobotSamples samples_;
  std::deque<Sample> ready_;
  bool is_behind_said_ = false;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<RosArrival> arrivals_;
  std::size_t bytes_ = 0;
  bool is_concluded_ = false, is_behind_ = false;
};

}  // namespace radioslam::cli
