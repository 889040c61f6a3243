// Messages of a robot's drivers.
#pragma once

#include <string>
#include <vector>

#include "io/ros/ros_bytes.hpp"
#include "radioslam/io/ros/radioslam_messages.hpp"
#include "radioslam/io/ros/ros_output.hpp"
#include "radioslam/ros_node/robot_samples.hpp"

namespace radioslam {

inline Stamp at(double seconds) { return Stamp::from_seconds(seconds); }

inline std::string odometry_message(Stamp stamp, const SE3& pose) {
  return odometry_cdr({stamp, "odom", "base_link", pose});
}

inline std::string imu_message(Stamp stamp, const std::string& frame, const Eigen::Vector3d& force_mps2) {
  CdrWriter out;
  write_header(out, {stamp, frame});
  for (const double number : {0.0, 0.0, 0.0, 1.0}) out.f64(number);
  for (int k = 0; k < 9; ++k) out.f64(0);
  for (const double number : {0.0, 0.0, 0.1}) out.f64(number);
  for (int k = 0; k < 9; ++k) out.f64(0);
  for (const double number : force_mps2) out.f64(number);
  for (int k = 0; k < 9; ++k) out.f64(0);
  return out.take();
}

inline std::string scan_message(Stamp stamp, const std::string& frame, const std::vector<float>& ranges_m) {
  CdrWriter out;
  write_header(out, {stamp, frame});
  for (const float number : {-1.0F, 1.0F, 0.5F, 0.0F, 0.1F, 0.1F, 20.0F}) out.f32(number);
  out.count(ranges_m.size());
  for (const float range_m : ranges_m) out.f32(range_m);
  return out.count(0).take();
}

/// A robot a that hears them, and what it makes of them.
class Listening {
 public:
  explicit Listening(std::vector<std::string> topics = {}, RobotSamplesSetup setup = {})
      : setup_(std::move(setup)) {
    if (setup_.names.robots.empty()) setup_.names.robots.emplace_back().id = "a";
    setup_.self = RobotIndex(0);
    setup_.topics = robot_topics("/a", topics);
    samples_ = std::make_unique<RobotSamples>(setup_);
  }

  RobotSamples& samples() { return *samples_; }
  const RobotTopics& topics() const { return setup_.topics; }

  /// Arrives at `now`, by both clocks.
  void hear(const std::string& topic, const std::string& type, const std::string& cdr, Stamp now) {
    RosArrival arrival{RosArrival::kStaticTransforms, {topic, type, MessageEncoding::kCdr}, now, now, cdr};
    for (std::size_t k = 0; k < setup_.topics.measured.size(); ++k)
      if (setup_.topics.measured[k].name == topic) arrival.topic = k;
    samples_->take(std::move(arrival));
    samples_->advance(now);
    for (Sample& sample : samples_->take_samples()) taken_.push_back(std::move(sample));
    for (std::string& note : samples_->take_notes()) notes_.push_back(std::move(note));
  }
  void hear_odometry(Stamp stamp, const SE3& pose) {
    hear("/a/odom", "nav_msgs/Odometry", odometry_message(stamp, pose), stamp);
  }
  /// Odometry for as long as it takes until the robot's sensors are settled; returns when.
  Stamp settle(double begin_s = 1000) {
    Stamp now = at(begin_s);
    for (int k = 0; !samples_->sources() && k < 200; ++k, now.ns += 100'000'000) hear_odometry(now, SE3());
    return now;
  }

  template <class Kind>
  std::vector<Kind> all() const {
    std::vector<Kind> of_kind;
    for (const Sample& sample : taken_)
      if (const auto* of = std::get_if<Kind>(&sample)) of_kind.push_back(*of);
    return of_kind;
  }
  /// The notes that have these words.
  std::vector<std::string> notes(const std::string& words) const {
    std::vector<std::string> found;
    for (const std::string& note : notes_)
      if (note.find(words) != std::string::npos) found.push_back(note);
    return found;
  }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  RobotSamplesSetup setup_;
  std::unique_ptr<RobotSamples> samples_;
  std::vector<Sample> taken_;
  std::vector<std::string> notes_;
};

}  // namespace radioslam
