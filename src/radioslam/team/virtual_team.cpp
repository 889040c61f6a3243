#include "radioslam/team/virtual_team.hpp"

#include <algorithm>
#include <deque>

#include "radioslam/records/resumed_log.hpp"

namespace radioslam {
namespace {

constexpr double kTick_s = 0.1, kCommit_s = 1, kObserve_s = 5, kSettle_s = 180, kQuiet_s = 15;
constexpr double kExtend_s = 0.1, kJudge_s = 1;  // virtual time of an estimate
constexpr double kRegistered_s = 0.5;            // after which a keyframe's cloud is there
constexpr std::size_t kShared = 8;               // estimates that are kept for others

class MemoryStore : public AgentStore {
 public:
  MemoryStore(std::string robot, std::uint32_t life) : robot_(std::move(robot)) { logs_[robot_].life = life; }

  AgentMemory memory() const override {
    const std::uint32_t life = logs_.at(robot_).life;
    return {
        life, {logs_.begin(), logs_.end()}, life + 1, [this](const std::string& key) { return state(key); }};
  }
  std::optional<std::string> state(const std::string& key) const override {
    const auto found = state_.find(key);
    return found == state_.end() ? std::nullopt : std::optional(found->second);
  }
  void commit(const JournalChange& change) override {
    for (const std::string& robot : change.forgotten) logs_.erase(robot);
    if (change.life) logs_[robot_] = {*change.life, {}};
    for (const JournalChange::Kept& kept : change.kept) {
      KnownLog& log = logs_[kept.robot];
      log.life = kept.life;
      for (std::size_t k = 0; k < kept.records.size(); ++k)
        log.records.emplace(kept.first + k, kept.records[k]);
    }
    for (std::size_t k = 0; k < change.own.size(); ++k)
      logs_[robot_].records.emplace(change.first_own + k, change.own[k]);
    for (const auto& [key, bytes] : change.state) state_[key] = bytes;
  }

 private:
  std::string robot_;
  std::map<std::string, KnownLog> logs_;
  std::map<std::string, std::string> state_;
};

class StoreOfNothing : public AgentStore {
 public:
  explicit StoreOfNothing(std::uint32_t life) : life_(life) {}
  AgentMemory memory() const override {
    return {life_, {}, life_ + 1, [this](const std::string& key) { return state(key); }};
  }
  std::optional<std::string> state(const std::string&) const override { return std::nullopt; }
  void commit(const JournalChange&) override {}

 private:
  std::uint32_t life_;
};

/// A robot: its program, while it runs, and what outlives it.
struct Host {
  const ScriptedRobot* script = nullptr;
  std::unique_ptr<AgentStore> store;
  std::unique_ptr<Agent> agent;
  std::optional<ResumedLog> resumed;
  std::size_t run = 0, next = 0, next_cloud = 0;  ///< of the script; record and cloud of the run
  std::optional<Stamp> committed, observed;
  std::deque<std::pair<Stamp, AnyGrownEstimate>> done;
  std::optional<std::pair<Stamp, ScanResult>> scans_done;

  const ScriptedRun* current() const { return run < script->runs.size() ? &script->runs[run] : nullptr; }
};

/// Lets the robot's front end say what is due; how many records.
std::size_t let_say(Host& host, const ScriptedRun& run, Stamp now) {
  std::size_t said = 0;
  for (; host.next < run.records.size() && run.records[host.next].first <= now; ++host.next) {
    const std::string& record = run.records[host.next].second;
    ++said;
    if (!host.resumed)
      host.agent->say(record);
    else if (auto continued = host.resumed->continued(record))
      host.agent->say(*std::move(continued));
  }
  const Stamp registered{now.ns - Stamp::from_seconds(kRegistered_s).ns};
  for (; host.next_cloud < run.clouds.size() && run.clouds[host.next_cloud].first <= registered;
       ++host.next_cloud)
    host.agent->add_cloud(run.clouds[host.next_cloud].first, run.clouds[host.next_cloud].second);
  return said;
}

/// What the agent knows in the end.
void conclude(const Host& host, TeamRun& run) {
  if (!host.agent) return;
  const std::string& name = host.script->name;
  run.logs[name] = host.agent->logs().whole();
  run.extents[name] = host.agent->logs().extents();
  run.counts[name].refused = refused_by(*host.agent);
  for (const auto& [key, traffic] : run.traffic) {
    if (std::get<0>(key) == name) run.counts[name].bytes_sent += traffic.bytes;
    if (std::get<1>(key) == name) run.counts[name].bytes_received += traffic.arrived_bytes;
  }
}

/// The estimates that agents ask for; those of the same key are made once.
class SharedEstimates {
 public:
  const AnyGrownEstimate& of(const EstimateJob& job) {
    ++asked_;
    const auto found =
        std::find_if(last_.begin(), last_.end(), [&](const auto& of) { return of.first == job.key; });
    if (found != last_.end()) return found->second;
    ++computed_;
    last_.emplace_front(job.key, job.run());
    if (last_.size() > kShared) last_.pop_back();
    return last_.front().second;
  }
  std::size_t asked() const { return asked_; }
  std::size_t computed() const { return computed_; }

