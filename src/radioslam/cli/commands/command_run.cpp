// radioslam run: estimates the trajectories of all robots of a mission in one frame.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/evaluation.hpp"
#include "radioslam/cli/commands/map_output.hpp"
#include "radioslam/cli/commands/mission_check.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/run_documents.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/freed_memory.hpp"
#include "radioslam/cli/online_output.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/eval/mirror_image.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/run/metrics_json.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/live/team_stream.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/report/report.hpp"
#include "radioslam/results/result_notes.hpp"

namespace radioslam::cli {
namespace {

struct RunArguments {
  std::vector<std::string> mission;  ///< one path, or several graphs
  std::string output, log;
  ParameterOptions parameters;
  StatedStarts starts = StatedStarts::kIgnored;
  bool no_prune = false;
  std::optional<std::size_t> max_verifications;
  bool unchecked = false;
  bool stream = false;
  StreamParams streaming;
  bool json = false;
};

void append(std::vector<std::string>& notes, std::vector<std::string> more) {
  for (auto& note : more) notes.push_back(std::move(note));
}

void print_run(const RunResult& result, const std::optional<TeamMetrics>& metrics,
               const std::string& output) {
  std::cout << notes_text(result.notes, names_of(result.robots)) << output << ": " << result.robots.size()
            << " robots, " << result.closures.size() << " closures, " << result.components.size()
            << (result.components.size() == 1 ? " frame" : " separate frames");
  if (metrics) std::cout << error_text(*metrics);
  std::cout << '\n';
}

/// Streams the recordings, if asked to; else nothing.
Streamed stream(const Mission& mission, const RunParams& params, const Truth& truth,
                const RunArguments& arguments) {
  if (!arguments.stream) return {};
  ProgressLine line;
  Streamed streamed{replay(mission, params.scans, params.keyframe, line.progress()), {}};
  const auto error_of = [&](const std::vector<EstimatedTrajectory>& team) -> std::optional<double> {
    if (truth.empty()) return std::nullopt;
    const auto ate = evaluate_trajectories(team, truth, mission.dimension).ate;
    return ate ? std::optional(ate->rmse_m) : std::nullopt;
  };
  streamed.team =
      stream_team(mission, streamed.robots, params, arguments.streaming, error_of, line.progress());
  return streamed;
}

RunOutput estimate(MissionInput input, const RunParams& params, const RunArguments& arguments,
                   std::vector<ReplayedRobot>& streamed) {
  ProgressLine line;
  std::vector<std::optional<TrackedScans>> tracked;
  for (ReplayedRobot& robot : streamed) tracked.push_back(std::move(robot.tracked));
  RunOptions options;
  options.pruning = arguments.no_prune ? Pruning::kOff : Pruning::kOn;
  if (arguments.max_verifications) options.verifications = VerificationBudget{*arguments.max_verifications};
  auto run = run_input(std::move(input), params, options, line.progress(), arguments.log, std::move(tracked));
  run.result.parameters = effective_parameters(params);
  return run;
}

void run_mission(const RunArguments& options) {
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto params = with_settings(RunParams{}, settings);
  refuse_replacing_inputs(options.output, options.mission);
  refuse_replacing_inputs(options.log, options.mission);
  OutputFolder output(options.output, kRunFolder);
  MissionInput input = read_input(options.mission, options.starts);
  if ((options.stream || !options.log.empty()) && !input.is_recorded())
    throw InputError(options.stream ? "--stream" : "--log", 0,
                     "is for missions: a factor graph or a log is no recording");
  const bool is_checked = !options.unchecked && std::holds_alternative<std::monostate>(input.graph);
  std::vector<std::string> notes = input.notes;
  std::vector<Finding> warnings;
  if (is_checked) warnings = warnings_about(input.mission, input.truth, options.mission.front());
  const MissionInput given = for_evaluation(input);
  const auto scanned = scans_of(input.mission);
  Streamed streamed = stream(input.mission, params, given.truth, options);
  const StreamResult events = stream_result(given.mission, streamed);
  append(notes, event_notes(events));
  RunOutput run = estimate(std::move(input), params, options, streamed.robots);
  give_back_freed_memory();
  add_maps(run.result, scanned, params, ProgressLine().progress(), output.path());
  const Agreement agreement = evaluate(run.result, given);
  append(notes, finding_notes(warnings, run.result));
  append(notes, std::move(run.result.notes));
  if (agreement.metrics && !has_mirrored_truth(warnings))
    append(notes, mirror_notes(agreement.metrics->mirror_images));
  run.result.notes = std::move(notes);
  const RunDocuments documents = documents_of(run, given, agreement, options.stream ? &events : nullptr);
  write_run(output.path(), run.result, documents);
  if (options.stream) write_online(output.path(), given.mission, streamed);
  output.commit();
  if (options.json) {
    std::cout << summary_json(run.result, documents.metrics).dump(2) << '\n';
  } else {
    if (options.stream) std::cout << stream_text(given.mission, streamed);
    print_run(run.result, agreement.metrics, options.output);
  }
}

}  // namespace

void add_run(CLI::App& program) {
  const auto options = std::make_shared<RunArguments>();
  auto* command = program.add_subcommand("run", "Estimate the trajectories of all robots in one frame");
  add_mission_option(*command, options->mission);
  add_output_option(*command, options->output, "Folder to write; the folder of an earlier run is replaced");
  add_parameter_options(*command, options->parameters);
  add_known_starts_option(*command, options->starts);
  command->add_flag("--no-prune", options->no_prune,
                    "Use all matches, including those between views that cannot overlap");
  command
      ->add_option("--max-verifications", options->max_verifications,
                   "Largest number of scans registered between robots, over all rounds: those worth most "
                   "first (default: no bound)")
      ->check(CLI::Range(std::size_t{0}, std::size_t{1000000000}))
      ->type_name("N");
  command->add_option("--log", options->log,
                      "Write what each robot would have said on its way, as <robot>.rslog, into this folder, "
                      "and estimate from that alone: scans of different robots are not compared");
  command->add_flag(
      "--stream", options->stream,
      "Feed the recordings to the robots' front ends sample by sample, in time order, estimate the team as "
      "more becomes known, and write <robot>.online.tum (keyframes where the team knew them when they were "
      "added) and online.csv as well");
  command
      ->add_option("--work-share", options->streaming.work_share,
                   "With --stream: share of one core's time, at its nominal cost, that may go into extending "
                   "the team's estimate (default: 0.02)")
      ->check(CLI::Range(1e-4, 1.0))
      ->type_name("P");
  command->add_flag(
      "--unchecked", options->unchecked,
      "Run without the checks of `radioslam doctor`, which refuse missions with certain faults");
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      "The output folder holds <robot>.tum (keyframes), dense/<robot>.tum (every odometry sample or scan),\n"
      "with LiDAR scans the team's map as map.ply, map.pgm and map.yaml (also of an earlier run: `radioslam "
      "map`),\n"
      "closures.csv, candidates.csv, uncertainty.csv, graph.g2o, summary.json and report.html.\n"
      "`radioslam parameters run` lists the parameters for --set and --config.\n\n"
      "Example:\n"
      "  radioslam run carpark -o carpark-out --set keyframe.distance_m=2");
  command->callback([options] { run_mission(*options); });
}

}  // namespace radioslam::cli
