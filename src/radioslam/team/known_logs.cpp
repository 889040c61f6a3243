#include "radioslam/team/known_logs.hpp"

#include <algorithm>
#include <optional>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr char kFactsKind = 0;  // first byte of a record

/// Of records to this one, by that of those before it (FNV-1a).
std::uint32_t checksum(std::uint32_t before, std::string_view record) {
  std::uint32_t sum = (before ^ static_cast<std::uint32_t>(record.size())) * 16777619U;
  for (const char byte : record) sum = (sum ^ static_cast<unsigned char>(byte)) * 16777619U;
  return sum;
}

}  // namespace

KnownLogs::KnownLogs(std::string self, int dimension, std::uint32_t life,
                     const std::vector<std::pair<std::string, KnownLog>>& kept)
    : self_(std::move(self)), dimension_(dimension) {
  for (const auto& [robot, log] : kept) {
    if (robot == self_) {
      if (log.life == life)
        for (const auto& [number, record] : log.records) say(record);
      continue;
    }
    if (const auto known = team_.robots().find(robot);
        known != team_.robots().end() && known->second.life > log.life)
      continue;
    team_.forget(robot);
    for (std::uint64_t next = 0; next < log.records.size();) {
      auto [bytes, end] = log.bytes(robot, next, log.records.size(), kMaxAgentMessageBytes);
      team_.accept(bytes);
      next = end;
    }
    extend(robot);
    kept_[robot] = extents_[robot].records;
  }
  own_.life = life;
  extents_[self_] = {life, own_.records.size(), own_checksums_.back()};
}

std::vector<RobotLog> KnownLogs::whole() const {
  std::vector<RobotLog> logs;
  for (const auto& [robot, extent] : extents_) {
    RobotLog& whole = logs.emplace_back(RobotLog{robot, {}});
    for (const auto& [number, record] : log(robot).records)
      if (number < extent.records) whole.records.push_back(record);
  }
  return logs;
}

void KnownLogs::say(std::string record) {
  own_checksums_.push_back(checksum(own_checksums_.back(), record));
  own_.records.emplace(own_.records.size(), std::move(record));
}

bool KnownLogs::is_behind(const LogExtent& own) const {
  if (own.life != own_.life) return own.life > own_.life;
  return own.records > extents_.at(self_).records || own_checksums_[own.records] != own.checksum;
}

void KnownLogs::begin_life(std::uint32_t life) {
  own_.life = life;
  extents_[self_] = {life, 0, 0};
  is_new_life_ = true;
}

std::map<std::string, std::size_t> KnownLogs::accept(const std::string& sender, std::string_view chunks) {
  Refusals refusals;
  for (const LogChunk& chunk : chunks_of(chunks)) {
    chunks.remove_prefix(chunk.bytes.size());
    if (chunk.robot == self_)
      check_own(chunk, refusals);
    else
      accept(sender, chunk, refusals);
  }
  if (!chunks.empty()) ++refusals["damaged records"];
  return refusals;
}

/// Others cannot say what this robot said.
void KnownLogs::check_own(const LogChunk& chunk, Refusals& refusals) const {
  for (std::size_t k = 0; k < chunk.records.size(); ++k) {
    const auto said = own_.records.find(chunk.first + k);
    if (chunk.life == own_.life && (said == own_.records.end() || said->second != chunk.records[k]))
      return void(++refusals["records in this robot's name that it did not say"]);
  }
}

void KnownLogs::accept(const std::string& sender, const LogChunk& chunk, Refusals& refusals) {
  const std::string& robot = chunk.robot;
  const bool is_own = sender == robot;
  if (const auto denied = not_believed_.find(robot);
      !is_own && denied != not_believed_.end() && denied->second.contains(sender))
    return void(++refusals["records that the robot itself denied"]);
  if (is_of_other_dimension(chunk)) return void(++refusals["records of a mission in another dimension"]);
  const auto known = team_.robots().find(robot);
  if (known == team_.robots().end() && !make_room(is_own))
    return void(++refusals["records of more robots than a team has"]);
  if (known != team_.robots().end() && known->second.life != chunk.life) {
    if ((!is_own && heard_.contains(robot)) || chunk.life < known->second.life)
      return void(++refusals["records of another life than the robot's last"]);
    replace(robot);
  }
  Acceptance accepted = team_.accept(chunk.bytes);
  if (!accepted.is_whole() && is_own && passed_on_.contains(robot)) {
    replace(robot);
    accepted = team_.accept(chunk.bytes);
    if (accepted.is_whole()) not_believed_[robot].merge(passed_on_.extract(robot).mapped());
  }
  if (!accepted.is_whole()) ++refusals["records that contradict those known, or are not understood"];
  if (!team_.robots().contains(robot)) return;
  if (is_own) heard_.insert(robot);
  if (!is_own && accepted.records > 0) passed_on_[robot].insert(sender);
  if (accepted.records > 0) extend(robot);
}

