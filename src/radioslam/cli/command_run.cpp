// radioslam run: a mission becomes the trajectories of its robots in one frame.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <variant>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/judgement.hpp"
#include "radioslam/cli/mission_input.hpp"
#include "radioslam/cli/output_apart.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/g2o.hpp"
#include "radioslam/io/metrics_json.hpp"
#include "radioslam/io/run_folder.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/report/report.hpp"

namespace radioslam::cli {
namespace {

struct RunArguments {
  std::string mission;
  std::string output;
  ParameterOptions parameters;
  bool no_prune = false;
  bool json = false;
};

std::optional<TeamMetrics> judge(const RunResult& result, const Truth& truth) {
  if (truth.empty()) return std::nullopt;
  return evaluate_trajectories(team_estimate(result), truth, result.dimension);
}

RunDocuments documents_of(const RunOutput& run, const Truth& truth,
                          const std::optional<TeamMetrics>& metrics) {
  RunDocuments documents;
  if (metrics) documents.metrics = metrics_json(*metrics);
  documents.graph_g2o =
      std::visit([](const auto& graph) { return format_g2o(with_default_ids(graph)); }, run.graph);
  documents.report_html = render_report(run.result, truth.empty() ? nullptr : &truth, metrics);
  return documents;
}

/// ", position error 2.1 m rmse", and over how much of the truth where that is not all.
std::string error_text(const TeamMetrics& metrics) {
  if (!metrics.ate) return {};
  std::ostringstream text;
  text << ", position error " << metrics.ate->rmse_m << " m rmse";
  // Rounded down: what is not all never reads 100 %.
  if (metrics.coverage < 1)
    text << std::fixed << std::setprecision(1) << " over " << std::floor(1000 * metrics.coverage) / 10
         << " % of the true poses";
  return text.str();
}

void print_text(const RunResult& result, const std::optional<TeamMetrics>& metrics,
                const std::string& output) {
  for (const auto& note : result.notes) std::cout << "note: " << note << '\n';
  std::cout << output << ": " << result.robots.size() << " robots, " << result.closures.size()
            << " closures, " << result.components.size()
            << (result.components.size() == 1 ? " frame" : " separate frames");
  if (metrics) std::cout << error_text(*metrics);
  std::cout << '\n';
}

RunOutput estimate(const MissionInput& input, const RunParams& params, bool no_prune) {
  ProgressLine line;
  RunOptions options;
  options.pruning = no_prune ? Pruning::kOff : Pruning::kOn;
  auto run = run_input(input, params, options, line.progress());
  run.result.parameters = effective_parameters(params);
  return run;
}

void run_mission(const RunArguments& options) {
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto params = with_settings(RunParams{}, settings);
  refuse_replacing_inputs(options.output, {options.mission});
  OutputFolder output(options.output, kRunFolder);
  const MissionInput input = read_input(options.mission);
  const Truth& truth = input.truth;
  const RunOutput run = estimate(input, params, options.no_prune);
  const auto metrics = judge(run.result, truth);
  const RunDocuments documents = documents_of(run, truth, metrics);
  write_run(output.path(), run.result, documents);
  output.commit();
  if (options.json) {
    std::cout << summary_json(run.result, documents.metrics).dump(2) << '\n';
  } else {
    print_text(run.result, metrics, options.output);
  }
}

}  // namespace

void add_run(CLI::App& program) {
  const auto options = std::make_shared<RunArguments>();
  auto* command = program.add_subcommand("run", "Estimate every robot's trajectory in one frame");
  command
      ->add_option("MISSION", options->mission,
                   "The folder with mission.yaml, or a factor graph (.g2o, .pyfg, also .zst)")
      ->required();
  add_output_option(*command, options->output, "The folder to write; that of an earlier run is replaced");
  add_parameter_options(*command, options->parameters);
  command->add_flag("--no-prune", options->no_prune,
                    "Admit every match, also where the views cannot overlap");
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      "OUT gets <robot>.tum, dense/<robot>.tum (every odometry row or scan), closures.csv, candidates.csv,\n"
      "graph.g2o, summary.json and report.html.\n"
      "`radioslam parameters run` lists what --set and --config can change.\n\n"
      "Example:\n"
      "  radioslam run carpark -o carpark-out --set keyframe.distance_m=2");
  command->callback([options] { run_mission(*options); });
}

}  // namespace radioslam::cli
