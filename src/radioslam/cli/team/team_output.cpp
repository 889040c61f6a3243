#include "radioslam/cli/team/team_output.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>
#include <map>
#include <sstream>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/csv.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// From the logs that an agent has in the end.
RunOutput estimate_of(const std::vector<RobotLog>& logs, const RunParams& params) {
  TeamLog team;
  for (const RobotLog& log : logs) team.add(log);
  RunOutput run = run_pipeline(mission_of(team), params);
  run.result.parameters = effective_parameters(params);
  return run;
}

/// Of one agent, beside what a run says.
nlohmann::ordered_json summary_of(const std::map<std::string, LogExtent>& extents,
                                  const AgentCounts& counts) {
  nlohmann::ordered_json records, refused = nlohmann::ordered_json::object();
  for (const auto& [robot, extent] : extents) records[robot] = extent.records;
  for (const auto& [peer, reasons] : counts.refused) refused[peer] = reasons;
  return {{"records", std::move(records)},
          {"refused", std::move(refused)},
          {"bytes_sent", counts.bytes_sent},
          {"bytes_received", counts.bytes_received}};
}

/// By robot, the log of whoever has most of its last life.
std::vector<RobotLog> all_records(const TeamRun& run) {
  std::map<std::string, std::pair<LogExtent, const RobotLog*>> most;
  for (const auto& [agent, logs] : run.logs)
    for (const RobotLog& log : logs) {
      const LogExtent& extent = run.extents.at(agent).at(log.robot);
      auto& [known, of] = most[log.robot];
      if (of && std::pair(known.life, known.records) >= std::pair(extent.life, extent.records)) continue;
      known = extent;
      of = &log;
    }
  std::vector<RobotLog> all;
  for (const auto& [robot, of] : most)
    if (!of.second->records.empty()) all.push_back(*of.second);
  return all;
}

/// As the page shows it.
AgentsResult agents_result(const TeamRun& run) {
  AgentsResult result;
  for (const KnownThen& then : run.known)
    result.known.push_back({then.at, then.agent, then.share, then.error_m});
  for (const auto& [key, traffic] : run.traffic) {
    AgentsResult::Sent& sent = result.sent[kAgentMessageKinds[std::get<2>(key)]];
    sent.messages += traffic.messages;
    sent.bytes += traffic.bytes;
    sent.lost += traffic.lost;
  }
  for (const auto& [agent, event] : run.events)
    result.events.push_back({event.at, "robot " + agent + ": " + event.what});
  return result;
}

Stamp after(Stamp begin, double seconds) { return {begin.ns + Stamp::from_seconds(seconds).ns}; }

std::size_t kind_of(const CsvReader& table, std::string_view name) {
  const auto kind = std::find(std::begin(kAgentMessageKinds), std::end(kAgentMessageKinds), name);
  if (kind == std::end(kAgentMessageKinds)) table.fail("no kind of message");
  return static_cast<std::size_t>(kind - std::begin(kAgentMessageKinds));
}

}  // namespace

std::string traffic_csv(const TeamTraffic& traffic) {
  std::ostringstream table;
  table << "from,to,kind,messages,bytes,lost\n";
  for (const auto& [key, of] : traffic) {
    const auto& [from, to, kind] = key;
    table << from << ',' << to << ',' << kAgentMessageKinds[kind] << ',' << of.messages << ',' << of.bytes
          << ',' << of.lost << '\n';
  }
  return table.str();
}

std::string agents_csv(const std::vector<KnownThen>& known, Stamp begin) {
  std::ostringstream table;
  table << "t_s,agent,share,robots_in_frame,ate_m\n" << std::fixed;
  for (const KnownThen& then : known) {
    table << std::setprecision(1) << seconds_between(begin, then.at) << ',' << then.agent << ','
          << std::setprecision(4) << then.share << ',' << then.robots_in_frame << ',';
    if (then.error_m) table << *then.error_m;
    table << '\n';
  }
  return table.str();
}

std::string known_csv(const std::vector<KnownThen>& known, const std::string& agent, Stamp begin) {
  std::ostringstream table;
  table << "t_s,robot,records\n" << std::fixed << std::setprecision(1);
  for (const KnownThen& then : known)
    for (const auto& [robot, records] : then.records)
      if (then.agent == agent)
        table << seconds_between(begin, then.at) << ',' << robot << ',' << records << '\n';
  return table.str();
}

std::string events_csv(const std::vector<std::pair<std::string, TeamEvent>>& events, Stamp begin) {
  std::ostringstream table;
  table << "t_s,agent,event\n" << std::fixed << std::setprecision(1);
  for (const auto& [agent, event] : events) {
    std::string what = event.what;
    std::replace(what.begin(), what.end(), '"', '\'');
    table << seconds_between(begin, event.at) << ',' << agent << ",\"" << what << "\"\n";
  }
  return table.str();
}

std::optional<double> team_error_m(const std::vector<EstimatedTrajectory>& team, const Truth& truth,
                                   int dimension) {
  if (truth.empty()) return std::nullopt;
  const auto ate = evaluate_trajectories(team, truth, dimension).ate;
  return ate ? std::optional(ate->rmse_m) : std::nullopt;
}

