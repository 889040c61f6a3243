#include "radioslam/cli/commands/distributed_optimization.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <variant>

#include "radioslam/cli/progress_line.hpp"
#include "radioslam/graph/distributed/team_outcome.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"

namespace radioslam::cli {
namespace {

using Json = nlohmann::ordered_json;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

template <class Pose>
void refuse_unsupported(const PoseGraph<Pose>& graph, const std::string& file) {
  if (!graph.ranges.empty() || !graph.bearings.empty() || !graph.points.empty() || !graph.positions.empty())
    throw InputError(
        file, 0,
        "optimization without a centre takes graphs of relative poses: no ranges, positions or landmarks");
}

/// Null where there is none: infinite and undefined numbers are no JSON.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <class Pose>
class OutcomeOf {
 public:
  OutcomeOf(const NumberedTeam<Pose>& team, const TeamOptimization<Pose>& run, const OptimizeParams& params)
      : team_(team),
        run_(run),
        max_rounds_(static_cast<std::size_t>(params.distributed.max_rounds)),
        outcome_(team_outcome(team, run, params.optimizer)) {}

  Json json() const {
    Json out{{"initial_cost", number((run_.rounds.empty() ? run_.start : run_.rounds.front()).cost)},
             {"final_cost", outcome_.cost},
             {"iterations", run_.rounds.size()},
             {"termination", termination()},
             {"certificate", nullptr},
             {"poses", team_.graph.poses.size()},
             {"factors", team_.graph.relative_poses.size()},
             {"robots", team_.names},
             {"rounds", run_.rounds.size()},
             {"relative_gap", number(outcome_.relative_gap())},
             {"central_cost", outcome_.central_cost},
             {"frames", frames()}};
    add_traffic(out);
    add_rounds(out);
    if (!run_.weights.empty()) out["weights"] = run_.weights;
    return out;
  }

  std::string text() const {
    std::ostringstream out;
    out << run_.rounds.size() << " rounds, cost " << outcome_.cost << ", " << outcome_.relative_gap()
        << " above the central optimum relatively; " << bytes_per_robot() << " bytes a robot";
    if (!run_.settled) out << "; the robots had not all come to an end (" << termination() << ")";
    if (frames().size() > 1)
      out << "; " << frames().size()
          << (run_.settled ? " frames that nothing ties together" : " frames so far");
    return out.str();
  }

 private:
  std::string_view termination() const {
    if (team_.graph.relative_poses.empty()) return to_string(Termination::kNothingToDo);
    if (run_.settled) return to_string(Termination::kConverged);
    return run_.rounds.size() >= max_rounds_ ? "round limit" : to_string(Termination::kNoProgress);
  }

  /// The robots of each frame.
  Json frames() const {
    std::map<std::pair<RobotNumber, std::uint32_t>, std::vector<std::string>> robots;
    for (std::size_t p = 0; p < run_.frames.size(); ++p) {
      auto& list = robots[{run_.frames[p].origin, run_.frames[p].part}];
      const std::string& name = team_.names[team_.poses.robot_of[p]];
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    }
    Json out = Json::array();
    for (const auto& [frame, names] : robots) out.push_back(names);
    return out;
  }

  double bytes_per_robot() const {
    return static_cast<double>(outcome_.traffic.bytes()) / static_cast<double>(team_.names.size());
  }

  void add_traffic(Json& out) const {
    const Traffic& sum = outcome_.traffic;
    Json kinds{{"headers", sum.header_bytes}};
    for (std::size_t k = 0; k < kSectionKinds; ++k)
      if (sum.section_bytes[k] > 0)
        kinds[std::string(to_string(static_cast<SectionKind>(k)))] = sum.section_bytes[k];
    out["bytes_per_robot"] = bytes_per_robot();
    out["bytes"] = sum.bytes();
    out["bytes_by_kind"] = kinds;
    out["bytes_of_all_graphs"] = bytes_of_all_graphs(team_);
    out["messages"] = sum.messages;
    out["messages_lost"] = sum.lost;
    out["messages_refused"] = run_.refused;
  }

