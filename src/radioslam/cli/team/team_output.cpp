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

void write_result(const fs::path& folder, const RunOutput& run, const MissionInput& given,
                  const AgentsResult* agents = nullptr) {
  write_run(folder, run.result, documents_of(run, given, evaluate(run.result, given), nullptr, agents));
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

std::string known_csv(const std::vector<KnownThen>& known, Stamp begin) {
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
  write_file(folder / "known.csv", known_csv(run.known, begin));
  write_file(folder / "events.csv", events_csv(run.events, begin));
}

void read_tables(const fs::path& folder, Stamp begin, TeamRun& run) {
  const Text traffic = read_text(folder / "traffic.csv"), known = read_text(folder / "known.csv"),
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

void write_results(const TeamRun& run, const RunParams& params, const MissionInput& given,
                   const fs::path& folder, AgentFolders agents) {
  std::map<std::vector<std::pair<std::string, std::uint64_t>>, RunOutput> results;  // by what is known
  const RunOutput* most = nullptr;
  std::size_t most_records = 0;
  for (const auto& [agent, extents] : run.extents) {
    std::vector<std::pair<std::string, std::uint64_t>> known;
    std::size_t records = 0;
    for (const auto& [robot, extent] : extents) {
      known.emplace_back(robot, extent.records);
      records += extent.records;
    }
    if (records == 0) continue;
    auto found = results.find(known);
    if (found == results.end())
      found = results.emplace(std::move(known), estimate_of(run.logs.at(agent), params)).first;
    if (agents == AgentFolders::kWritten) write_result(folder / "agents" / agent, found->second, given);
    const Agreement agreement = evaluate(found->second.result, given);
    std::cout << "robot " << agent << ": " << records << " records of " << extents.size() << " robots";
    if (agreement.metrics) std::cout << error_text(*agreement.metrics);
    std::cout << '\n';
    if (records > most_records) {
      most_records = records;
      most = &found->second;
    }
  }
  if (!most) throw InputError("team", 0, "no robot has said anything");
  const AgentsResult known = agents_result(run);
  write_result(folder, *most, given, &known);
}

}  // namespace radioslam::cli