 private:
  std::deque<std::pair<std::string, AnyGrownEstimate>> last_;
  std::size_t asked_ = 0, computed_ = 0;
};

std::vector<std::string> names_of(const std::vector<ScriptedRobot>& robots) {
  std::vector<std::string> names;
  for (const ScriptedRobot& robot : robots) names.push_back(robot.name);
  return names;
}

class VirtualTeam {
 public:
  VirtualTeam(const std::vector<ScriptedRobot>& robots, const VirtualTeamSetup& setup,
              const Progress& progress)
      : setup_(setup), progress_(progress), network_(names_of(robots), setup.network) {
    for (const ScriptedRobot& robot : robots) {
      Host& host = hosts_.emplace_back();
      host.script = &robot;
      host.store = setup.store(robot.name);
      for (const ScriptedRun& run : robot.runs) {
        begin_ = begin_ ? std::min(*begin_, run.begin) : run.begin;
        for (const auto& [stamp, record] : run.records) last_ = std::max(last_, stamp);
      }
    }
  }

  TeamRun run() {
    if (!begin_) return {};
    last_ = std::max(last_, *begin_);
    const Stamp end{last_.ns + Stamp::from_seconds(kSettle_s).ns};
    for (std::int64_t tick = 0;; ++tick) {
      const Stamp now{begin_->ns + tick * Stamp::from_seconds(kTick_s).ns};
      for (Host& host : hosts_) live(host, now);
      network_.deliver(now, [&](std::size_t to, const std::string& from, std::string_view bytes) {
        if (hosts_[to].agent) hosts_[to].agent->hear(from, bytes, now);
      });
      for (std::size_t k = 0; k < hosts_.size(); ++k) act(k, now);
      report_progress(progress_, "team", seconds_between(*begin_, now) / seconds_between(*begin_, end));
      run_.end = now;
      if (tick % 10 == 0) note_changes(now);
      if (now > end || (now > last_ && seconds_between(changed_, now) > kQuiet_s)) break;
    }
    run_.traffic = network_.traffic();
    for (const Host& host : hosts_) conclude(host, run_);
    run_.settled = changed_;
    run_.estimates = estimates_.asked();
    run_.computed = estimates_.computed();
    return std::move(run_);
  }

 private:
  /// Starts and kills the robot's program, and lets its front end say what is due.
  void live(Host& host, Stamp now) {
    const ScriptedRun* run = host.current();
    if (run && host.agent && run->killed && *run->killed <= now) {
      host.agent.reset();
      host.done.clear();
      host.scans_done.reset();
      ++host.run;
      run = host.current();
      run_.events.push_back({host.script->name, {now, "is killed"}});
    }
    if (run && !host.agent && run->begin <= now) start(host, now);
    if (!run || !host.agent) return;
    said_ += let_say(host, *run, now);
  }

  void start(Host& host, Stamp now) {
    const AgentMemory memory = host.store->memory();
    AgentParams params = setup_.agent;
    params.solves = static_cast<std::size_t>(&host - hosts_.data()) < setup_.solvers;
    host.agent = std::make_unique<Agent>(host.script->name, setup_.dimension, setup_.run, params, memory);
    host.next = host.next_cloud = 0;
    host.agent->set_scanner(host.script->runs[host.run].scanner);
    host.resumed.reset();
    if (host.run == 0) return;
    run_.events.push_back({host.script->name, {now, "is started again"}});
    const KnownLog& log = host.agent->logs().log(host.script->name);
    const ScriptedRun &before = host.script->runs[host.run - 1], &again = host.script->runs[host.run];
    if (again.follows_scans)
      host.resumed.emplace(log, OdometryBesideScans{before.recorded, again.recorded, host.script->noise});
    else
      host.resumed.emplace(log, true);
  }

