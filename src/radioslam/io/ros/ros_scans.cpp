#include "radioslam/io/ros/ros_scans.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kScansToBegin = 10;

/// The typical interval between consecutive stamps; nothing if all stamps are equal. Sorts the stamps.
std::optional<double> nominal_interval_s(std::vector<Stamp>& stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::vector<double> gaps_s;
  for (std::size_t k = 1; k < stamps.size(); ++k)
    if (stamps[k] != stamps[k - 1])
      gaps_s.push_back((static_cast<double>(stamps[k].ns) - static_cast<double>(stamps[k - 1].ns)) *
                       kSecondsPerNanosecond);
  return gaps_s.empty() ? std::nullopt : std::optional(upper_median(gaps_s));
}

/// Copies of scans in time order, without equal ones.
std::vector<StampedScan> in_time_order(std::vector<StampedScan> scans) {
  std::stable_sort(scans.begin(), scans.end(),
                   [](const StampedScan& a, const StampedScan& b) { return a.stamp < b.stamp; });
  const auto is_repeated = [](const StampedScan& a, const StampedScan& b) {
    return a.stamp == b.stamp && a.scan.points == b.scan.points;
  };
  scans.erase(std::unique(scans.begin(), scans.end(), is_repeated), scans.end());
  return scans;
}

}  // namespace

void RosScans::take(const RosMessage& message) {
  topic_ = message.channel.topic;
  if (has_begun_) {
    if (auto scan = read(message)) hand_on(std::move(*scan));
    return;
  }
  held_.push_back({message.channel, message.stamp, std::string(message.bytes), std::string(message.file)});
  if (held_.size() == kScansToBegin) begin();
}

void RosScans::finish() {
  if (!has_begun_) begin();
  if (sweeps_) hand_on(sweeps_->finish());
  if (readable_ == 0) unreadable_.throw_first();
}

void RosScans::begin() {
  has_begun_ = true;
  find_unit();
  std::vector<Read> scans;
  for (const Held& held : held_)
    if (auto scan = read(held.message())) scans.push_back(std::move(*scan));
  held_.clear();
  find_slices(scans);
  for (Read& scan : scans) hand_on(std::move(scan));
}

void RosScans::find_unit() {
  std::vector<RawPointTimes> times;
  std::vector<Stamp> stamps;
  for (const Held& held : held_) {
    const RosMessage message = held.message();
    try {
      const Stamp stamp = time_of(message, RosMessageReader(message).header());
      if (const auto raw = read_ros_point_times(message)) times.push_back(*raw);
      stamps.push_back(stamp);
    } catch (const InputError&) {  // noted when it is read
    }
  }
  const auto interval = nominal_interval_s(stamps);
  if (times.empty() || !interval) return;
  unit_ = unit_of(times, *interval);
  are_frozen_ = are_frozen(times, seconds_between(stamps.front(), stamps.back()), *unit_);
  if (*unit_ != times.front().nominal)
    unit_note_ = std::string("the points' times are assumed to be in ") + name_of(*unit_) + ": in " +
                 name_of(times.front().nominal) +
                 " the duration of a sweep would not match the interval between scans";
}

void RosScans::find_slices(const std::vector<Read>& scans) {
  std::vector<StampedScan> stamped;
  for (const Read& read : scans) stamped.push_back({read.stamp, read.scan.scan});
  const auto motion = motion_of_slices(in_time_order(std::move(stamped)));
  if (!motion) return;
  slices_ = *motion;
  sweeps_.emplace(*motion);
}

std::optional<RosScans::Read> RosScans::read(const RosMessage& message) {
  try {
    RosScan scan = read_ros_scan(message, unit_);
    if (are_frozen_) {
      scan.scan.times_s.clear();
      scan.clock = PointClock::kConstant;
    }
    ++clocks_[scan.clock];
    ++readable_;
    const Stamp stamp = time_of(message, scan.header);
    return Read{stamp, std::move(scan)};
  } catch (const InputError& error) {
    unreadable_.add(error);
    return std::nullopt;
  }
}

void RosScans::hand_on(Read read) {
  if (!sweeps_) return take_(read.stamp, std::move(read.scan));
  auto complete = sweeps_->add({read.stamp, std::move(read.scan.scan)});
  last_ = std::move(read.scan);
  hand_on(std::move(complete));
}

void RosScans::hand_on(std::vector<StampedScan> sweeps) {
  for (StampedScan& sweep : sweeps) {
    RosScan scan = last_;
    scan.scan = std::move(sweep.scan);
    take_(sweep.stamp, std::move(scan));
  }
}

void RosScans::note_slices(std::vector<std::string>& notes) const {
  const SweepAssembler::Counts& counts = sweeps_->counts();
  std::ostringstream text;
  text << topic_ << ": its " << counts.slices << " messages are slices of sweeps, " << std::setprecision(3)
       << std::abs(slices_.step_rad) * kDegreesPerRadian << " degrees each; they are gathered into "
       << counts.sweeps << " sweeps";
  const auto add = [&](std::size_t count, const char* what) {
    if (count > 0) text << "; " << count << ' ' << what;
  };
  add(counts.missing, "slices are missing between others");
  add(counts.repeated, "slices that repeat another one are left out");
  add(counts.late, "slices that come after later sweeps are left out");
  add(counts.empty, "slices without points are left out");
  notes.push_back(text.str());
}

std::vector<std::string> RosScans::notes() const {
  std::vector<std::string> notes;
  if (unreadable_.count() > 0) notes.push_back(unreadable_.warning(topic_, "message"));
  if (sweeps_) note_slices(notes);
  if (unit_note_) notes.push_back(topic_ + ": " + *unit_note_);
  const auto note = [&](PointClock clock, const std::string& what) {
    if (const auto found = clocks_.find(clock); found != clocks_.end())
      notes.push_back(topic_ + ": the points' times " + what + ", in " + std::to_string(found->second) +
                      (sweeps_ ? " slices" : " scans"));
  };
  note(PointClock::kOther,
       "are from another clock than the scans' stamps; the first point is assigned the stamp");
  note(PointClock::kCoarse, "are too coarse to distinguish points and are ignored");
  note(PointClock::kConstant, "do not advance, within a scan or from scan to scan, and are ignored");
  return notes;
}

}  // namespace radioslam
