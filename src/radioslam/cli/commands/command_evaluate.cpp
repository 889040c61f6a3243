// radioslam evaluate: compares a run with the ground truth of its mission.
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/evaluated_estimate.hpp"
#include "radioslam/cli/commands/evaluation.hpp"
#include "radioslam/cli/commands/mission_check.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/doctor/check_mission.hpp"
#include "radioslam/eval/closures.hpp"
#include "radioslam/eval/measurement_truth.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/eval/mirror_image.hpp"
#include "radioslam/io/run/metrics_json.hpp"
#include "radioslam/io/run/run_folder.hpp"

namespace radioslam::cli {
namespace {

constexpr double kMaxRadius_m = 1e6;

struct EvaluateOptions {
  std::string run;
  std::vector<std::string> mission;  ///< one path, several graphs, or none
  std::vector<std::string> truths;   ///< ROBOT=FILE
  std::optional<double> radius_m;
  bool evo = false;
  bool json = false;
};

/// The results of the comparison.
struct Evaluation {
  TeamMetrics metrics;
  std::optional<TeamMetrics> dead_reckoning;  ///< if every robot's start is known
  PairCounts candidates;
  bool has_mission = true;             ///< pairs and closures are compared with its measurements
  bool looked_for_candidates = false;  ///< whether the run searched for candidates at all
  nlohmann::ordered_json found,
      listed;  ///< how many candidates the run says it found and listed; null: it does not
  AccessPointErrors access_points;
  PairCounts closures;
  ClosuresByKind by_kind;  ///< compared with the truth
  long accepted = 0;
  long rejected = 0;
  std::vector<std::string> notes;
};

/// The mission's index of each of the run's robots.
std::vector<RobotIndex> places_in_mission(const RunFolder& run, const Mission& mission,
                                          const EvaluateOptions& options) {
  std::vector<RobotIndex> places;
  for (const auto& robot : run.robots) {
    const auto same = [&](const Robot& candidate) { return candidate.id == robot.id; };
    const auto found = std::find_if(mission.robots.begin(), mission.robots.end(), same);
    if (found == mission.robots.end()) {
      throw InputError(options.run, 0,
                       "robot '" + robot.id + "' is not in " +
                           (options.mission.empty() ? "the mission" : options.mission.front()));
    }
    places.emplace_back(static_cast<std::size_t>(found - mission.robots.begin()));
  }
  return places;
}

std::vector<ClosureResult> with_places(std::vector<ClosureResult> pairs,
                                       const std::vector<RobotIndex>& places) {
  for (auto& pair : pairs) {
    pair.robot_i = places[pair.robot_i.index()];
    pair.robot_j = places[pair.robot_j.index()];
  }
  return pairs;
}

std::vector<KeyframeStamps> keyframe_stamps(const RunFolder& run, const std::vector<RobotIndex>& places,
                                            std::size_t robots) {
  std::vector<KeyframeStamps> stamps(robots);
  for (std::size_t i = 0; i < run.robots.size(); ++i)
    stamps[places[i].index()] = run.robots[i].poses.stamps();
  return stamps;
}

/// A number of a section of the run's summary; null if it is not there.
nlohmann::ordered_json number_in(const RunFolder& run, const char* section, const char* name) {
  if (!run.summary.is_object()) return nullptr;
  const auto numbers = run.summary.find(section);
  if (numbers == run.summary.end() || !numbers->is_object()) return nullptr;
  const auto number = numbers->find(name);
  return number != numbers->end() && number->is_number() ? *number : nlohmann::ordered_json();
}

/// The run's own criterion, unless a radius is given.
PairTruth true_pairs(const Mission& mission, const Truth& truth, const RunFolder& run,
                     std::optional<double> radius_m) {
  const auto parameter = [&](const char* name) {
    const auto number = number_in(run, "parameters", name);
    return number.is_number() ? number.get<double>() : 0.0;
  };
  const double of_run = parameter("overlap.radius_m");
  if (!radius_m && of_run > 0) radius_m = of_run;
  return pair_truth(mission, truth, radius_m, parameter("overlap.min_shared_view"));
}

void count_pairs(Evaluation& evaluation, const RunFolder& run, const Mission& mission,
                 const std::vector<RobotIndex>& places, const PairTruth& truth, const FileLoops& file) {
  const auto closures = with_places(run.closures, places);
  CandidateList candidates = run.candidates.value_or(CandidateList());
  candidates.renumber_robots(places);
  evaluation.candidates =
      count_candidates(keyframe_stamps(run, places, truth.views.size()), candidates, truth);
  evaluation.looked_for_candidates = run.candidates.has_value();
  evaluation.closures = count_closures(closures, truth);
  evaluation.accepted = std::count_if(closures.begin(), closures.end(), [](const ClosureResult& closure) {
    return closure.status == ClosureStatus::kAccepted;
  });
  evaluation.rejected = static_cast<long>(closures.size()) - evaluation.accepted;
  evaluation.by_kind = compare_closures_with_truth(closures, keyframe_stamps(run, places, truth.views.size()),
                                                   mission, truth.truth, run.aoa_measurements, file);
}

/// The mission, with the truth that is given for robots of the estimate.
MissionInput read_compared(const EvaluateOptions& options, const EvaluatedEstimate& estimate) {
  MissionInput input;
  if (!options.mission.empty()) input = read_input(options.mission);
  if (!options.truths.empty()) use_given_truth(options.truths, estimate, input);
  if (input.truth.empty() && input.loops.labels.empty())
    throw InputError(
        options.mission.front(), 0,
        "has no ground truth (a robot's groundtruth.tum, VERTEX lines of .pyfg, groundtruth of .jrl)");
  return input;
}

Evaluation evaluate(const EvaluateOptions& options) {
  if (options.mission.empty() && options.truths.empty())
    throw InputError("evaluate", 0, "needs a mission with ground truth, or --truth ROBOT=FILE");
  EvaluatedEstimate estimated = read_estimate(options.run);
  const RunFolder& run = estimated.run;
  const MissionInput input = read_compared(options, estimated);
  const Mission& mission = input.mission;
  const Truth& truth = input.truth;
  const auto places = places_in_mission(run, mission, options);
  const auto association = options.evo ? Association::kNearest : Association::kInterpolate;

  Evaluation evaluation;
  evaluation.has_mission = !options.mission.empty();
  evaluation.notes = std::move(estimated.notes);
  evaluation.found = number_in(run, "counts", "candidates");
  evaluation.listed = number_in(run, "counts", "candidates_listed");
  if (evaluation.listed.is_number() && evaluation.listed < evaluation.found)
    evaluation.notes.push_back("candidates.csv lists the most probable " + evaluation.listed.dump() + " of " +
                               evaluation.found.dump() +
                               " candidates: kept and true_kept count these alone, not what the run found");
  const auto estimate = in_common_frame(run.robots, run.components, run.unplaced);
  evaluation.metrics = evaluate_trajectories(estimate, truth, mission.dimension, association);
  const std::vector<Finding> findings = check_truth(mission, truth);
  for (const Finding& finding : findings) evaluation.notes.push_back(text_of(finding));
  if (!has_mirrored_truth(findings))
    for (auto& note : mirror_notes(evaluation.metrics.mirror_images))
      evaluation.notes.push_back(std::move(note));
  const auto odometry = dead_reckoning(mission);
  if (!odometry.empty()) {
    evaluation.dead_reckoning = evaluate_trajectories(odometry, truth, mission.dimension, association);
  }
  evaluation.access_points =
      access_point_errors(run.access_points, mission, evaluation.metrics.T_truth_estimate);
  if (evaluation.has_mission)
    count_pairs(evaluation, run, mission, places, true_pairs(mission, truth, run, options.radius_m),
                input.loops);
  return evaluation;
}

nlohmann::ordered_json evaluation_json(const Evaluation& evaluation) {
  auto json = metrics_json(evaluation.metrics);
  if (!evaluation.has_mission) {
    json["notes"] = evaluation.notes;
    return json;
  }
  json["candidates"] = pair_counts_json(evaluation.candidates);
  if (!evaluation.looked_for_candidates)
    for (const char* key : {"kept", "true_kept"}) json["candidates"][key] = nullptr;
  json["candidates"]["found"] = evaluation.found;
  json["candidates"]["listed"] = evaluation.listed;
  json["closures"] = pair_counts_json(evaluation.closures);
  json["closures"]["accepted"] = evaluation.accepted;
  json["closures"]["rejected"] = evaluation.rejected;
  json["closures"].update(closures_by_kind_json(evaluation.by_kind));
  json["access_points"] = access_point_errors_json(evaluation.access_points);
  json["dead_reckoning"] = nullptr;
  if (evaluation.dead_reckoning) json["dead_reckoning"] = metrics_json(*evaluation.dead_reckoning);
  json["notes"] = evaluation.notes;
  return json;
}

void print_evaluation(const Evaluation& evaluation) {
  std::cout << notes_text(evaluation.notes, names_of(evaluation.metrics.robots))
            << metrics_table(evaluation.metrics);
  if (!evaluation.has_mission) return;
  if (evaluation.dead_reckoning && evaluation.dead_reckoning->ate) {
    std::cout << "dead reckoning alone: " << evaluation.dead_reckoning->ate->rmse_m << " m rmse\n";
  }
  if (const AccessPointErrors& points = evaluation.access_points; points.known > 0) {
    std::cout << "access points: " << points.located << " of " << points.known << " known ones located";
    if (points.errors)
      std::cout << ", " << points.errors->median_m << " m from their stated positions in the median, "
                << points.errors->p90_m << " m p90";
    std::cout << '\n';
  }
  std::cout << "closures: " << evaluation.accepted << " accepted, " << evaluation.rejected << " rejected"
            << (evaluation.by_kind.empty() ? "" : "; true: the measurement agrees with the truth") << '\n'
            << closures_by_kind_text(evaluation.by_kind);
  if (evaluation.closures.kept > 0)
    std::cout << "  between robots: " << evaluation.closures.kept << " accepted, "
              << evaluation.closures.true_kept << " of them between keyframes with overlapping views\n";
}

void evaluate_run(const EvaluateOptions& options) {
  const Evaluation evaluation = evaluate(options);
  if (options.json) {
    std::cout << evaluation_json(evaluation).dump(2) << '\n';
  } else {
    print_evaluation(evaluation);
  }
}

}  // namespace

void add_evaluate(CLI::App& program) {
  const auto options = std::make_shared<EvaluateOptions>();
  auto* command = program.add_subcommand("evaluate", "Compare a run with the ground truth of its mission");
  command
      ->add_option("OUT", options->run,
                   "Output folder of `radioslam run`, a folder of .tum files, or a .g2o file, as `optimize` "
                   "writes it")
      ->required();
  command->add_option("MISSION", options->mission,
                      "Mission folder with robots/<id>/groundtruth.tum, or a factor graph (as for `run`)");
  command
      ->add_option("--truth", options->truths,
                   "True poses of a robot of OUT, a TUM file, with or instead of a mission (in a .g2o file, "
                   "robots are the letters of the ids, and a pose's time is its index in seconds)")
      ->type_name("ROBOT=FILE");
  command
      ->add_option(
          "--radius", options->radius_m,
          "Keyframe pairs closer than this truly overlap (default: as in the run, those whose views "
          "share overlap.min_shared_view; if that is 0, closer than the sum of the two LiDAR ranges)")
      ->check(number_from(0, kMaxRadius_m))
      ->type_name("M");
  command->add_flag(
      "--evo", options->evo,
      "Associate poses by the nearest stamp within 0.01 s, as evo does, instead of interpolating");
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      "The estimate is interpolated at the stamps of the ground truth, after one rigid alignment of the "
      "whole\n"
      "team. A groundtruth.tum in which every orientation is the identity is treated as a list of "
      "waypoints:\n"
      "its orientations are ignored in the relative error.\n"
      "In the --json output, candidates.kept is null if the run did not search for candidates.\n\n"
      "Example:\n  radioslam evaluate carpark-out carpark --json\n"
      "  radioslam evaluate optimum.g2o --truth a=first.tum b=second.tum");
  command->callback([options] { evaluate_run(*options); });
}

}  // namespace radioslam::cli
