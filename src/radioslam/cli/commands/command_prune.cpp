// radioslam prune: finds the keyframe pairs of different robots whose views can overlap.
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/evaluation.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/run/run_tables.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam::cli {
namespace {

struct PruneOptions {
  std::vector<std::string> mission;  ///< one path, or several graphs
  std::string output;
  std::string mode;
  ParameterOptions parameters;
  StatedStarts starts = StatedStarts::kIgnored;
  bool exhaustive = false;
  bool distributed = false;
  bool json = false;
};

SearchMethod method_of(const PruneOptions& options) {
  if (options.distributed) return SearchMethod::kDistributed;
  return options.exhaustive ? SearchMethod::kExhaustive : SearchMethod::kTree;
}

/// Searches by messages between robots, and adds what sending logs would take.
RunOutput run_distributed(MissionInput input, const RunParams& params, const RunOptions& how,
                          const Progress& progress) {
  if (!std::holds_alternative<std::monostate>(input.graph))
    return run_input(std::move(input), params, how, progress);
  StageClock timed;
  const MeasuredRecordings recordings = measure_recordings(input.mission, params, how, timed, progress);
  RunOutput run = run_pipeline(input.mission, recordings, params, how, std::move(timed), progress);
  if (!run.result.exchange) return run;
  const MissionLogs logs = logs_of_recordings(input.mission, recordings, params);
  for (const RobotLog& log : logs.robots)
    run.result.exchange->log_bytes.push_back((logs.robots.size() - 1) * log.bytes().size());
  return run;
}

/// Writes candidates.csv while it searches.
RunOutput search(const PruneOptions& options, const RunParams& params, const std::filesystem::path& folder) {
  MissionInput input = read_input(options.mission, options.starts);
  ProgressLine line;
  std::vector<std::string> ids;
  for (const Robot& robot : input.mission.robots) ids.push_back(robot.id);
  CandidateWriter candidates(folder / "candidates.csv", std::move(ids));
  RunOptions how;
  how.overlap_only = true;
  how.search = method_of(options);
  how.take_candidates = [&](const CandidateList::Group& group, const CandidateList& keyframes) {
    candidates.write(group, keyframes);
  };
  const std::vector<std::string> notes = input.notes;
  auto run = options.distributed ? run_distributed(std::move(input), params, how, line.progress())
                                 : run_input(std::move(input), params, how, line.progress());
  candidates.close();
  run.result.notes.insert(run.result.notes.begin(), notes.begin(), notes.end());
  run.result.parameters = effective_parameters(params);
  return run;
}

/// What the team sent, in all and by kind, and what its logs would take.
void print_exchange(const ExchangeResult& exchange) {
  std::map<std::string, std::uint64_t> by_kind;
  std::uint64_t sent = 0, logs = 0;
  for (const auto& of_robot : exchange.bytes)
    for (const auto& [kind, bytes] : of_robot) by_kind[kind] += bytes, sent += bytes;
  for (const std::uint64_t bytes : exchange.log_bytes) logs += bytes;
  std::cout << "sent in " << exchange.rounds << " rounds: " << sent << " bytes";
  const char* mark = " (";
  for (const auto& [kind, bytes] : by_kind) std::cout << std::exchange(mark, ", ") << kind << ' ' << bytes;
  std::cout << ')';
  if (!exchange.log_bytes.empty())
    std::cout << "; every robot's log sent to all others: " << logs << " bytes";
  std::cout << '\n';
}

void print_pruned(const RunResult& result, const std::string& output) {
  std::cout << notes_text(result.notes, names_of(result.robots));
  const auto count = [&](const char* name) {
    const auto found = result.counts.find(name);
    return found == result.counts.end() ? 0LL : std::llround(found->second);
  };
  std::cout << output << ": " << count("candidates") << " of " << count("pairs")
            << " keyframe pairs can overlap, " << count("distances_evaluated") << " distances evaluated\n";
  if (result.exchange) print_exchange(*result.exchange);
}

void prune(const PruneOptions& options) {
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  auto params = with_settings(RunParams{}, settings);
  if (!options.mode.empty()) params.overlap.mode = options.mode;
  refuse_replacing_inputs(options.output, options.mission);
  OutputFolder output(options.output, kRunFolder);
  const RunOutput run = search(options, params, output.path());
  RunDocuments documents;
  documents.candidates = CandidateTable::kWritten;
  write_run(output.path(), run.result, documents);
  output.commit();
  if (options.json) {
    auto summary = summary_json(run.result);
    for (const char* name : {"pairs", "candidates", "distances_evaluated"})
      if (summary["counts"].contains(name)) summary[name] = summary["counts"][name];
    std::cout << summary.dump(2) << '\n';
  } else {
    print_pruned(run.result, options.output);
  }
}

}  // namespace

void add_prune(CLI::App& program) {
  const auto options = std::make_shared<PruneOptions>();
  auto* command =
      program.add_subcommand("prune", "Find the keyframe pairs of different robots whose views can overlap");
  add_mission_option(*command, options->mission);
  add_output_option(*command, options->output, "Folder to write; the folder of an earlier run is replaced");
  command
      ->add_option(
          "--mode", options->mode,
          "joint: use covariances of the joint estimate (default); link: chain odometry through the "
          "nearest radio link only; where no range has angles at both ends, links are relative poses "
          "of the joint estimate, and a note says so")
      ->check(CLI::IsMember({"joint", "link"}));
  add_known_starts_option(*command, options->starts);
  auto* exhaustive =
      command->add_flag("--exhaustive", options->exhaustive,
                        "Test every pair instead of searching a tree; slower, with the same result");
  command
      ->add_flag("--distributed", options->distributed,
                 "Search as robots that know their own poses alone and send each other boxes around parts of "
                 "their trajectories, with the same result; says how many bytes each sends")
      ->excludes(exhaustive);
  add_parameter_options(*command, options->parameters);
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      "The output folder holds candidates.csv, with all candidates whatever overlap.max_listed_candidates,\n"
      "the trajectories used for the search, and summary.json.\n"
      "This is the part of `run` that precedes place recognition; matches.csv is not used.\n"
      "`radioslam parameters prune` lists the parameters for --set and --config.\n\n"
      "Example: candidate pairs for your own place recognition, with a wider margin\n"
      "  radioslam prune city -o pairs --set overlap.max_mahalanobis=3");
  command->callback([options] { prune(*options); });
}

}  // namespace radioslam::cli
