// radioslam optimize: optimizes a pose graph in g2o or JRL format.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/distributed_optimization.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/graph/distributed/team_outcome.hpp"
#include "radioslam/graph/gauge.hpp"
#include "radioslam/graph/initial_values.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/graph/robust_optimum.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/jrl.hpp"
#include "radioslam/io/graph/keyed_poses.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/graph/team_graph_file.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam::cli {
namespace {

struct OptimizeOptions {
  std::vector<std::string> inputs;
  std::string output;
  ParameterOptions parameters;
  bool repair_information = false;
  bool certify = false;
  bool json = false;
  std::string method;  ///< of an optimization without a centre
  std::optional<double> loss_share;
  std::optional<int> delay_rounds;
  bool robust = false;
};

/// Wall times of reading, initialisation and optimization.
struct Seconds {
  double read = 0;
  double initialise = 0;
  double optimize = 0;
};

/// The results to print.
struct Report {
  std::size_t poses = 0;
  std::size_t factors = 0;
  std::size_t repaired_informations = 0;
  std::string_view start;
  std::vector<std::string> notes;   ///< on what was left out, and on parts that nothing ties together
  std::vector<double> weights;      ///< of a robust optimum, per relative pose
  std::vector<std::size_t> frames;  ///< poses of every part that nothing ties to the others
  double initial_cost = 0;          ///< at the file's vertices; at the start if some are missing
  OptimizerSummary summary;
  Seconds seconds;
};

/// Measures the seconds since the last lap, or since construction.
class Stopwatch {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

template <class Pose>
std::size_t factor_count(const PoseGraph<Pose>& graph) {
  return graph.relative_poses.size() + graph.ranges.size() + graph.bearings.size() +
         graph.relative_points.size() + graph.positions.size() + graph.pose_priors.size();
}

std::string_view start_name(InitialValues start) {
  switch (start) {
    case InitialValues::kGiven:
      return "file";
    case InitialValues::kChordal:
      return "chordal";
    case InitialValues::kSpanningTree:
      return "spanning tree";
  }
  return "";
}

/// The file's vertices are used as initial values only if every pose has one.
template <class Pose>
GivenValues given_values(const G2oGraph<Pose>& file) {
  const auto& has_value = file.pose_has_value;
  const bool complete = std::find(has_value.begin(), has_value.end(), false) == has_value.end();
  return complete ? GivenValues::kComplete : GivenValues::kNone;
}

/// The parts of a graph that nothing ties together: each keeps its first pose where it was.
template <class Pose>
void report_frames(const G2oGraph<Pose>& file, Report& report) {
  constexpr std::size_t kMaxNamed = 5;
  const auto component = connected_components(file.graph).of_pose;
  std::map<std::int32_t, std::size_t> poses;
  for (const std::int32_t first : component) ++poses[first];
  std::string named;
  for (const auto& [first, count] : poses) {
    report.frames.push_back(count);
    if (report.frames.size() <= kMaxNamed)
      named += (named.empty() ? "" : ", ") + std::to_string(count) + " from vertex " +
               std::to_string(file.pose_ids[static_cast<std::size_t>(first)]) + " on";
  }
  if (poses.size() < 2) return;
  if (poses.size() > kMaxNamed) named += ", ...";
  report.notes.push_back(std::to_string(poses.size()) +
                         " frames that nothing ties together: how they lie to one another is not measured "
                         "(poses: " +
                         named + ")");
}

/// Per relative pose, whether it may be wrong: all but the first between a pose and its robot's next one.
template <class Pose>
std::vector<bool> loop_closures(const G2oGraph<Pose>& file) {
  std::map<std::uint64_t, std::uint64_t> next;
  std::vector<std::uint64_t> sorted = file.pose_ids;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t k = 1; k < sorted.size(); ++k)
    if (robot_of_key(sorted[k - 1]) == robot_of_key(sorted[k])) next[sorted[k - 1]] = sorted[k];
  std::vector<bool> result;
  for (const auto& factor : file.graph.relative_poses) {
    const auto [from, to] = std::minmax(file.pose_ids[factor.i.index()], file.pose_ids[factor.j.index()]);
    const auto step = next.find(from);
    const bool is_step = step != next.end() && step->second == to;
    result.push_back(!is_step);
    if (is_step) next.erase(step);
  }
  return result;
}

/// Whether several robots are to find a frame by relative poses alone.
template <class Pose>
bool is_team(const TeamGraph<Pose>& team) {
  const PoseGraph<Pose>& graph = team.graph;
  const auto is_placed = [](const TrajectorySegment& segment) { return segment.in_common_frame; };
  return team.segments.front().robot != team.segments.back().robot &&
         std::count_if(team.segments.begin(), team.segments.end(), is_placed) < 2 && graph.ranges.empty() &&
         graph.bearings.empty() && graph.relative_points.empty() && graph.positions.empty();
}

/// The weights of the relative poses, and the poses, as the robots of a team agree on them without frames to
/// begin with; nothing for a graph that is no team's. Priors only choose the frame.
template <class Pose>
std::optional<std::vector<double>> agree_as_team(G2oGraph<Pose>& file, const TeamOptimizationParams& params) {
  KeyedPoses keys;
  for (const std::uint64_t id : file.pose_ids) keys.at(id);
  const AssembledTeam<Pose> assembled = keys.assemble(file.graph, StatedStarts::kPriors);
  if (!is_team(assembled.file.team)) return std::nullopt;
  NumberedTeam<Pose> team = number_robots(assembled.file.team);
  discount_repeated(team.graph);
  ProgressLine line;
  const TeamOptimization<Pose> run = optimize_team(team.graph, team.poses, params, line.progress());
  for (std::size_t k = 0; k < run.poses.size(); ++k) file.graph.poses[assembled.file_index[k]] = run.poses[k];
  std::vector<double> weights(run.weights.size());
  for (std::size_t k = 0; k < weights.size(); ++k)
    weights[assembled.relative_pose_index[k]] = run.weights[k] < 0.5 ? 0 : 1;
  if (!file.graph.pose_priors.empty()) {
    const PosePriorFactor<Pose>& prior = file.graph.pose_priors.front();
    const Pose T = prior.prior * file.graph.poses[prior.i.index()].inverse();
    for (Pose& pose : file.graph.poses) pose = T * pose;
  }
  return weights;
}

template <class Pose>
InitialCosts optimize_robustly(G2oGraph<Pose>& file, const OptimizeParams& params, Report& report) {
  const auto candidates = loop_closures(file);
  auto weights = agree_as_team(file, params.distributed);
  if (weights) report.start = "team";
  ProgressLine line;
  RobustOptimum optimum =
      weights ? optimize_with_weights(file.graph, candidates, std::move(*weights), params.optimizer,
                                      line.progress())
              : optimize_with_outliers(file.graph, candidates, params.distributed.outliers.gate,
                                       given_values(file), params.optimizer, line.progress());
  report.weights = std::move(optimum.weights);
  report.summary = std::move(optimum.summary);
  return optimum.start;
}

/// Robustly where outliers have a gate.
template <class Pose>
Report optimize_graph(G2oGraph<Pose>& file, const OptimizeParams& params) {
  Report report;
  report.poses = file.graph.poses.size();
  report.factors = factor_count(file.graph);
  report.repaired_informations = file.repaired_informations;
  Stopwatch stopwatch;
  InitialCosts costs;
  if (params.distributed.outliers.gate > 0) {
    costs = optimize_robustly(file, params, report);
  } else {
    costs = initialise(file.graph, given_values(file));
    report.seconds.initialise = stopwatch.lap();
    ProgressLine line;
    report.summary = optimize(file.graph, params.optimizer, line.progress());
  }
  if (report.start.empty()) report.start = start_name(costs.chosen);
  report.seconds.optimize = stopwatch.lap();
  report.initial_cost = costs.given.value_or(report.summary.initial_cost);
  report_frames(file, report);
  return report;
}

nlohmann::ordered_json optimum_json(const Report& report) {
  nlohmann::ordered_json json{{"initial_cost", report.initial_cost},
                              {"start_cost", report.summary.initial_cost},
                              {"final_cost", report.summary.final_cost},
                              {"iterations", report.summary.iterations},
                              {"seconds",
                               {{"read", report.seconds.read},
                                {"initialise", report.seconds.initialise},
                                {"optimise", report.seconds.optimize}}},
                              {"termination", to_string(report.summary.termination)},
                              {"certificate", nullptr},
                              {"start", report.start},
                              {"poses", report.poses},
                              {"factors", report.factors},
                              {"repaired_informations", report.repaired_informations},
                              {"frames", report.frames},
                              {"notes", report.notes},
                              {"costs", report.summary.costs}};
  if (!report.weights.empty()) json["weights"] = report.weights;
  return json;
}

void print_optimum(const Report& report, const std::string& output) {
  for (const std::string& note : report.notes) std::cout << "note: " << note << '\n';
  if (const auto rejected = std::count(report.weights.begin(), report.weights.end(), 0.0); rejected > 0)
    std::cout << "note: " << rejected << " of " << report.weights.size() << " relative poses are rejected\n";
  std::cout << output << ": " << report.poses << " poses, " << report.factors << " factors, cost "
            << report.initial_cost << " -> " << report.summary.initial_cost << " (" << report.start
            << " start) -> " << report.summary.final_cost << " in " << report.summary.iterations
            << " iterations, " << to_string(report.summary.termination) << ", "
            << report.seconds.initialise + report.seconds.optimize << " s\n";
  if (report.repaired_informations > 0) {
    std::cout << "repaired " << report.repaired_informations << " indefinite or zero information matrices\n";
  }
}

/// A team's graph has no initial values in one frame that are read: they are computed.
AnyG2oGraph without_values(const AnyTeamGraphFile& any) {
  return std::visit(
      [](const auto& file) -> AnyG2oGraph {
        auto graph = with_ids(file.team.graph, file.pose_ids, file.point_ids);
        graph.pose_has_value.assign(graph.pose_ids.size(), false);
        return graph;
      },
      any);
}

/// One graph of g2o with its VERTEX lines as the initial values, or of a team.
AnyG2oGraph read_graph(const OptimizeOptions& options, std::vector<std::string>& notes) {
  const std::string& input = options.inputs.front();
  const auto repair = options.repair_information ? RepairInformation::kYes : RepairInformation::kNo;
  if (options.inputs.size() == 1 && !is_jrl_file(input) && !is_graph_folder(input))
    return read_g2o(read_zstd_text(input), repair);
  const AnyTeamGraphFile team =
      read_team_graph({options.inputs.begin(), options.inputs.end()}, StatedStarts::kPriors, repair);
  notes = std::visit([](const auto& file) { return file.notes; }, team);
  return without_values(team);
}

/// Recorded closures are less exact than they state: a true one exceeds 28 once in ten thousand in theory.
constexpr double kRobustGate = 50;

void optimize_as_team(const OptimizeOptions& options, OptimizeParams params) {
  if (options.loss_share) params.distributed.network.loss_share = *options.loss_share;
  if (options.delay_rounds) params.distributed.network.delay_rounds = *options.delay_rounds;
  OutputFile output(options.output);
  const DistributedOutcome outcome =
      optimize_distributed({options.inputs.begin(), options.inputs.end()}, options.method, params);
  output.commit(outcome.graph);
  if (options.json)
    std::cout << outcome.json.dump(2) << '\n';
  else
    std::cout << options.output << ": " << outcome.summary << '\n';
}

void optimize_file(const OptimizeOptions& options) {
  if (options.certify)
    throw InputError("--certify", 0, "certifying global optimality is not implemented yet");
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  auto params = with_settings(OptimizeParams{}, settings);
  if (options.robust && params.distributed.outliers.gate == 0) params.distributed.outliers.gate = kRobustGate;
  refuse_replacing_inputs(options.output, {options.inputs.begin(), options.inputs.end()});
  if (!options.method.empty()) return optimize_as_team(options, params);
  if (options.loss_share || options.delay_rounds)
    throw InputError("--loss-share", 0, "losses and delays belong to --distributed");
  Stopwatch stopwatch;
  OutputFile output(options.output);
  std::vector<std::string> notes;
  auto graph = read_graph(options, notes);
  const double read_s = stopwatch.lap();
  Report report = std::visit([&](auto& file) { return optimize_graph(file, params); }, graph);
  report.seconds.read = read_s;
  report.notes.insert(report.notes.begin(), notes.begin(), notes.end());
  output.commit(std::visit([](const auto& file) { return format_g2o(file); }, graph));
  if (options.json) {
    std::cout << optimum_json(report).dump(2) << '\n';
  } else {
    print_optimum(report, options.output);
  }
}

void add_distributed_options(CLI::App& command, OptimizeOptions& options) {
  std::vector<std::string> methods;
  for (const DistributedMethodInfo& info : kDistributedMethods) methods.emplace_back(info.name);
  command
      .add_option(
          "--distributed", options.method,
          "Optimize as the team's robots would, without a centre: " + CLI::detail::join(methods, ", "))
      ->check(CLI::IsMember(methods))
      ->type_name("METHOD");
  command
      .add_option("--loss-share", options.loss_share,
                  "Share of the messages between robots that are lost; only for " +
                      methods_that_bear(&DistributedMethodInfo::bears_loss))
      ->check(number_from(0, 1));
  command
      .add_option("--delay-rounds", options.delay_rounds,
                  "Rounds by which messages are late at most, beyond the next one; only for " +
                      methods_that_bear(&DistributedMethodInfo::bears_delay))
      ->check(CLI::Range(0, 1000));
  command.add_flag("--robust", options.robust,
                   "Loop closures may be wrong (not with all --distributed methods)");
}

}  // namespace