/// Whether there is room for a robot more. One that speaks for itself takes the place of one that never did.
bool KnownLogs::make_room(bool is_own) {
  if (team_.robots().size() < (is_own ? kMaxTeam : kMaxTeam / 2)) return true;
  if (!is_own) return false;
  for (const auto& [robot, log] : team_.robots())
    if (!heard_.contains(robot)) {
      replace(std::string(robot));
      return true;
    }
  return false;
}

bool KnownLogs::is_of_other_dimension(const LogChunk& chunk) const {
  return std::any_of(chunk.records.begin(), chunk.records.end(), [this](std::string_view bytes) {
    const auto facts = bytes.empty() || bytes.front() != kFactsKind ? std::nullopt : decode_record(bytes);
    return facts && std::get<FactsRecord>(*facts).dimension != dimension_;
  });
}

std::vector<std::pair<std::uint64_t, std::uint64_t>> KnownLogs::missing(const std::string& robot,
                                                                        std::uint64_t end) const {
  constexpr std::size_t kMost = 64;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> missing;
  const auto extent = extents_.find(robot);
  std::uint64_t next = extent == extents_.end() ? 0 : extent->second.records;
  if (extent != extents_.end()) {
    const auto& records = log(robot).records;
    for (auto known = records.lower_bound(next);
         known != records.end() && known->first < end && missing.size() < kMost; ++known) {
      if (known->first > next) missing.emplace_back(next, known->first - 1);
      next = known->first + 1;
    }
  }
  if (next < end && missing.size() < kMost) missing.emplace_back(next, end - 1);
  return missing;
}

JournalChange KnownLogs::change() const {
  JournalChange change;
  if (is_new_life_) change.life = own_.life;
  change.forgotten.assign(forgotten_.begin(), forgotten_.end());
  const auto stretch = [](const KnownLog& log, std::uint64_t first, std::uint64_t end) {
    std::vector<std::string> records;
    for (auto next = log.records.lower_bound(first); next != log.records.end() && next->first < end; ++next)
      records.push_back(next->second);
    return records;
  };
  for (const auto& [robot, extent] : extents_) {
    if (robot == self_) continue;
    const auto kept = kept_.find(robot);
    const std::uint64_t first = kept == kept_.end() ? 0 : kept->second;
    if (first < extent.records)
      change.kept.push_back({robot, extent.life, first, stretch(log(robot), first, extent.records)});
  }
  change.first_own = extents_.at(self_).records;
  change.own = stretch(own_, change.first_own, own_.records.size());
  return change;
}

void KnownLogs::note_kept() {
  forgotten_.clear();
  is_new_life_ = false;
  extents_[self_] = {own_.life, own_.records.size(), own_checksums_.back()};
  for (const auto& [robot, extent] : extents_) kept_[robot] = extent.records;
}

/// As if nothing of the robot had been known.
void KnownLogs::replace(const std::string& robot) {
  team_.forget(robot);
  extents_.erase(robot);
  kept_.erase(robot);
  forgotten_.insert(robot);
  replaced_.insert(robot);
}

void KnownLogs::extend(const std::string& robot) {
  const KnownLog& log = team_.robots().at(robot);
  LogExtent& extent = extents_[robot];
  extent.life = log.life;
  for (auto next = log.records.find(extent.records);
       next != log.records.end() && next->first == extent.records; ++next) {
    ++extent.records;
    extent.checksum = checksum(extent.checksum, next->second);
  }
}

}  // namespace radioslam
