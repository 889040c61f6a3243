#include "radioslam/cli/agent/agent_process.hpp"

#include <algorithm>
#include <thread>
#include <utility>

#include "radioslam/base/input_error.hpp"

namespace radioslam::cli {
namespace {

using std::chrono::milliseconds;

constexpr double kTick_s = 0.1, kCommit_s = 1, kObserve_s = 5;
constexpr milliseconds kLook{250};
constexpr milliseconds kLeastTick{5}, kLeastCommit{100};          // of a mission that is replayed quickly
constexpr std::chrono::seconds kLeastQuiet{3}, kLeastSettle{30};  // the same
constexpr std::size_t kMostCounted = kMaxTeam * std::size(kAgentMessageKinds);  // senders and kinds
constexpr milliseconds kLastWords{1000};                                        // to send what is left

constexpr const char* kRecorded = "recorded odometry";  // in the journal

SteadyClock::duration at_least(double mission_s, double rate, milliseconds least) {
  return std::max<SteadyClock::duration>(least, std::chrono::duration_cast<SteadyClock::duration>(
                                                    std::chrono::duration<double>(mission_s / rate)));
}

}  // namespace

std::optional<LogBefore> log_before(const AgentStore& store, const std::string& robot) {
  AgentMemory memory = store.memory();
  for (auto& [name, log] : memory.logs)
    if (name == robot && log.life == memory.life && !log.records.empty())
      return LogBefore{std::move(log), decode_recorded(store.state(kRecorded).value_or(""))};
  return std::nullopt;
}

AgentProcess::AgentProcess(const AgentProcessSetup& setup, AgentStore& store, const MissionClock& clock,
                           DdsDomain& domain, SampleSource& source)
    : setup_(setup),
      store_(store),
      clock_(clock),
      name_(setup.robot),
      before_(log_before(store, name_)),
      agent_(name_, setup.dimension, setup.run, setup.agent, store.memory()),
      domain_(domain),
      channel_(domain_, name_, [this](TeamMessage message) { inbox_.hear(std::move(message)); }),
      outbox_(name_, channel_),
      front_end_(source, setup.run, before_, clock, inbox_,
                 setup.publisher ? FrontEndThread::Poses::kReported : FrontEndThread::Poses::kKept),
      worker_(inbox_),
      changed_at_(SteadyClock::now()) {}

AgentProcess::~AgentProcess() { inbox_.close(); }

TeamRun AgentProcess::live() {
  if (before_) say({clock_.now(), "is started again"});
  const auto tick = at_least(kTick_s, clock_.rate(), kLeastTick);
  auto next = SteadyClock::now();
  for (;;) {
    for (Arrival& arrival : inbox_.take(next)) take(std::move(arrival), clock_.now());
    if (SteadyClock::now() < next) continue;
    next = SteadyClock::now() + tick;
    const Stamp now = clock_.now();
    step(now);
    note_changes();
    if (setup_.page && setup_.page->is_due())
      setup_.page->show(agent_, run_, outbox_.traffic(), received_, now);
    if (setup_.is_to_conclude() && !std::exchange(is_concluding_, true)) {
      say({now, "is asked to come to its end"});
      front_end_.conclude();
    }
    if (is_settled(now)) break;
  }
  commit();
  step(clock_.now());
  for (const auto end = SteadyClock::now() + kLastWords; !outbox_.empty() && SteadyClock::now() < end;
       std::this_thread::sleep_for(kLeastTick))
    outbox_.send();
  run_.logs[name_] = agent_.logs().whole();
  run_.extents[name_] = agent_.logs().extents();
  run_.traffic = outbox_.traffic();
  for (const auto& [key, traffic] : run_.traffic) run_.counts[name_].bytes_sent += traffic.bytes;
  run_.counts[name_].refused = refused_by(agent_);
  run_.end = clock_.now();
  return std::move(run_);
}

void AgentProcess::take(Arrival arrival, Stamp now) {
  if (auto* message = std::get_if<TeamMessage>(&arrival)) return hear(*message, now);
  if (auto* news = std::get_if<FrontEndNews>(&arrival)) return take(std::move(*news), now);
  if (const auto* result = std::get_if<AnyGrownEstimate>(&arrival)) {
    ++run_.computed;
    return agent_.done(*result, now);
  }
  if (const auto* result = std::get_if<ScanResult>(&arrival)) return agent_.done(*result);
  if (const auto* map = std::get_if<PublishedMap>(&arrival)) return setup_.publisher->add(*map);
  std::rethrow_exception(std::get<std::exception_ptr>(arrival));
}

void AgentProcess::hear(const TeamMessage& message, Stamp now) {
  run_.counts[name_].bytes_received += message.octets.size();
  const std::tuple link{message.from, name_, message.kind};
  if (received_.size() < kMostCounted || received_.contains(link)) {
    LinkTraffic& of = received_[link];
    ++of.messages;
    of.bytes += message.octets.size();
  }
  agent_.hear(message.from, message.octets, now);
}

void AgentProcess::take(FrontEndNews news, Stamp now) {
  if (news.scanner) agent_.set_scanner(*news.scanner);
  for (std::string& record : news.records) agent_.say(std::move(record));
  if (!news.recorded.empty()) recorded_ = std::move(news.recorded);
  for (auto& [stamp, cloud] : news.clouds) agent_.add_cloud(stamp, std::move(cloud));
  for (FrontEndEvent& event : news.events) say({event.stamp, std::move(event.what)});
  for (const BodyPose& pose : news.poses) setup_.publisher->add(pose, agent_.frame_of(name_));
  if (news.is_over) {
    is_recording_over_ = true;
    if (setup_.end) say({now, "has no more samples"});
  }
}

void AgentProcess::step(Stamp now) {
  const bool is_due = !committed_ || (seconds_between(*committed_, now) >= kCommit_s &&
                                      SteadyClock::now() - *committed_at_ >= kLeastCommit);
  if (is_due) commit();
  AgentStep step = agent_.step(now);
  for (SentMessage& message : step.messages) outbox_.add(std::move(message), agent_.peers(), now);
  outbox_.send();
  for (TeamEvent& event : step.events) say(std::move(event));
  if (step.job) worker_.start([job = *std::move(step.job)] { return Arrival(job.run()); });
  if (step.scan_job) worker_.start([job = *std::move(step.scan_job)] { return Arrival(job.run()); });
  if (setup_.publisher)
    if (auto job = setup_.publisher->step(agent_, now))
      worker_.start([job = *std::move(job)] { return Arrival(job()); });
  if (!looked_ || SteadyClock::now() - *looked_ >= kLook) look_around(now);
  observe(now);
}

/// What the journal cannot take is not sent; it is tried again.
void AgentProcess::commit() {
  committed_ = clock_.now();
  committed_at_ = SteadyClock::now();
  try {
    JournalChange change = agent_.change();
    if (!recorded_.empty()) change.state[kRecorded] = std::exchange(recorded_, {});
    if (!change.empty()) store_.commit(change);
    agent_.note_kept();
  } catch (const InputError& error) {
    say_once(true, std::string("keeps nothing more: ") + error.what(), *committed_);
  }
}

void AgentProcess::say(TeamEvent event) {
  setup_.say(name_, event);
  run_.events.emplace_back(name_, std::move(event));
}

void AgentProcess::say_once(bool is_so, const std::string& what, Stamp now) {
  if (is_so && said_.insert(what).second) say({now, what});
}

/// For what would else go wrong in silence.
void AgentProcess::look_around(Stamp now) {
  looked_ = SteadyClock::now();
  for (std::string& note : domain_.take_notes()) say({now, std::move(note)});
  if (setup_.subscriptions) {
    setup_.subscriptions->look(host_time());
    for (std::string& note : setup_.subscriptions->take_notes()) say({now, std::move(note)});
  }
  say_once(channel_.of_namesakes() > 0, "hears another robot of its own name", now);
  say_once(channel_.not_understood() > 0,
           "hears messages on the team's topics that are none; does another program use /radioslam/digest or "
           "/radioslam/team?",
           now);
  for (const auto& [robot, count] : inbox_.left_out())
    say_once(true, "leaves out messages of robot " + robot + ", which come faster than they are read", now);
}

std::uint64_t AgentProcess::known_records() const {
  std::uint64_t known = 0;
  for (const auto& [robot, extent] : agent_.logs().extents()) known += extent.records;
  return known;
}

void AgentProcess::observe(Stamp now) {
  if (observed_ && seconds_between(*observed_, now) < kObserve_s) return;
  observed_ = now;
  std::map<std::string, std::uint64_t> said;  // as far as this robot can know
  const auto note = [&](const std::map<std::string, LogExtent>& extents) {
    for (const auto& [robot, extent] : extents) said[robot] = std::max(said[robot], extent.records);
  };
  note(agent_.logs().extents());
  for (const auto& [name, peer] : agent_.peers()) note(peer.knows);
  std::uint64_t all = 0;
  for (const auto& [robot, records] : said) all += records;
  run_.known.push_back(known_then(agent_, now, all, setup_.error_of));
}

/// Until when something was learned, or somebody knew something else.
void AgentProcess::note_changes() {
  const Stamp now = clock_.now();
  const std::uint64_t known = known_records() + agent_.clouds();
  const auto& peers = agent_.peers();
  const bool differs = std::any_of(peers.begin(), peers.end(), [&](const auto& peer) {
    return peer.second.is_heard(now) && peer.second.knows != agent_.logs().extents();
  });
  const bool is_missing = std::any_of(setup_.team.begin(), setup_.team.end(), [&](const auto& robot) {
    return robot != name_ && !peers.contains(robot);
  });
  if (is_recording_over_ && !over_ && setup_.end && now >= *setup_.end) over_ = SteadyClock::now();
  if (known == known_ && !differs && !is_missing && !agent_.is_busy() && over_) return;
  known_ = known;
  changed_ = now;
  changed_at_ = SteadyClock::now();
}

bool AgentProcess::is_settled(Stamp now) const {
  if (is_concluding_) return is_recording_over_;
  if (!over_) return false;
  const auto here = SteadyClock::now();
  return (seconds_between(changed_, now) > kQuiet_s && here - changed_at_ > kLeastQuiet) ||
         here - *over_ > at_least(kSettle_s, clock_.rate(), kLeastSettle);
}

}  // namespace radioslam::cli
