#include "radioslam/study/distributed_optimization/distributed_study.hpp"

#include <algorithm>

#include "radioslam/study/distributed_optimization/simulated_teams.hpp"

namespace radioslam {
namespace {

struct StudiedMethod {
  std::string name;
  TeamOptimizationParams params;
};

/// Every method on a perfect network, and the one that is made for others on a bad one.
std::vector<StudiedMethod> studied_methods() {
  std::vector<StudiedMethod> methods;
  for (const DistributedMethodInfo& info : kDistributedMethods) {
    TeamOptimizationParams params;
    params.method = info.method;
    params.max_rounds = kStudyRounds;
    methods.push_back({info.name, params});
    if (info.method != DistributedMethod::kAsynchronous) continue;
    params.network.loss_share = 0.2;
    params.network.delay_rounds = 5;
    methods.push_back({std::string(info.name) + ", 20 % lost, late", params});
  }
  return methods;
}

template <class Pose>
DistributedRun run_method(const NumberedTeam<Pose>& team, const StudiedMethod& method) {
  const TeamOptimization<Pose> run = optimize_team(team.graph, team.poses, method.params);
  DistributedRun result{method.name, run.settled, team_outcome(team, run, {}), {}};
  std::size_t bytes = 0;
  for (const RoundTrace& round : run.rounds) result.bytes.push_back(bytes += round.traffic.bytes());
  return result;
}

std::optional<double> kilobytes(std::optional<std::size_t> bytes) {
  return bytes ? std::optional(1e-3 * static_cast<double>(*bytes)) : std::nullopt;
}

std::string gap_text(const TeamOutcome& outcome) {
  const auto gap = outcome.gaps.empty() ? outcome.relative_gap() : outcome.gaps.back();
  if (!gap) return "in several frames";
  const double percent = 100 * std::max(*gap, 0.0);
  return percent < 1e-4 ? "< 0.0001 %" : number_text(percent, percent < 1 ? 4 : 1) + " %";
}

}  // namespace

template <class Pose>
DistributedTeam study_distributed_team(const std::string& name, const TeamGraph<Pose>& graph,
                                       const Progress& progress) {
  const NumberedTeam<Pose> team = number_robots(graph);
  const auto& robot_of = team.poses.robot_of;
  const auto& factors = team.graph.relative_poses;
  const auto between = std::count_if(factors.begin(), factors.end(), [&](const auto& f) {
    return robot_of[f.i.index()] != robot_of[f.j.index()];
  });
  DistributedTeam study{name,
                        team.names.size(),
                        team.graph.poses.size(),
                        factors.size(),
                        std::size_t(between),
                        bytes_of_all_graphs(team),
                        {}};
  const auto methods = studied_methods();
  for (const StudiedMethod& method : methods) {
    report_progress(progress, name, double(study.runs.size()) / double(methods.size()));
    study.runs.push_back(run_method(team, method));
  }
  report_progress(progress, name, 1);
  return study;
}

std::vector<DistributedTeam> study_simulated_teams(std::uint64_t seed, const Progress& progress) {
  constexpr std::size_t kSide = 8;
  return {study_distributed_team("2 robots, laps", simulate_laps(2, seed), progress),
          study_distributed_team("4 robots, blocks", simulate_blocks(2, 2, kSide, seed), progress),
          study_distributed_team("9 robots, blocks", simulate_blocks(3, 3, kSide, seed), progress),
          study_distributed_team("10 robots, laps", simulate_laps(10, seed), progress)};
}

StudyTable distributed_table(const std::vector<DistributedTeam>& teams) {
  StudyTable table{
      "Optimization without a centre",
      "Rounds and bytes until a team's cost stays within 0.1 % of the central optimum, by every method, in "
      "at "
      "most " +
          std::to_string(kStudyRounds) + " rounds. No robot knows another one's start.",
      {"rounds to 0.1 %", "kB to 0.1 %", "of all graphs to all", "rounds", "ended", "gap at the end"},
      {},
      {"A round: at most one message to each robot that one shares factors with. Bytes are those of all "
       "robots, lost messages included. Ended: all robots stopped by themselves.",
       "Late: every message by 0 to 5 rounds."}};
  for (const DistributedTeam& team : teams) {
    for (const DistributedRun& run : team.runs) {
      const TeamOutcome& outcome = run.outcome;
      const auto rounds = outcome.rounds_to_optimum;
      const auto kb = kilobytes(outcome.bytes_to_optimum);
      const auto all = kilobytes(team.bytes_of_all_graphs);
      table.rows.push_back(
          {team.name + ", " + run.method,
           {number_text(rounds ? std::optional(double(*rounds)) : std::nullopt, 0), number_text(kb, 0),
            percent_text(kb && *all > 0 ? std::optional(*kb / *all) : std::nullopt, 0),
            std::to_string(run.bytes.size()), run.settled ? "yes" : "no", gap_text(outcome)}});
    }
    table.notes.push_back(team.name + ": " + number_text(double(team.poses), 0) + " poses, " +
                          number_text(double(team.factors), 0) + " factors, " +
                          number_text(double(team.factors_between), 0) +
                          " of them between robots; sending every robot's graph to all: " +
                          number_text(kilobytes(team.bytes_of_all_graphs), 0) + " kB.");
  }
  return table;
}

template DistributedTeam study_distributed_team(const std::string&, const TeamGraph<SE2>&, const Progress&);
template DistributedTeam study_distributed_team(const std::string&, const TeamGraph<SE3>&, const Progress&);

}  // namespace radioslam
