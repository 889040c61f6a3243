#include "radioslam/ros_node/robot_samples.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

constexpr double kLongestStart_s = 3;  // of the first scans, which wait for each other

bool is_of_motion(RobotTopicKind kind) {
  return kind == RobotTopicKind::kOdometry || kind == RobotTopicKind::kScans;
}

/// Whether the sensor's place is that of its topic's first message for the whole run.
bool has_one_frame(RobotTopicKind kind) {
  return kind == RobotTopicKind::kScans || kind == RobotTopicKind::kImu || kind == RobotTopicKind::kFix;
}

}  // namespace

RobotSamples::RobotSamples(RobotSamplesSetup setup)
    : names_(std::move(setup.names), setup.self, std::move(setup.antennas)),
      topics_(std::move(setup.topics)),
      origin_(setup.origin),
      reader_(names_, frames_, origin_, setup.is_simulated, notes_),
      states_(topics_.measured.size()) {}

void RobotSamples::take(RosArrival arrival) {
  now_ = arrival.received;
  if (arrival.topic == RosArrival::kStaticTransforms) return take_transforms(arrival);
  if (sources_) return read(arrival);
  note_frame(arrival);
  if (!first_ && is_of_motion(topics_.measured[arrival.topic].kind)) first_ = arrival.received;
  held_bytes_ += arrival.cdr.size();
  held_.push_back(std::move(arrival));
  for (; held_bytes_ > kMostHeldBytes; held_.pop_front()) {
    held_bytes_ -= held_.front().cdr.size();
    notes_.say("gets more than it can hold until its sensors are known; the oldest messages are left out");
  }
}

void RobotSamples::take_transforms(const RosArrival& arrival) {
  try {
    frames_.take(arrival.message());
  } catch (const InputError& error) {
    notes_.say("topic " + topics_.static_transforms + ": a message cannot be read",
               std::string(": ") + error.what());
  }
}

void RobotSamples::note_frame(const RosArrival& arrival) {
  TopicState& state = states_[arrival.topic];
  if (state.messages > 0 && !state.frame.empty()) return void(++state.messages);
  try {
    RosMessageReader in(arrival.message());
    state.frame = in.header().frame;
    if (topics_.measured[arrival.topic].kind == RobotTopicKind::kOdometry) state.child = in.frame();
    ++state.messages;
  } catch (const InputError&) {  // said when it is read
  }
}

bool RobotSamples::has_come(RobotTopicKind kind) const {
  for (std::size_t k = 0; k < states_.size(); ++k)
    if (topics_.measured[k].kind == kind && states_[k].messages > 0) return true;
  return false;
}

void RobotSamples::advance(Stamp now) {
  now_ = now;
  if (sources_) return;
  choose_topics();
  if (is_settled(now)) settle();
}

bool RobotSamples::is_settled(Stamp now) const {
  if (!first_) return false;
  const double waited_s = seconds_between(*first_, now);
  if (waited_s < kSettle_s) return false;
  const bool lacks_stated = std::any_of(states_.begin(), states_.end(), [&](const TopicState& state) {
    const RobotTopic& topic = topics_.measured[static_cast<std::size_t>(&state - states_.data())];
    return topic.is_stated && (is_of_motion(topic.kind) || topic.kind == RobotTopicKind::kImu) &&
           state.messages == 0;
  });
  if (lacks_stated && waited_s < kLongestWait_s) return false;
  return are_frames_known() || waited_s >= kTransformWait_s;
}

bool RobotSamples::are_frames_known() const {
  for (std::size_t k = 0; k < states_.size(); ++k)
    if (states_[k].is_used && has_one_frame(topics_.measured[k].kind) && !frames_.knows(states_[k].frame))
      return false;
  return true;
}