void write_tables(const fs::path& folder, const TeamRun& run, Stamp begin) {
  write_file(folder / "traffic.csv", traffic_csv(run.traffic));
  write_file(folder / "agents.csv", agents_csv(run.known, begin));
  write_file(folder / "events.csv", events_csv(run.events, begin));
}

void read_tables(const fs::path& folder, Stamp begin, TeamRun& run) {
  const Text traffic = read_text(folder / "traffic.csv"), known = read_text(folder / "agents.csv"),
             events = read_text(folder / "events.csv");
  CsvReader sent(traffic, {{"from", "to", "kind", "messages", "bytes", "lost"}});
  while (sent.next()) {
    LinkTraffic& of =
        run.traffic[{std::string(sent.field(0)), std::string(sent.field(1)), kind_of(sent, sent.field(2))}];
    of = {static_cast<std::size_t>(sent.number(3)), static_cast<std::size_t>(sent.number(4)),
          static_cast<std::size_t>(sent.number(5))};
  }
  CsvReader knew(known, {{"t_s", "agent", "share", "robots_in_frame", "ate_m"}});
  while (knew.next()) {
    KnownThen& then = run.known.emplace_back();
    then = {after(begin, knew.number(0)), std::string(knew.field(1)), knew.number(2),
            static_cast<std::size_t>(knew.number(3))};
    if (knew.given(4)) then.error_m = knew.number(4);
  }
  CsvReader noticed(events, {{"t_s", "agent", "event"}});
  while (noticed.next())
    run.events.emplace_back(noticed.field(1),
                            TeamEvent{after(begin, noticed.number(0)), std::string(noticed.field(2))});
  std::stable_sort(run.known.begin(), run.known.end(),
                   [](const auto& a, const auto& b) { return a.at < b.at; });
  std::stable_sort(run.events.begin(), run.events.end(),
                   [](const auto& a, const auto& b) { return a.second.at < b.second.at; });
}

namespace {

/// Estimates from logs; those of the same records are made once.
class Results {
 public:
  Results(const RunParams& params, const MissionInput& given) : params_(params), given_(given) {}

  const RunOutput& of(const std::vector<RobotLog>& logs) {
    std::vector<std::pair<std::string, std::size_t>> key;
    for (const RobotLog& log : logs)
      if (!log.records.empty()) key.emplace_back(log.robot, log.records.size());
    auto found = made_.find(key);
    if (found == made_.end()) found = made_.emplace(std::move(key), estimate_of(logs, params_)).first;
    return found->second;
  }

  void write(const fs::path& folder, const RunOutput& run, const AgentsResult* agents,
             nlohmann::ordered_json summary = nullptr) const {
    RunDocuments documents = documents_of(run, given_, evaluate(run.result, given_), nullptr, agents);
    documents.summary = std::move(summary);
    write_run(folder, run.result, documents);
  }

  /// In a line, how well the records of an agent do.
  void say(const std::string& agent, std::size_t records, std::size_t robots, const RunOutput& run) const {
    const Agreement agreement = evaluate(run.result, given_);
    std::cout << "robot " << agent << ": " << records << " records of " << robots << " robots";
    if (agreement.metrics) std::cout << error_text(*agreement.metrics);
    std::cout << '\n';
  }

 private:
  const RunParams& params_;
  const MissionInput& given_;
  std::map<std::vector<std::pair<std::string, std::size_t>>, RunOutput> made_;
};

std::size_t records_of(const std::map<std::string, LogExtent>& extents) {
  std::size_t records = 0;
  for (const auto& [robot, extent] : extents) records += extent.records;
  return records;
}

}  // namespace

void write_results(const TeamRun& run, const RunParams& params, const MissionInput& given,
                   const fs::path& folder, AgentFolders agents, Stamp begin) {
  const std::vector<RobotLog> all = all_records(run);
  if (all.empty()) throw InputError("team", 0, "no robot has said anything");
  Results results(params, given);
  for (const auto& [agent, extents] : run.extents) {
    const std::size_t records = records_of(extents);
    if (records == 0) continue;
    const RunOutput& of = results.of(run.logs.at(agent));
    results.say(agent, records, extents.size(), of);
    if (agents == AgentFolders::kThere) continue;
    const fs::path own = folder / "agents" / agent;
    results.write(own, of, nullptr, summary_of(extents, run.counts.at(agent)));
    write_file(own / "known.csv", known_csv(run.known, agent, begin));
  }
  const AgentsResult known = agents_result(run);
  results.write(folder, results.of(all), &known);
}

void write_agent(const TeamRun& run, const std::string& agent, const RunParams& params,
                 const MissionInput& given, const fs::path& folder, Stamp begin) {
  const auto& extents = run.extents.at(agent);
  if (records_of(extents) == 0) throw InputError("agent", 0, "no robot has said anything");
  Results results(params, given);
  const RunOutput& of = results.of(run.logs.at(agent));
  results.say(agent, records_of(extents), extents.size(), of);
  const AgentsResult known = agents_result(run);
  results.write(folder, of, &known, summary_of(extents, run.counts.at(agent)));
  write_file(folder / "known.csv", known_csv(run.known, agent, begin));
}

}  // namespace radioslam::cli