void add_optimize(CLI::App& program) {
  const auto options = std::make_shared<OptimizeOptions>();
  auto* command = program.add_subcommand("optimize", "Optimize a pose graph in g2o or JRL format");
  command
      ->add_option("GRAPH", options->inputs,
                   "Pose graph, 2D or 3D: .g2o or .jrl, also .zst; or .g2o files, one per robot")
      ->required();
  add_output_option(*command, options->output, "Optimized graph to write, in g2o format");
  command->add_flag("--repair-information", options->repair_information,
                    "Replace indefinite information matrices by the nearest valid ones and accept zero ones");
  command->add_flag("--certify", options->certify, "Certify global optimality (not implemented yet)");
  add_distributed_options(*command, *options);
  add_json_option(*command, options->json);
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "The cost is g2o's chi2: the sum of squared Mahalanobis norms, without a factor of one half.\n"
      "Optimization starts from the cheapest of three initial estimates: the file's VERTEX lines (if "
      "complete),\n"
      "a chordal initialisation, and a spanning tree.\n"
      "In the --json output, start_cost is the cost of the chosen start and initial_cost that of the VERTEX\n"
      "lines (or of the start, if some are missing).\n"
      "`radioslam parameters optimize` lists the parameters for --set and --config.\n\n"
      "Example:\n  radioslam optimize sphere2500.g2o -o optimum.g2o --json\n"
      "  radioslam optimize 0.g2o 1.g2o 2.g2o --distributed separators -o team.g2o");
  command->callback([options] { optimize_file(*options); });
}

}  // namespace radioslam::cli