  void add_rounds(Json& out) const {
    Json rounds = Json::array();
    for (std::size_t k = 0; k < run_.rounds.size(); ++k) {
      const RoundTrace& round = run_.rounds[k];
      const auto gap = outcome_.gaps[k];
      rounds.push_back({{"cost", number(round.cost)},
                        {"relative_gap", gap ? number(*gap) : Json(nullptr)},
                        {"bytes", round.traffic.bytes()},
                        {"messages", round.traffic.messages}});
    }
    const auto count = [](std::optional<std::size_t> value) { return value ? Json(*value) : Json(nullptr); };
    out["rounds_to_optimum"] = count(outcome_.rounds_to_optimum);
    out["bytes_to_optimum"] = count(outcome_.bytes_to_optimum);
    out["per_round"] = std::move(rounds);
  }

  const NumberedTeam<Pose>& team_;
  const TeamOptimization<Pose>& run_;
  std::size_t max_rounds_;
  TeamOutcome outcome_;
};

template <class Pose>
DistributedOutcome run_team(TeamGraphFile<Pose>& file, const OptimizeParams& params, double read_s) {
  NumberedTeam<Pose> team = number_robots(file.team);
  if (team.names.size() > kMaxRobots)
    throw InputError("--distributed", 0, "a team has at most " + std::to_string(kMaxRobots) + " robots");
  if (params.distributed.outliers.gate > 0) discount_repeated(team.graph);
  const auto start = std::chrono::steady_clock::now();
  ProgressLine line;
  const TeamOptimization<Pose> run =
      optimize_team(team.graph, team.poses, params.distributed, line.progress());
  const double optimize_s = seconds_since(start);
  const OutcomeOf<Pose> outcome(team, run, params);
  DistributedOutcome result{outcome.json(), outcome.text(), {}};
  result.json["seconds"] = {{"read", read_s}, {"initialise", 0.0}, {"optimise", optimize_s}};
  PoseGraph<Pose> graph = team.graph;
  graph.poses = run.poses;
  result.graph = format_g2o(with_ids(std::move(graph), file.pose_ids, file.point_ids));
  return result;
}

}  // namespace

std::string methods_that_bear(bool DistributedMethodInfo::*what) {
  std::string names;
  for (const DistributedMethodInfo& info : kDistributedMethods)
    if (info.*what) names += (names.empty() ? "" : ", ") + std::string(info.name);
  return names;
}

namespace {

const DistributedMethodInfo& method_named(const std::string& name) {
  return *std::find_if(kDistributedMethods.begin(), kDistributedMethods.end(),
                       [&](const DistributedMethodInfo& info) { return info.name == name; });
}

void refuse_unbearable(const DistributedMethodInfo& info, const NetworkParams& network) {
  const auto refuse = [&](const char* option, const char* what, bool DistributedMethodInfo::*bears) {
    throw InputError(
        option, 0,
        std::string(info.name) + " does not bear " + what + "; these do: " + methods_that_bear(bears));
  };
  if (network.loss_share > 0 && !info.bears_loss)
    refuse("--loss-share", "lost messages", &DistributedMethodInfo::bears_loss);
  if (network.delay_rounds > 0 && !info.bears_delay)
    refuse("--delay-rounds", "late messages", &DistributedMethodInfo::bears_delay);
}

}  // namespace

AnyTeamGraphFile read_distributed_team(const std::vector<std::filesystem::path>& paths) {
  AnyTeamGraphFile any = read_team_graph(paths, StatedStarts::kIgnored);
  std::visit([&](const auto& file) { refuse_unsupported(file.team.graph, paths.front().string()); }, any);
  return any;
}

DistributedOutcome optimize_distributed(const std::vector<std::filesystem::path>& paths,
                                        const std::string& method, const OptimizeParams& params) {
  OptimizeParams used = params;
  const DistributedMethodInfo& info = method_named(method);
  used.distributed.method = info.method;
  refuse_unbearable(info, used.distributed.network);
  const auto start = std::chrono::steady_clock::now();
  AnyTeamGraphFile any = read_distributed_team(paths);
  const double read_s = seconds_since(start);
  return std::visit(
      [&](auto& file) {
        DistributedOutcome outcome = run_team(file, used, read_s);
        outcome.json["method"] = method;
        outcome.json["notes"] = file.notes;
        for (const std::string& note : file.notes) outcome.summary += "\nnote: " + note;
        return outcome;
      },
      any);
}

}  // namespace radioslam::cli
