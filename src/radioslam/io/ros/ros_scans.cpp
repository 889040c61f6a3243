#include "radioslam/io/ros/ros_scans.hpp"

#include <algorithm>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kJudgedScans = 10;

/// The typical interval between consecutive stamps; nothing if all stamps are equal.
std::optional<double> nominal_interval_s(std::vector<Stamp> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::vector<double> gaps_s;
  for (std::size_t k = 1; k < stamps.size(); ++k)
    if (stamps[k] != stamps[k - 1])
      gaps_s.push_back((static_cast<double>(stamps[k].ns) - static_cast<double>(stamps[k - 1].ns)) *
                       kSecondsPerNanosecond);
  return gaps_s.empty() ? std::nullopt : std::optional(upper_median(gaps_s));
}

}  // namespace

void RosScans::take(const RosMessage& message) {
  topic_ = message.channel.topic;
  if (has_unit_) return hand_on(message);
  held_.push_back({message.channel, message.stamp, std::string(message.bytes), std::string(message.file)});
  if (held_.size() == kJudgedScans) finish();
}

void RosScans::finish() {
  if (!has_unit_) find_unit();
  for (const Held& held : held_) hand_on(held.message());
  held_.clear();
}

void RosScans::find_unit() {
  has_unit_ = true;
  std::vector<RawPointTimes> times;
  std::vector<Stamp> stamps;
  for (const Held& held : held_) {
    const RosMessage message = held.message();
    stamps.push_back(time_of(message, RosMessageReader(message).header()));
    if (const auto raw = read_ros_point_times(message)) times.push_back(*raw);
  }
  const auto interval = nominal_interval_s(stamps);
  if (times.empty() || !interval) return;
  unit_ = unit_of(times, *interval);
  if (*unit_ != times.front().nominal)
    unit_note_ = std::string("the points' times are assumed to be in ") + name_of(*unit_) + ": in " +
                 name_of(times.front().nominal) +
                 " the duration of a sweep would not match the interval between scans";
}

void RosScans::hand_on(const RosMessage& message) {
  RosScan scan = read_ros_scan(message, unit_);
  ++clocks_[scan.clock];
  take_(message, std::move(scan));
}

std::vector<std::string> RosScans::notes() const {
  std::vector<std::string> notes;
  if (unit_note_) notes.push_back(topic_ + ": " + *unit_note_);
  const auto note = [&](PointClock clock, const std::string& what) {
    if (const auto found = clocks_.find(clock); found != clocks_.end())
      notes.push_back(topic_ + ": the points' times " + what + ", in " + std::to_string(found->second) +
                      " scans");
  };
  note(PointClock::kOther,
       "are from another clock than the scans' stamps; the first point is assigned the stamp");
  note(PointClock::kCoarse, "are too coarse to distinguish points and are ignored");
  return notes;
}

}  // namespace radioslam
