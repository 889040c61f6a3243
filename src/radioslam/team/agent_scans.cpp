#include "radioslam/team/agent_scans.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/lidar/clouds/packed_cloud.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kSeen_m = 10, kStride_m = 2;               // of clouds that are asked for
constexpr double kAsk_s = 3, kPeriod_s = 10, kLast_s = 20;  // the last: work on little news
constexpr int kTimes = 4;                                   // that a cloud is asked for
constexpr std::size_t kMostAsked = 16;                      // at once, of one robot
constexpr double kGrowth = 1.25;
constexpr double kShare = 0.5, kRegistration_s = 0.1;  // of the time of a core; what a registration takes

}  // namespace

void AgentScans::add(Stamp keyframe, StoredCloud cloud) {
  not_kept_.push_back(keyframe);
  own_.add(keyframe, std::move(cloud));
  ++clouds_;
  ++news_;
}

void AgentScans::remember(const CloudMessage& message) {
  const auto cloud = unpacked_from_elsewhere(message.packed);
  if (!cloud) return;
  own_.set_scanner(message.scanner);
  own_.add(message.keyframe, store_.add(*cloud));
  ++clouds_;
}

void AgentScans::note_said(const ClosureRecord& closure) {
  said_.emplace(closure.other, closure.at.stamp, closure.stamp_other);
}

bool AgentScans::take(const std::string& peer, const CloudMessage& message) {
  const auto asked = asked_.find({peer, message.keyframe});
  if (asked == asked_.end()) return false;
  const auto cloud = unpacked_from_elsewhere(message.packed);
  if (!cloud) return false;
  ScansSoFar& scans = others_[peer];
  scans.set_scanner(message.scanner);
  if (scans.clouds().contains(message.keyframe)) return true;
  scans.add(message.keyframe, store_.add(*cloud));
  ++clouds_;
  ++news_;
  return true;
}

std::optional<CloudMessage> AgentScans::cloud(Stamp keyframe) const {
  const auto found = own_.clouds().find(keyframe);
  if (found == own_.clouds().end() || found->second.empty()) return std::nullopt;
  CloudMessage message{keyframe, own_.scanner(), packed(*found->second.read())};
  if (message.packed.size() + 1000 > kMaxAgentMessageBytes) return std::nullopt;
  return message;
}

std::map<std::string, CloudWant> AgentScans::wants(const AgentEstimate& estimate,
                                                   const std::set<std::string>& heard, Stamp now) {
  std::map<std::string, CloudWant> wants;
  if (own_.clouds().empty() || (wanted_ && seconds_between(*wanted_, now) < kAsk_s)) return wants;
  wanted_ = now;
  for (const std::string& robot : heard) {
    if (robot < self_) continue;
    CloudWant want;
    for (const Stamp stamp : estimate.near(self_, robot, kSeen_m, kStride_m)) {
      const auto scans = others_.find(robot);
      if (scans != others_.end() && scans->second.clouds().contains(stamp)) continue;
      Asked& asked = asked_[{robot, stamp}];
      if (asked.times >= kTimes || want.keyframes.size() >= kMostAsked) continue;
      if (asked.times > 0 && seconds_between(asked.at, now) < kAsk_s) continue;
      asked.at = now;
      ++asked.times;
      want.keyframes.push_back(stamp);
    }
    if (!want.keyframes.empty()) wants[robot] = std::move(want);
  }
  return wants;
}

std::optional<ScanJob> AgentScans::job(const AgentEstimate& estimate, Stamp now) {
  if (is_working_ || (news_ == 0 && !has_left_out_)) return std::nullopt;
  double since_s = kPeriod_s;
  if (worked_) {
    since_s = std::min(seconds_between(*worked_, now), kLast_s);
    const bool has_grown = static_cast<double>(clouds_) > kGrowth * static_cast<double>(clouds_ - news_);
    if (since_s < kPeriod_s || (!has_grown && !has_left_out_ && since_s < kLast_s)) return std::nullopt;
  }
  auto job = estimate.scan_job(self_, own_, others_, tried_,
                               static_cast<std::size_t>(since_s * kShare / kRegistration_s));
  if (!job) return std::nullopt;
  is_working_ = true;
  worked_ = now;
  news_ = 0;
  return job;
}

std::vector<std::string> AgentScans::done(const ScanResult& result, const LoggedKeyframes& own) {
  is_working_ = false;
  has_left_out_ = result.has_left_out;
  own_.set_loops(result.own.loops());
  tried_ = result.tried;
  std::vector<std::string> records;
  for (const auto& [stamp, closure] : result.closures) {
    const auto keyframe =
        std::lower_bound(own.said.begin(), own.said.end(), stamp,
                         [](const StampedPose<SE3>& said, Stamp at) { return said.stamp < at; });
    if (keyframe == own.said.end() || keyframe->stamp != stamp ||
        !said_.emplace(closure.other, stamp, closure.stamp_other).second)
      continue;
    Record record = closure;
    std::get<ClosureRecord>(record).at = {static_cast<std::uint32_t>(keyframe - own.said.begin()), stamp,
                                          SE3()};
    if (is_valid(record)) records.push_back(encode(record));
  }
  return records;
}

}  // namespace radioslam