/// The first of each kind that has come; links to different partners are all used.
void RobotSamples::choose_topics() {
  std::string child;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const RobotTopicKind kind = topics_.measured[k].kind;
    const bool is_second = std::any_of(
        states_.begin(), states_.begin() + static_cast<std::ptrdiff_t>(k), [&](const TopicState& before) {
          return before.is_used &&
                 topics_.measured[static_cast<std::size_t>(&before - states_.data())].kind == kind;
        });
    const bool has_own_place =
        kind == RobotTopicKind::kRangeTo || !(is_of_motion(kind) || has_one_frame(kind));
    states_[k].is_used = has_own_place || (states_[k].messages > 0 && !is_second);
    if (states_[k].is_used && kind == RobotTopicKind::kOdometry) {
      child = states_[k].child;
      odometry_frame_ = states_[k].frame;
    }
  }
  frames_.find_body(child, names_.robot().id);
}

void RobotSamples::settle() {
  if (sources_) return;
  choose_topics();
  place_sensors();
  describe_scanner();
  sources_ = MotionSources{has_come(RobotTopicKind::kOdometry), has_come(RobotTopicKind::kImu),
                           has_come(RobotTopicKind::kScans)};
  settled_ = now_;
  say_what_is_used();
  for (const RosArrival& arrival : std::exchange(held_, {})) read(arrival);
}

void RobotSamples::place_sensors() {
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const RobotTopic& topic = topics_.measured[k];
    if (!states_[k].is_used || !has_one_frame(topic.kind)) continue;
    const SE3 T_body_sensor = frames_.pose_of(topic.name, states_[k].frame, notes_);
    reader_.place(topic.name, T_body_sensor);
    if (topic.kind == RobotTopicKind::kFix) names_.robot().fix_lever_m = T_body_sensor.translation();
  }
}

/// How far a planar scanner reaches, as its first scan states.
void RobotSamples::describe_scanner() {
  for (const RosArrival& arrival : held_) {
    if (!states_[arrival.topic].is_used || arrival.channel.type != kLaserScanType) continue;
    try {
      const double range_m = read_ros_scan(arrival.message()).range_max_m;
      if (range_m > 0 && range_m < 1e6) names_.robot().lidar_range_m = range_m;
      return;
    } catch (const InputError&) {  // said when it is read
    }
  }
}

void RobotSamples::say_what_is_used() {
  std::string used;
  for (std::size_t k = 0; k < states_.size(); ++k) {
    const RobotTopic& topic = topics_.measured[k];
    if (states_[k].is_used && states_[k].messages > 0) used += (used.empty() ? "" : ", ") + topic.name;
    if (!states_[k].is_used && states_[k].messages > 0)
      notes_.say("topic " + topic.name + ": is not used, since another one has " + name_of(topic.kind) +
                 "; --topic " + name_of(topic.kind) + "=" + topic.name + " takes this one");
  }
  notes_.say("measures by " + (used.empty() ? "nothing" : used) + " in the frame " +
             (frames_.body().empty() ? "of its sensors" : frames_.body()));
}

void RobotSamples::read(const RosArrival& arrival) {
  const RobotTopic& topic = topics_.measured[arrival.topic];
  TopicState& state = states_[arrival.topic];
  if (state.messages == 0 && (is_of_motion(topic.kind) || has_one_frame(topic.kind)))
    return notes_.say("topic " + topic.name +
                      ": came after the start and is not used; start the agent again");
  if (state.is_used) reader_.read(topic, arrival);
}

std::vector<Sample> RobotSamples::take_samples() {
  for (Sample& sample : reader_.take()) waiting_.push_back(std::move(sample));
  const bool waits = sources_ && sources_->scans && !reader_.hands_scans_on() &&
                     seconds_between(settled_, now_) < kLongestStart_s;
  if (waits) return {};
  std::stable_sort(waiting_.begin(), waiting_.end(),
                   [](const Sample& a, const Sample& b) { return stamp_of(a) < stamp_of(b); });
  return std::exchange(waiting_, {});
}

}  // namespace radioslam
