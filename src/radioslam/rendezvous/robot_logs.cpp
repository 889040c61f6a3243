#include "radioslam/rendezvous/robot_logs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

/// Which recording of a robot begins at a time: a later one has a higher number.
std::uint32_t life_of(Stamp start) {
  return static_cast<std::uint32_t>(std::clamp(std::floor(start.seconds()), 0.0, 4294967295.0));
}

}  // namespace

RobotLogs::RobotLogs(std::string robot, Stamp start, const std::optional<SE2>& pose,
                     const AngleCheckParams& angles)
    : robot_(std::move(robot)), angles_(angles) {
  own_.life = life_of(start);
  FactsRecord facts;
  facts.lidar_range_m = facts.lidar_view_rad = 1;  // none, but records have them
  if (pose) facts.initial_pose = lift(*pose);
  say(facts);
  KeyframeRecord first;
  first.stamp = start;
  say(first);
}

void RobotLogs::say(const Record& record) {
  std::string bytes = encode(record);
  if (!decode_record(bytes)) return;
  own_.records.emplace(own_.records.size(), std::move(bytes));
  read(robot_, own_);
}

void RobotLogs::is_whole_until(Stamp now) {
  read_.at(robot_).is_whole_until(now);
  has_news_ = has_news_ || open_ > 0;
}

/// What records say that were not read yet, up to the first gap.
void RobotLogs::read(const std::string& robot, const KnownLog& log) {
  ReadLog& known = read_.try_emplace(robot, log.life).first->second;
  for (auto next = log.records.find(known.records()); next != log.records.end();
       next = log.records.find(known.records())) {
    const auto record = decode_record(next->second);
    known.take(*record);
    reconsider(robot, *record);
    has_news_ = has_news_ || robot != robot_ || !std::holds_alternative<KeyframeRecord>(*record);
  }
  const auto said = said_.find(robot);
  if (said == said_.end() || said->second.life != log.life || said->second.records > known.records()) return;
  known.is_whole_until(Stamp::from_seconds(said->second.until_s));
  said_.erase(said);
  has_news_ = has_news_ || open_ > 0;
}

/// A sighting links two robots; of those that angles are about, the evidence is worked out again.
void RobotLogs::reconsider(const std::string& robot, const Record& record) {
  if (const auto* closure = std::get_if<ClosureRecord>(&record)) {
    links_[robot].insert(closure->other);
    links_[closure->other].insert(robot);
  }
  const auto* angles = std::get_if<AnglesRecord>(&record);
  if (!angles || angles->at.keyframe >= read_.at(robot).stamps().size()) return;
  const Stamp since = read_.at(robot).stamps()[angles->at.keyframe];
  const auto forget = [&](const std::string& from, const std::string& of) {
    const auto log = read_.find(from);
    if (log == read_.end()) return;
    auto& sightings = log->second.sightings();
    for (auto each = sightings.rbegin(); each != sightings.rend() && each->stamp >= since; ++each)
      if (each->robot == of) each->evidence.reset();
  };
  forget(robot, angles->transmitter.name);
  forget(angles->transmitter.name, robot);
}

void RobotLogs::accept(std::string_view bytes) {
  if (heard_.accept(bytes).records == 0) return;
  for (const auto& [robot, log] : heard_.robots())
    if (robot != robot_) read(robot, log);
}

void RobotLogs::note(const std::map<std::string, LogVersion>& known) {
  for (const auto& [robot, version] : known) {
    const auto log = read_.find(robot);
    const bool is_known = log != read_.end();
    if (robot == robot_ || (is_known && version.life < log->second.life())) continue;
    if (is_known && version.life > log->second.life()) {
      heard_.forget(robot);
      read_.erase(log);
      has_news_ = true;
      ++changes_;
    } else if (is_known && version.until_s <= log->second.until().seconds()) {
      continue;
    }
    LogVersion& said = said_[robot];
    if (std::pair(said.life, said.until_s) < std::pair(version.life, version.until_s)) said = version;
    if (const auto now = heard_.robots().find(robot); now != heard_.robots().end()) read(robot, now->second);
  }
}

std::map<std::string, LogVersion> RobotLogs::versions(double now_s) const {
  std::map<std::string, LogVersion> versions;
  for (const auto& [robot, log] : read_)
    if (!log.stamps().empty())
      versions.emplace_hint(
          versions.end(), robot,
          LogVersion{log.life(), log.records(), robot == robot_ ? now_s : log.until().seconds()});
  return versions;
}

std::pair<std::string, std::uint64_t> RobotLogs::records(const std::string& robot, std::uint64_t first,
                                                         std::size_t most_bytes) const {
  const KnownLog& log = robot == robot_ ? own_ : heard_.robots().at(robot);
  return log.bytes(robot, first, read_.at(robot).records(), most_bytes);
}

std::vector<std::string> RobotLogs::around(const std::string& robot, int hops) const {
  std::vector<std::string> list, last{robot};
  std::set<std::string_view> reached{robot};
  for (int hop = 0; hop < hops && !last.empty(); ++hop) {
    std::vector<std::string> next;
    for (const std::string& from : last)
      if (const auto links = links_.find(from); links != links_.end())
        for (const std::string& to : links->second)
          if (reached.insert(to).second) next.push_back(to);
    std::copy_if(next.begin(), next.end(), std::back_inserter(list),
                 [this](const std::string& each) { return read_.contains(each); });
    last = std::move(next);
  }
  return list;
}

/// Against a direction drawn evenly, the one that a sighting predicts at either end.
AngleEvidence RobotLogs::evidence_of(const std::string& i, const ReadLog& of_i, const Sighting& sighting,
                                     const ReadLog& of_j, std::uint32_t keyframe_j) const {
  const double sigma_m = std::sqrt(sighting.covariance(0, 0)),
               sigma_rad = std::sqrt(sighting.covariance(2, 2));
  const AngleEvidence here =
      check_angles({sighting.T_i_j, sigma_m, 0},
                   of_i.arrivals(sighting.robot, sighting.keyframe, sighting.stamp), angles_);
  const AngleEvidence there = check_angles({sighting.T_i_j.inverse(), sigma_m, sigma_rad},
                                           of_j.arrivals(i, keyframe_j, sighting.stamp), angles_);
  return {here.log_odds + there.log_odds, here.scale * there.scale};
}

std::vector<SightingBetween> RobotLogs::between() {
  std::vector<SightingBetween> list;
  open_ = 0;
  for (auto& [i, log] : read_)
    for (Sighting& sighting : log.sightings()) {
      const auto other = read_.find(sighting.robot);
      const auto keyframe_j = other == read_.end() ? std::nullopt : other->second.keyframe_at(sighting.stamp);
      if (!keyframe_j || sighting.robot == i) {
        ++open_;
        continue;
      }
      if (!sighting.evidence) {
        sighting.evidence = evidence_of(i, log, sighting, other->second, *keyframe_j);
        ++changes_;
      }
      list.push_back({&i, &other->first, *keyframe_j, &sighting});
    }
  has_news_ = false;
  return list;
}

}  // namespace radioslam
