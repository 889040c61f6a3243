#include "radioslam/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/report/access_point_data.hpp"
#include "radioslam/report/aoa_data.hpp"
#include "radioslam/report/closure_data.hpp"
#include "radioslam/report/embedded_data.hpp"
#include "radioslam/report/map_data.hpp"
#include "radioslam/report/page_parts.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/report/trajectory_data.hpp"
#include "radioslam/results/note_groups.hpp"

namespace radioslam {
namespace {

// Page data: everything the report page shows as one JSON object, with a fixed key order and rounded numbers.
// Metres are rounded to 1 mm, times to 1 ms relative to `start_s`; positions are in the truth's frame if
// there are metrics, else in the estimate's. Columns rather than rows: {"x": [...], "y": [...]}. Unknown
// values are null or absent.

// Page data of the other hypotheses of the team alignment, drawn as faint lines next to the most likely one.

/// [{"weight", "ate_rmse_m" if the truth is known, "robots": [{"x", "y", "z" in space}]}], most likely first;

PageData path(const Trajectory<SE3>& poses, std::size_t limit, const TrajectoryContext& context) {
  PageData x = PageData::array(), y = x, z = x;
  for (const std::size_t k : evenly_spaced(poses.size(), limit)) {
    const Eigen::Vector3d p = context.T_page_estimate * poses[k].pose.translation();
    x.push_back(rounded(p.x(), 2));
    y.push_back(rounded(p.y(), 2));
    z.push_back(rounded(p.z(), 2));
  }
  PageData data{{"x", std::move(x)}, {"y", std::move(y)}};
  if (context.dimension == 3) data["z"] = std::move(z);
  return data;
}

std::size_t poses_of_all(const std::vector<HypothesisResult>& alternatives) {
  std::size_t poses = 0;
  for (const HypothesisResult& other : alternatives)
    for (const RobotResult& robot : other.robots) poses += robot.estimate.size();
  return poses;
}

/// paths thinned to the budget, in the frame of the page, in which the most likely hypothesis is drawn.
PageData alternative_data(const RunResult& result, const TrajectoryContext& context,
                          const ReportParams& params) {
  const auto budget = static_cast<std::size_t>(std::max(params.max_alternative_poses, 2));
  const std::size_t total = poses_of_all(result.alternatives);
  PageData list = PageData::array();
  for (const HypothesisResult& other : result.alternatives) {
    PageData robots = PageData::array();
    for (const RobotResult& robot : other.robots)
      robots.push_back(path(robot.estimate, part_of_budget(robot.estimate.size(), total, budget), context));
    PageData data{{"weight", rounded(other.weight, 4)}, {"robots", std::move(robots)}};
    if (const Truth* truth = context.evaluation.truth) {
      const auto metrics =
          evaluate_trajectories(team_estimate(other.robots, result), *truth, context.dimension);
      data["ate_rmse_m"] = metrics.ate ? rounded_metres(metrics.ate->rmse_m) : PageData();
    }
    list.push_back(std::move(data));
  }
  return list;
}

constexpr std::size_t kQuantileSteps = 200;

/// The earliest stamp of any robot, at which the page's time starts.
Stamp first_stamp(const RunResult& result) {
  std::optional<Stamp> first;
  for (const auto& robot : result.robots)
    if (!robot.estimate.empty() && (!first || robot.estimate.front().stamp < *first))
      first = robot.estimate.front().stamp;
  return first.value_or(Stamp{});
}

/// Evaluates dead reckoning by the same rules as the estimate, with its own alignment of the whole team.
/// Empty if a start is unknown, since odometry alone then has no common frame.
TeamMetrics evaluate_dead_reckoning(const RunResult& result, const Truth& truth) {
  std::vector<EstimatedTrajectory> odometry;
  for (const auto& robot : result.robots) odometry.push_back({robot.id, robot.odometry});
  const auto known = [](const RobotResult& robot) { return robot.start_known; };
  if (!std::all_of(result.robots.begin(), result.robots.end(), known)) odometry.clear();
  return evaluate_trajectories(odometry, truth, result.dimension);
}

std::size_t component_of(const RobotResult& robot, const std::vector<Component>& components) {
  for (std::size_t c = 0; c < components.size(); ++c) {
    const auto& members = components[c].robots;
    if (std::find(members.begin(), members.end(), robot.id) != members.end()) return c;
  }
  return 0;
}

/// Error quantiles at kQuantileSteps + 1 equal steps, from the smallest to the largest error.
PageData error_quantiles(const TeamMetrics& metrics) {
  std::vector<double> errors;
  for (const auto& robot : metrics.robots)
    for (const auto& error : robot.errors) errors.push_back(error.error_m);
  std::sort(errors.begin(), errors.end());
  PageData quantiles = PageData::array();
  if (errors.empty()) return quantiles;
  for (std::size_t q = 0; q <= kQuantileSteps; ++q)
    quantiles.push_back(rounded_metres(errors[q * (errors.size() - 1) / kQuantileSteps]));
  return quantiles;
}

PageData accuracy_data(const Evaluation& evaluation) {
  const TeamMetrics& estimate = *evaluation.estimate;
  const TeamMetrics& odometry = *evaluation.dead_reckoning;
  PageData data{{"ate", statistics_data(estimate.ate)},
                {"dead_reckoning", statistics_data(odometry.ate)},
                {"coverage", rounded(estimate.coverage, 4)},
                {"quantiles_m", error_quantiles(estimate)},
                {"dead_reckoning_quantiles_m", error_quantiles(odometry)}};
  if (estimate.ate && odometry.ate && odometry.ate->rmse_m > 0)
    data["ratio"] = rounded_relative(estimate.ate->rmse_m / odometry.ate->rmse_m);
  if (estimate.team_consistency)
    data["share_within_3_sigma"] = rounded(estimate.team_consistency->share_within_3_sigma, 4);
  if (estimate.rpe)
    data["rpe"] = {{"translation_rmse_m", rounded(estimate.rpe->translation_rmse_m, 4)},
                   {"rotation_rmse_rad", rounded(estimate.rpe->rotation_rmse_rad, 5)},
                   {"count", estimate.rpe->count}};
  return data;
}

PageData similarity_data(const SimilarityModelResult& model, const ReportParams& params) {
  PageData bins = PageData::array(), similarity = bins, distance = bins;
  for (const auto& bin : model.bins)
    bins.push_back({{"similarity", rounded(bin.similarity, 4)},
                    {"distance_m", rounded_metres(bin.distance_m)},
                    {"sigma_m", rounded_metres(bin.sigma_m)},
                    {"samples", bin.samples}});
  const auto limit = static_cast<std::size_t>(std::max(params.max_samples, 2));
  for (const std::size_t i : evenly_spaced(model.samples.size(), limit)) {
    similarity.push_back(rounded(model.samples[i].first, 4));
    distance.push_back(rounded_metres(model.samples[i].second));
  }
  return {{"measure", model.measure},
          {"bins", std::move(bins)},
          {"samples", model.samples.size()},
          {"drawn", {{"similarity", std::move(similarity)}, {"distance_m", std::move(distance)}}}};
}

void add_robots(PageData& page, const RunResult& result, const Evaluation& evaluation,
                const ReportParams& params) {
  TrajectoryContext context{result.dimension, first_stamp(result), SE3(), count_totals(result, evaluation),
                            evaluation};
  if (evaluation.estimate != nullptr) context.T_page_estimate = evaluation.estimate->T_truth_estimate;
  DrawnKeyframes keyframes;
  page["robots"] = PageData::array();
  for (const auto& robot : result.robots) {
    keyframes.push_back(drawn_keyframes(robot, context.totals, params));
    page["robots"].push_back(robot_data(robot, component_of(robot, result.components), context, params));
  }
  page["maps"] = map_data(result, context.T_page_estimate, context.start);
  page["closures"] = closure_data(result, keyframes, params);
  page["alternatives"] = alternative_data(result, context, params);
}

/// Integers stay exact, however large.
PageData counted(double count) {
  return std::trunc(count) == count ? rounded(count, 0) : rounded_relative(count);
}

/// Transforms relative to the first robot of each component.
PageData transform_data(const RunResult& result) {
  PageData data = PageData::array();
  const auto is_first = [&](const std::string& id) {
    return std::any_of(result.components.begin(), result.components.end(),
                       [&](const Component& component) { return component.robots.front() == id; });
  };
  for (const auto& transform : result.transforms) {
    if (!is_first(transform.robot_i)) continue;
    const Eigen::Vector3d t = transform.T_i_j.translation();
    const Eigen::VectorXd variance = transform.covariance.diagonal().cwiseMax(0);
    data.push_back({{"robot_i", transform.robot_i},
                    {"robot_j", transform.robot_j},
                    {"translation_m", {rounded(t.x(), 4), rounded(t.y(), 4), rounded(t.z(), 4)}},
                    {"yaw_rad", rounded(transform.T_i_j.yaw(), 6)},
                    {"sigma_position_m", rounded(std::sqrt(variance.head(result.dimension).mean()), 4)},
                    {"sigma_yaw_rad", rounded(std::sqrt(variance[variance.size() - 1]), 6)}});
  }
  return data;
}

/// A list of notes per kind.
PageData note_data(const RunResult& result) {
  std::vector<std::string> robots;
  for (const RobotResult& robot : result.robots) robots.push_back(robot.id);
  PageData data = PageData::array();
  for (const NoteGroup& group : grouped_notes(result.notes, robots)) data.push_back(group.notes);
  return data;
}

void add_run(PageData& page, const RunResult& result, const ReportParams& params) {
  page["components"] = PageData::array();
  for (const auto& component : result.components) page["components"].push_back(component.robots);
  page["unplaced"] = result.unplaced;
  page["transforms"] = transform_data(result);
  page["range_biases"] = PageData::array();
  for (const auto& bias : result.range_biases)
    page["range_biases"].push_back({{"end_i", bias.end_i},
                                    {"end_j", bias.end_j},
                                    {"bias_m", rounded(bias.bias_m, 4)},
                                    {"sigma_m", rounded(bias.sigma_m, 4)},
                                    {"ranges", bias.ranges}});
  page["angle_checks"] = PageData::array();
  for (const auto& check : result.angle_checks)
    page["angle_checks"].push_back({{"receiver", check.receiver},
                                    {"transmitter", check.transmitter},
                                    {"pose", check.pose == CheckedPose::kSelfReported ? "claim" : "estimate"},
                                    {"measurements", check.measurements},
                                    {"median_weight", rounded(check.median_weight, 3)},
                                    {"share_beyond", rounded(check.outlier_ratio, 3)},
                                    {"contradicted", check.contradicted}});
  page["weight"] = rounded(result.weight, 4);
  page["candidates"] = candidate_data(result, params);
  page["counts"] = PageData::object();
  for (const auto& [key, count] : result.counts) page["counts"][key] = counted(count);
  page["timings"] = PageData::array();
  for (const auto& timing : result.timings)
    page["timings"].push_back({{"stage", timing.stage}, {"seconds", rounded(timing.seconds, 6)}});
  page["parameters"] = PageData::array();
  for (const auto& parameter : result.parameters)
    page["parameters"].push_back({{"key", parameter.key},
                                  {"value", parameter.value},
                                  {"unit", parameter.unit},
                                  {"meaning", parameter.description},
                                  {"changed", parameter.changed}});
  page["notes"] = note_data(result);
}

/// {"estimates": [{"t", "effort", "frames", "error_m"}], "events": [{"t", "what", "join"}]}
PageData stream_data(const StreamResult& stream, Stamp start) {
  const auto time = [&](Stamp at) { return rounded_seconds(seconds_between(start, at)); };
  PageData estimates = PageData::array(), events = estimates;
  for (const auto& estimate : stream.estimates)
    estimates.push_back({{"t", time(estimate.at)},
                         {"effort", estimate.effort},
                         {"frames", estimate.frames},
                         {"error_m", estimate.error_m ? rounded_metres(*estimate.error_m) : PageData()}});
  for (const auto& event : stream.events)
    events.push_back({{"t", time(event.at)}, {"what", event.what}, {"join", event.is_join}});
  return {{"estimates", std::move(estimates)}, {"events", std::move(events)}};
}

/// {"known": [{"t", "agent", "share", "error_m"}], "sent": [{"kind", "messages", "bytes", "lost"}], "events":
/// [{"t", "what"}]}
PageData agents_data(const AgentsResult& agents, Stamp start) {
  const auto time = [&](Stamp at) { return rounded_seconds(seconds_between(start, at)); };
  PageData known = PageData::array(), sent = known, events = known;
  for (const auto& then : agents.known)
    known.push_back({{"t", time(then.at)},
                     {"agent", then.agent},
                     {"share", rounded_metres(then.share)},
                     {"error_m", then.error_m ? rounded_metres(*then.error_m) : PageData()}});
  for (const auto& [kind, of] : agents.sent)
    sent.push_back({{"kind", kind}, {"messages", of.messages}, {"bytes", of.bytes}, {"lost", of.lost}});
  for (const auto& event : agents.events) events.push_back({{"t", time(event.at)}, {"what", event.what}});
  return {{"known", std::move(known)}, {"sent", std::move(sent)}, {"events", std::move(events)}};
}

PageData page_data(const RunResult& result, const Truth* truth, const std::optional<TeamMetrics>& metrics,
                   const ClosuresByKind& compared_closures, const ReportParams& params) {
  PageData page{{"format", "radioslam-report/1"},
                {"mission", result.mission_name},
                {"dimension", result.dimension},
                {"start_s", rounded_seconds(first_stamp(result).seconds())}};
  const bool evaluated = truth != nullptr && !truth->empty() && metrics && metrics->ate;
  page["frame"] = evaluated ? "truth" : "estimate";
  std::optional<TeamMetrics> dead_reckoning;
  Evaluation evaluation;
  if (evaluated) {
    dead_reckoning = evaluate_dead_reckoning(result, *truth);
    evaluation = {truth, &*metrics, &*dead_reckoning};
    page["accuracy"] = accuracy_data(evaluation);
  }
  add_robots(page, result, evaluation, params);
  page["closures"]["compared"] = compared_closure_data(compared_closures);
  page["places"] = place_data(result, compared_closures);
  if (result.similarity_model) page["similarity"] = similarity_data(*result.similarity_model, params);
  if (!result.aoa_measurements.empty())
    page["aoa_measurements"] = aoa_data(result, first_stamp(result), evaluation.truth, params);
  if (!result.access_points.empty())
    page["access_points"] =
        access_point_data(result, evaluated ? evaluation.estimate->T_truth_estimate : SE3(), params);
  if (!result.signals.empty()) page["signals"] = signal_data(result, first_stamp(result), params);
  add_run(page, result, params);
  return page;
}

}  // namespace

std::string render_report(const RunResult& result, const Truth* truth,
                          const std::optional<TeamMetrics>& metrics, const ClosuresByKind& compared_closures,
                          const ReportParams& params, const StreamResult* stream,
                          const AgentsResult* agents) {
  PageData page = page_data(result, truth, metrics, compared_closures, params);
  if (stream) page["stream"] = stream_data(*stream, first_stamp(result));
  if (agents) page["agents"] = agents_data(*agents, first_stamp(result));
  return embed_data(page_head(), page, page_tail());
}

}  // namespace radioslam