  void act(std::size_t k, Stamp now) {
    Host& host = hosts_[k];
    if (!host.agent) return;
    while (!host.done.empty() && host.done.front().first <= now) {
      host.agent->done(host.done.front().second, now);
      host.done.pop_front();
    }
    observe(host, now);
    if (host.scans_done && host.scans_done->first <= now) {
      host.agent->done(host.scans_done->second);
      host.scans_done.reset();
    }
    if (!host.committed || seconds_between(*host.committed, now) >= kCommit_s) {
      if (const JournalChange change = host.agent->change(); !change.empty()) host.store->commit(change);
      host.agent->note_kept();
      host.committed = now;
    }
    AgentStep step = host.agent->step(now);
    for (const SentMessage& message : step.messages) network_.send(k, message, now);
    for (TeamEvent& event : step.events) run_.events.push_back({host.script->name, std::move(event)});
    if (step.job) make(host, *step.job, now);
    if (step.scan_job)
      host.scans_done.emplace(Stamp{now.ns + Stamp::from_seconds(kJudge_s).ns}, step.scan_job->run());
  }

  void make(Host& host, const EstimateJob& job, Stamp now) {
    const AnyGrownEstimate& grown = estimates_.of(job);
    const bool is_short = std::visit(
        [](const auto& of) { return !of.solution || of.solution->effort == Effort::kExtend; }, grown);
    host.done.emplace_back(Stamp{now.ns + Stamp::from_seconds(is_short ? kExtend_s : kJudge_s).ns}, grown);
  }

  void observe(Host& host, Stamp now) {
    if (host.observed && seconds_between(*host.observed, now) < kObserve_s) return;
    host.observed = now;
    run_.known.push_back(known_then(*host.agent, now, said_, setup_.error_of));
  }

  /// Until when somebody learned something, or somebody knew more than another.
  void note_changes(Stamp now) {
    std::uint64_t known = 0;
    const Agent* first = nullptr;
    bool is_settled = true;
    for (const Host& host : hosts_) {
      is_settled = is_settled && (host.agent || !host.current());
      if (!host.agent) continue;
      if (!first) first = host.agent.get();
      is_settled =
          is_settled && !host.agent->is_busy() && host.agent->logs().extents() == first->logs().extents();
      known += host.agent->clouds();
      for (const auto& [robot, extent] : host.agent->logs().extents()) known += extent.records;
    }
    if (!is_settled || known != known_) changed_ = now;
    known_ = known;
  }

  const VirtualTeamSetup& setup_;
  const Progress& progress_;
  VirtualNetwork network_;
  std::vector<Host> hosts_;
  SharedEstimates estimates_;
  std::optional<Stamp> begin_;
  Stamp last_, changed_;
  std::uint64_t known_ = 0;  ///< records and clouds, of all agents
  std::uint64_t said_ = 0;
  TeamRun run_;
};

}  // namespace

std::unique_ptr<AgentStore> store_in_memory(const std::string& robot, std::uint32_t life) {
  return std::make_unique<MemoryStore>(robot, life);
}

std::unique_ptr<AgentStore> store_of_nothing(std::uint32_t life) {
  return std::make_unique<StoreOfNothing>(life);
}

KnownThen known_then(const Agent& agent, Stamp now, std::uint64_t said, const ErrorOf& error_of) {
  const auto frame = agent.estimate().largest_frame();
  KnownThen then{now, agent.name(), 1, frame.size()};
  std::uint64_t known = 0;
  for (const auto& [robot, extent] : agent.logs().extents()) {
    then.records[robot] = extent.records;
    known += extent.records;
  }
  if (said > 0) then.share = static_cast<double>(known) / static_cast<double>(said);
  if (error_of && !frame.empty()) then.error_m = error_of(frame);
  return then;
}

std::map<std::string, std::map<std::string, std::size_t>> refused_by(const Agent& agent) {
  std::map<std::string, std::map<std::string, std::size_t>> refused;
  for (const auto& [name, peer] : agent.peers())
    if (!peer.refused.empty()) refused[name] = peer.refused;
  return refused;
}

TeamRun run_team(const std::vector<ScriptedRobot>& robots, const VirtualTeamSetup& setup,
                 const Progress& progress) {
  return VirtualTeam(robots, setup, progress).run();
}

}  // namespace radioslam
