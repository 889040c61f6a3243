#include "radioslam/team/agent.hpp"

#include <algorithm>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMostRecordBytes = 8000;  // of a message
constexpr std::size_t kMostClouds = 512;        // that a peer waits for
constexpr double kWaiting_s = 60;               // then it is said
constexpr double kDigest_s = 1, kOwn_s = 1, kAsk_s = 0.5;
constexpr double kDigestPeers = 5;  // more of them are told less often

/// In the journal.
std::string cloud_key(Stamp keyframe) { return "cloud " + std::to_string(keyframe.ns); }

}  // namespace

Agent::Agent(std::string name, int dimension, const RunParams& run, const AgentParams& params,
             const AgentMemory& memory)
    : name_(std::move(name)),
      dimension_(dimension),
      run_(run),
      params_(params),
      next_life_(memory.next_life),
      logs_(name_, dimension, memory.life, memory.logs),
      scans_(name_) {
  restart_estimate();
  remember_scans(memory);
}

void Agent::say(std::string record) { logs_.say(std::move(record)); }

/// A cloud is kept as the message that others would get.
JournalChange Agent::change() const {
  JournalChange change = logs_.change();
  for (const Stamp keyframe : scans_.not_kept())
    if (const auto cloud = scans_.cloud(keyframe)) change.state[cloud_key(keyframe)] = encode(name_, *cloud);
  return change;
}

/// The clouds of its keyframes, and the closures that it has said.
void Agent::remember_scans(const AgentMemory& memory) {
  if (!memory.state) return;
  for (const auto& [number, bytes] : logs_.log(name_).records) {
    const auto record = decode_record(bytes);
    if (!record) continue;
    if (const auto* closure = std::get_if<ClosureRecord>(&*record)) scans_.note_said(*closure);
    const auto* keyframe = std::get_if<KeyframeRecord>(&*record);
    const auto kept = keyframe ? memory.state(cloud_key(keyframe->stamp)) : std::nullopt;
    if (!kept) continue;
    const auto message = decode_message(*kept);
    if (const auto* received = std::get_if<ReceivedMessage>(&message))
      if (const auto* cloud = std::get_if<CloudMessage>(&received->message)) scans_.remember(*cloud);
  }
}

void Agent::note_kept() {
  logs_.note_kept();
  scans_.note_kept();
  has_news_ = true;
}

void Agent::hear(const std::string& peer, std::string_view bytes, Stamp now) {
  if (peer == name_) return;
  if (!peers_.contains(peer) && peers_.size() >= kMaxTeam) {
    const auto silent = std::find_if(peers_.begin(), peers_.end(),
                                     [now](const auto& of) { return !of.second.is_heard(now); });
    if (silent == peers_.end()) return;
    peers_.erase(silent);
  }
  Peer& of = peers_.try_emplace(peer, Peer{.budget = ByteBudget(params_.bytes_s)}).first->second;
  auto decoded = decode_message(bytes);
  if (const auto* why = std::get_if<std::string>(&decoded)) return refuse(peer, *why, 1, now);
  auto& received = std::get<ReceivedMessage>(decoded);
  if (received.sender != peer) return refuse(peer, "messages in another robot's name", 1, now);
  if (!of.is_heard(now)) {
    events_.push_back({now, "hears robot " + peer + (of.heard ? " again" : "")});
    of.sent_own = 0;  // until it says what it has
  }
  of.heard = now;
  std::visit([&](const auto& message) { take(peer, message, now); }, received.message);
}

void Agent::refuse(const std::string& peer, const std::string& what, std::size_t times, Stamp now) {
  std::size_t& count = peers_.at(peer).refused[what];
  if (count == 0) events_.push_back({now, "refuses from robot " + peer + " " + what});
  count += times;
}

void Agent::take(const std::string& peer, const Digest& digest, Stamp now) {
  Peer& of = peers_.at(peer);
  of.knows = digest.knows;
  of.solves = digest.solves;
  const auto own = digest.knows.find(name_);
  if (own != digest.knows.end() && logs_.is_behind(own->second)) begin_life(peer, own->second, now);
  const LogExtent& extent = logs_.extents().at(name_);
  const std::uint64_t has = own != digest.knows.end() && own->second.life == extent.life
                                ? std::min(own->second.records, extent.records)
                                : 0;
  of.sent_own = std::max(of.sent_own, has);
}

/// Once, since anyone can say that more is known of this robot than it has.
void Agent::begin_life(const std::string& peer, const LogExtent& own, Stamp now) {
  if (next_life_ <= std::max(own.life, logs_.extents().at(name_).life))
    return refuse(peer, "word of records in this robot's name that it did not say", 1, now);
  events_.push_back({now, "begins its log anew, since robot " + peer +
                              " knows more of the last one than its journal does"});
  logs_.begin_life(std::exchange(next_life_, 0));
  for (auto& [name, of] : peers_) of.sent_own = 0;
}

