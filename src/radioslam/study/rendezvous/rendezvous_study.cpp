#include "radioslam/study/rendezvous/rendezvous_study.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "radioslam/rendezvous_world/simulated_team.hpp"

namespace radioslam {
namespace {

using Seeds = std::pair<std::uint64_t, int>;  ///< the first, and how many

/// Wang et al., section 7.1: 50 robots on 10,000 m^2.
RendezvousRunParams published_team() {
  RendezvousRunParams params;
  params.robots = 50;
  params.side_m = 100;
  params.robot.monitor = "seed";
  return params;
}

/// Section 7.2, figures 7 and 8: two robots on 74 m^2, steps of a metre.
RendezvousRunParams small_testbed(int obstacles) {
  RendezvousRunParams params;
  params.robot.monitor = "seed";
  params.side_m = 8.6;
  params.step_m = params.robot.max_step_m = 1;
  params.robot.min_step_m = 0.4;
  params.sensing_range_m = 1.1;
  params.obstacles = obstacles;
  return params;
}

/// Section 7.2, figure 6: two robots on 3,000 m^2, about 100 m each.
RendezvousRunParams large_testbed() {
  RendezvousRunParams params;
  params.side_m = 54.77;
  params.metres_each = 100;
  params.robot.meeting_x_m = params.robot.meeting_y_m = params.side_m / 2;
  return params;
}

/// Robots that meet by chance, so that weights change nothing but the estimate.
RendezvousRunParams robots_with_outliers(const std::string& kind) {
  RendezvousRunParams params;
  params.robots = 5;
  params.side_m = 20;
  params.robot.policy = "random";
  params.outliers = !kind.empty();
  if (!kind.empty()) params.outlier_kind = kind;
  return params;
}

RendezvousSeries runs_of(const std::string& name, const RendezvousRunParams& params, const Seeds& seeds,
                         bool leave_outliers_out = false) {
  RendezvousSeries series{name, {}};
  for (int k = 0; k < seeds.second; ++k) {
    RendezvousRunOptions options;
    options.seed = seeds.first + static_cast<std::uint64_t>(k);
    options.leave_outliers_out = leave_outliers_out;
    options.keep_moments = seeds.second == 1;
    series.runs.push_back(run_rendezvous(params, options));
  }
  return series;
}

std::vector<RendezvousSeries> policies(RendezvousRunParams params, const Seeds& seeds,
                                       const std::vector<std::string>& names) {
  std::vector<RendezvousSeries> list;
  for (const std::string& name : names) {
    params.robot.policy = name;
    list.push_back(runs_of(name, params, seeds));
  }
  return list;
}

RendezvousFigure outlier_figure(const std::string& kind, const std::string& title, const Seeds& seeds) {
  RendezvousRunParams params = robots_with_outliers(kind);
  RendezvousFigure figure{
      title, "5 robots that meet by chance on 400 m², 50 steps; mean squared error of all poses.", {}};
  for (const std::string weights : {"off", "published", "posterior"}) {
    params.robot.estimate.angle_weights = weights;
    figure.series.push_back(runs_of(weights, params, seeds));
  }
  params.robot.estimate.angle_weights = "off";
  figure.series.push_back(runs_of("left out by label", params, seeds, true));
  return figure;
}

AngleErrors angle_errors(std::uint64_t seed) {
  constexpr int kIterations = 20;
  RendezvousRunParams params;
  params.robots = 10;
  params.side_m = 30;
  params.obstacles = 4;
  params.robot.policy = "random";
  RendezvousRunOptions options;
  options.seed = seed;
  SimulatedTeam team(params, options);
  AngleErrors errors{params.radio.sigma_aoa_rad, {}};
  for (int k = 0; k < kIterations; ++k) {
    team.step();
    for (const SimulatedRobot& robot : team.robots())
      for (const HeardRobot& heard : robot.heard) {
        const Eigen::Vector2d offset =
            team.robots()[heard.from].truth.translation() - robot.truth.translation();
        errors.strongest_rad.push_back(
            wrap_angle(heard.reception.paths.front().azimuth_rad - std::atan2(offset.y(), offset.x())));
      }
  }
  return errors;
}

RendezvousReplay replay_of(const std::string& name, const RendezvousRunParams& params, std::uint64_t seed) {
  RendezvousRunOptions options;
  options.seed = seed;
  options.keep_moments = true;
  return {name, params, arena_of(params, seed), run_rendezvous(params, options)};
}

std::vector<RendezvousReplay> replays_of(std::uint64_t seed) {
  constexpr int kIterations = 120;
  RendezvousRunParams params;
  params.iterations = kIterations;
  params.robots = 4;
  params.side_m = 50;
  params.obstacles = 8;
  std::vector<RendezvousReplay> list;
  for (const std::string policy : {"active", "anchored", "random"}) {
    params.robot.policy = policy;
    list.push_back(replay_of(policy + ", 4 robots, obstacles", params, seed));
  }
  return list;
}

std::vector<TeamGrowth> growth_of(std::uint64_t seed, const Progress& progress) {
  std::vector<TeamGrowth> list;
  for (const int robots : {10, 30, 100, 300, 1000}) {
    report_progress(progress, "team of " + std::to_string(robots), 0);
    RendezvousRunParams params;
    params.robots = robots;
    list.push_back({robots, run_rendezvous(params, {seed, false, false}).seconds});
  }
  return list;
}

// ---- the table -----------------------------------------------------------------------------------------

using Figure = std::function<double(const RendezvousRun&)>;

double mean_of(const RendezvousSeries& series, const Figure& figure) {
  double sum = 0;
  for (const RendezvousRun& run : series.runs) sum += figure(run);
  return series.runs.empty() ? 0 : sum / static_cast<double>(series.runs.size());
}

double squared_error(const RendezvousRun& run) { return run.ate_trans_mean_squared; }
double squared_rotation(const RendezvousRun& run) { return run.ate_rot_mean_squared; }
double last_error(const RendezvousRun& run) { return run.error.empty() ? 0 : run.error.back(); }

const RendezvousSeries* named(const RendezvousFigure& figure, const std::string& name) {
  for (const RendezvousSeries& series : figure.series)
    if (series.name == name) return &series;
  return nullptr;
}

StudyRow row_of(const std::string& label, const RendezvousFigure& figure, const std::string& published,
                const Figure& value, int decimals) {
  StudyRow row{label, {published}};
  for (const char* name : {"random", "scheduled", "active", "anchored"}) {
    const RendezvousSeries* series = named(figure, name);
    row.cells.push_back(
        number_text(series ? std::optional(mean_of(*series, value)) : std::nullopt, decimals));
  }
  return row;
}

double share_below(const RendezvousRun& run) {
  if (run.crossings.empty()) return 100;
  const auto below = std::count_if(run.crossings.begin(), run.crossings.end(),
                                   [&](const ErrorCrossing& each) { return each.after <= run.delta; });
  return 100 * static_cast<double>(below) / static_cast<double>(run.crossings.size());
}

/// Mean squared errors without weights, with both kinds, and without the outliers.
std::string gain_note(const RendezvousFigure& figure) {
  const double off = mean_of(*named(figure, "off"), squared_error);
  const double label = mean_of(*named(figure, "left out by label"), squared_error);
  std::string note = figure.title + ": mean squared error without weights " + number_text(off, 2) + " m²";
  for (const char* name : {"published", "posterior"}) {
    const double weighted = mean_of(*named(figure, name), squared_error);
    note += ", " + std::string(name) + " " + number_text(weighted, 2) + " (" +
            number_text(100 * (weighted / off - 1), 1) + " %)";
  }
  return note + ", outliers left out by label " + number_text(label, 2) + ".";
}

}  // namespace

RendezvousStudy study_rendezvous(std::uint64_t seed, int seeds, const Progress& progress) {
  constexpr int kTeamRuns = 5, kTestbedRuns = 10, kObstacles = 4;  // as published
  const Seeds many{seed, seeds};
  RendezvousStudy study;
  report_progress(progress, "teams", 0);
  study.team_error = {"Figure 4: 50 robots, error over time",
                      "Trajectory error (eq. 3) on 10,000 m²; mean and standard deviation over 5 runs.",
                      policies(published_team(), {seed, kTeamRuns}, {"random", "active", "anchored"})};
  report_progress(progress, "true errors", 0.2);
  study.true_error = {"Figure 6: true error of two robots",
                      "3,000 m², 100 m each; mean squared error (eq. 8), no alignment, relative to chance "
                      "meetings. Spread: standard deviation over seeds.",
                      policies(large_testbed(), many, {"random", "scheduled", "active", "anchored"})};
  for (const int obstacles : {0, kObstacles}) {
    const std::string floor = obstacles > 0 ? ", with obstacles" : ", open floor";
    study.trial.push_back({"Figure 7: a single trial" + floor,
                           "Two robots on 74 m², trajectory error (eq. 3).",
                           policies(small_testbed(obstacles), {seed, 1}, {"random", "active"})});
    study.trials.push_back({"Figure 8: ten trials" + floor,
                            "Two robots on 74 m²; mean and standard deviation over 10 trials.",
                            policies(small_testbed(obstacles), {seed, kTestbedRuns}, {"random", "active"})});
  }
  report_progress(progress, "outliers", 0.4);
  study.outliers = {outlier_figure("", "no outliers", many),
                    outlier_figure("sigma", "outliers of 2 to 3 sigma", many),
                    outlier_figure("gross", "outliers of 2 to 3 m and 20 to 40 degrees", many)};
  study.angles = angle_errors(seed);
  report_progress(progress, "replays", 0.6);
  study.replays = replays_of(seed);
  study.growth = growth_of(seed, progress);
  return study;
}

StudyTable rendezvous_table(const RendezvousStudy& study) {
  StudyTable table{
      "Active rendezvous",
      "Simulated teams under four policies on the same floors, beside what Wang et al. publish. Noise "
      "0.2 m and 5° per step and per relative pose.",
      {"Wang et al.", "random", "scheduled", "active", "anchored"},
      {},
      {}};
  auto& rows = table.rows;
  rows.push_back(row_of("figure 4: error at the end", study.team_error, "near 10", last_error, 1));
  rows.push_back(row_of("figure 4: crossings back below 10 (%)", study.team_error, "–", share_below, 0));
  rows.push_back(row_of("figure 6: mean squared error (m²)", study.true_error, "−64 %", squared_error, 2));
  rows.push_back(row_of("figure 6: the same of rotations", study.true_error, "–", squared_rotation, 3));
  rows.push_back(row_of(
      "figure 6: floor seen (m²)", study.true_error, "–",
      [](const RendezvousRun& run) { return run.covered_m2; }, 0));
  rows.push_back(row_of(
      "figure 6: normalised squared error", study.true_error, "–",
      [](const RendezvousRun& run) { return run.nees; }, 2));
  for (std::size_t k = 0; k < study.trial.size(); ++k) {
    const char* floor = k == 0 ? ", open" : ", obstacles";
    rows.push_back(
        row_of(std::string("figure 7: error at the end") + floor, study.trial[k], "−83 %", last_error, 2));
    rows.push_back(
        row_of(std::string("figure 8: error at the end") + floor, study.trials[k], "–", last_error, 2));
  }
  for (const RendezvousFigure& figure : study.outliers) table.notes.push_back(gain_note(figure));
  table.notes.push_back("Wang et al., figure 10 a: −32 % by weights, outliers of 2 to 3 sigma.");
  std::string growth = "Run time of 50 steps:";
  for (const TeamGrowth& each : study.growth)
    growth += " " + number_text(each.robots, 0) + " robots " + number_text(each.seconds, 1) + " s;";
  growth.back() = '.';
  table.notes.push_back(growth);
  table.notes.push_back(
      "anchored: some robots stand as landmarks, the others return to them; at equal metres it sees less "
      "floor.");
  return table;
}

}  // namespace radioslam