void Agent::take(const std::string& peer, const RecordsMessage& records, Stamp now) {
  for (const auto& [what, times] : logs_.accept(peer, records.chunks)) refuse(peer, what, times, now);
  has_news_ = true;
}

void Agent::take(const std::string& peer, const Want& want, Stamp now) {
  std::map<std::string, std::vector<WantedStretch>>& wanted = peers_.at(peer).wanted;
  for (const WantedStretch& stretch : want.stretches) wanted.erase(stretch.robot);
  for (WantedStretch stretch : want.stretches) {
    const auto extent = logs_.extents().find(stretch.robot);
    if (extent == logs_.extents().end() || extent->second.life != stretch.life ||
        extent->second.records <= stretch.first) {
      refuse(peer, "wants of records that this robot does not have", 1, now);
      continue;
    }
    stretch.end = std::min(stretch.end, extent->second.records);
    wanted[stretch.robot].push_back(stretch);
  }
}

void Agent::take(const std::string& peer, const CloudWant& want, Stamp) {
  std::set<Stamp>& clouds = peers_.at(peer).clouds;
  if (clouds.size() < kMostClouds) clouds.insert(want.keyframes.begin(), want.keyframes.end());
}

void Agent::take(const std::string& peer, const CloudMessage& cloud, Stamp now) {
  if (!scans_.take(peer, cloud)) refuse(peer, "clouds that were not asked for, or are damaged", 1, now);
}

void Agent::take(const std::string&, const SolutionMessage& solution, Stamp) {
  if (params_.solves || (taken_ && taken_->records > solution.records)) return;
  taken_ = solution;
}

void Agent::done(const AnyGrownEstimate& result, Stamp now) {
  for (TeamEvent& event : estimate_->take(result, now)) events_.push_back(std::move(event));
  has_solution_ = true;
}

void Agent::done(const ScanResult& result) {
  const auto own = estimate_->keyframes().find(name_);
  const LoggedKeyframes none;
  for (std::string& record : scans_.done(result, own == estimate_->keyframes().end() ? none : own->second))
    say(std::move(record));
}

PublishedFrame Agent::frame_of(const std::string& robot) const {
  if (!params_.solves && taken_)
    if (const auto frame = taken_->frames.find(robot); frame != taken_->frames.end()) return frame->second;
  return estimate_->frames().of(robot);
}

AgentStep Agent::step(Stamp now) {
  AgentStep step;
  tell_estimate();
  send_digest(now, step);
  if (!asked_ || seconds_between(*asked_, now) >= kAsk_s) ask(now);
  const bool pushes = !own_sent_ || seconds_between(*own_sent_, now) >= kOwn_s;
  for (auto& [name, peer] : peers_) {
    peer.budget.refill(now);
    if (peer.is_heard(now)) send_to(name, peer, pushes, step);
    note_waiting(name, peer, now);
  }
  if (pushes) own_sent_ = now;
  if (std::exchange(has_solution_, false)) send_solution(now, step);
  if (params_.solves) {
    step.job = estimate_->job(now);
    step.scan_job = scans_.job(*estimate_, now);
  }
  step.events = std::exchange(events_, {});
  return step;
}

void Agent::ask(Stamp now) {
  asked_ = now;
  for (auto& [peer, want] :
       asking_.wants(now, name_, logs_.extents(), peers_,
                     [&](const std::string&robot, std::uint64_t end) { return logs_.missing(robot, end); }))
    wants_[peer] = std::move(want);
  std::set<std::string> heard;
  for (const auto& [name, peer] : peers_)
    if (peer.is_heard(now)) heard.insert(name);
  for (auto& [peer, want] : scans_.wants(*estimate_, heard, now)) cloud_wants_[peer] = std::move(want);
}

void Agent::tell_estimate() {
  if (!std::exchange(has_news_, false)) return;
  for (const std::string& robot : logs_.take_replaced()) {
    if (!estimated_.contains(robot)) continue;
    restart_estimate();
    break;
  }
  for (const auto& [robot, extent] : logs_.extents()) {
    std::uint64_t& told = estimated_[robot];
    const auto& records = logs_.log(robot).records;
    for (auto next = records.lower_bound(told); told < extent.records; ++next, ++told)
      estimate_->hear(robot, next->second);
  }
}

void Agent::restart_estimate() {
  estimate_ = agent_estimate(dimension_, run_, params_.stream);
  estimated_.clear();
}

void Agent::send_digest(Stamp now, AgentStep& step) {
  const auto heard = static_cast<double>(std::count_if(
      peers_.begin(), peers_.end(), [now](const auto& peer) { return peer.second.is_heard(now); }));
  if (digest_sent_ && seconds_between(*digest_sent_, now) < kDigest_s * std::max(1.0, heard / kDigestPeers))
    return;
  digest_sent_ = now;
  Digest digest{logs_.extents(), params_.solves};
  while (digest.knows.size() > kMaxTeam) digest.knows.erase(std::prev(digest.knows.end()));
  step.messages.push_back({"", 0, encode(name_, digest)});
  for (auto& [name, peer] : peers_) peer.budget.take(step.messages.back().bytes.size());
}

/// To those that make none, by the first of those that do.
void Agent::send_solution(Stamp now, AgentStep& step) {
  for (const auto& [name, peer] : peers_)
    if (peer.is_heard(now) && peer.solves && name < name_) return;
  SolutionMessage solution{estimate_->records(), {}};
  for (const auto& [robot, keyframes] : estimate_->keyframes()) {
    if (solution.frames.size() == kMaxTeam) break;
    solution.frames[robot] = estimate_->frames().of(robot);
  }
  for (auto& [name, peer] : peers_)
    if (peer.is_heard(now) && !peer.solves) send(name, peer, solution, step);
}

/// What the peer lacks, as far as its link's budget goes.
void Agent::send_to(const std::string& name, Peer& peer, bool pushes, AgentStep& step) {
  if (const auto want = wants_.find(name); want != wants_.end() && send(name, peer, want->second, step))
    wants_.erase(want);
  if (const auto want = cloud_wants_.find(name);
      want != cloud_wants_.end() && send(name, peer, want->second, step))
    cloud_wants_.erase(want);
  RecordsMessage message;
  const auto add = [&](const std::string& robot, std::uint64_t& first, std::uint64_t end) {
    return add_records(name, peer, robot, first, end, message, step);
  };
  bool goes_on = !pushes || add(name_, peer.sent_own, logs_.extents().at(name_).records);
  while (goes_on && !peer.wanted.empty()) {
    const auto wanted = peer.wanted.begin();
    const auto extent = logs_.extents().find(wanted->first);
    for (auto& stretches = wanted->second; goes_on && !stretches.empty();) {
      WantedStretch& next = stretches.front();
      const bool is_there = extent != logs_.extents().end() && extent->second.life == next.life;
      goes_on = !is_there || add(next.robot, next.first, next.end);
      if (goes_on) stretches.erase(stretches.begin());
    }
    if (goes_on) peer.wanted.erase(wanted);
  }
  if (!message.chunks.empty()) send(name, peer, message, step);
  if (goes_on) send_clouds(name, peer, step);
}

void Agent::send_clouds(const std::string& name, Peer& peer, AgentStep& step) {
  while (!peer.clouds.empty()) {
    const auto cloud = scans_.cloud(*peer.clouds.begin());
    if (cloud && !send(name, peer, *cloud, step)) return;
    peer.clouds.erase(peer.clouds.begin());
    peer.clouds_wait.reset();
  }
}

/// A link that is too slow for what it is asked for.
void Agent::note_waiting(const std::string& name, Peer& peer, Stamp now) {
  if (peer.clouds.empty() || !peer.is_heard(now)) return peer.clouds_wait.reset();
  if (!peer.clouds_wait) peer.clouds_wait = now;
  if (seconds_between(*peer.clouds_wait, now) < kWaiting_s || std::exchange(peer.is_cloud_wait_said, true))
    return;
  events_.push_back({now, "has scans that robot " + name +
                              " waits for: the bytes a second of this link do not suffice (--cap)"});
}

bool Agent::send(const std::string& to, Peer& peer, const AgentMessage& message, AgentStep& step) {
  std::string bytes = encode(name_, message);
  if (!peer.budget.has(bytes.size())) return false;
  peer.budget.take(bytes.size());
  step.messages.push_back({to, message.index(), std::move(bytes)});
  return true;
}

/// Adds records to the message, and sends it where it is full. Moves `first` to the first record that was not
/// taken; whether all were.
bool Agent::add_records(const std::string& to, Peer& peer, const std::string& robot, std::uint64_t& first,
                        std::uint64_t end, RecordsMessage& message, AgentStep& step) {
  constexpr std::size_t kEnvelope = 64;  // and some more
  while (first < end) {
    const std::size_t most = peer.budget.at_most(kMostRecordBytes), used = message.chunks.size() + kEnvelope;
    const std::size_t next_bytes = logs_.log(robot).records.at(first).size() + robot.size() + kEnvelope;
    const bool fits = used + next_bytes <= most;
    if (!fits && !message.chunks.empty()) {
      send(to, peer, std::exchange(message, {}), step);
      continue;
    }
    if (!fits && !peer.budget.has(used + next_bytes)) return false;
    auto [bytes, next] = logs_.log(robot).bytes(robot, first, end, fits ? most - used : next_bytes);
    message.chunks += bytes;
    first = next;
  }
  return true;
}

}  // namespace radioslam
