#include "radioslam/study/team/team_study.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/eval/team_estimate.hpp"
#include "radioslam/joint/places/scanned_robot.hpp"
#include "radioslam/records/record_codec.hpp"
#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/progress_counter.hpp"
#include "radioslam/team/virtual_team.hpp"

namespace radioslam {
namespace {

constexpr double kSpeed_mps = 4, kShortPath_m = 150;
constexpr std::size_t kMostSolvers = 5;  // of a larger team, one robot estimates

CityParams town_of(const TeamCase& of) {
  const auto robots = static_cast<int>(of.robots);
  CityParams town;
  town.robots = robots;
  town.path_length_m = of.path_m;
  town.speed_mps = kSpeed_mps;
  town.min_contact_s = 10;
  town.radio.links = std::max(2, 40 / std::max(1, robots - 1));
  town.streets.blocks_x = town.streets.blocks_y =
      std::max(2, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(robots)))));
  return town;
}

/// As they are said in a log, of two robots with 16 beams.
double mean_descriptor_bytes(std::uint64_t seed) {
  CityParams town = town_of({2, 60, 0, 0});
  town.onboard.lidar.lidar_beams = 16;
  town.onboard.lidar.lidar_azimuth_steps = 360;
  town.onboard.lidar.lidar_rotation_hz = 5;
  const RunParams params;
  StageClock timed;
  const MeasuredRecordings measured =
      measure_recordings(simulate_city(town, seed).mission, params, {}, timed);
  const auto places = scanned_places(measured.scans, params.places.descriptors, params.scans.loops.submap_m);
  double bytes = 0;
  for (const ScannedPlace& place : places) bytes += static_cast<double>(encode(Record(place.grid)).size());
  return places.empty() ? 0 : bytes / static_cast<double>(places.size());
}

NetworkFaults faults_of(const TeamCase& of, const Mission& mission, std::uint64_t seed) {
  NetworkFaults faults;
  faults.loss = of.loss;
  faults.seed = seed;
  if (of.partition_s == 0) return faults;
  const Stamp middle{begin_of(mission).ns + Stamp::from_seconds(of.path_m / kSpeed_mps / 2).ns};
  const std::int64_t half_ns = Stamp::from_seconds(of.partition_s / 2).ns;
  faults.partition = Partition{Stamp{middle.ns - half_ns}, Stamp{middle.ns + half_ns}};
  return faults;
}

/// Of the agent that is worst off; nothing if one of them has no estimate.
std::optional<double> worst_ate_m(const TeamRun& run, const Truth& truth, const RunParams& params) {
  std::vector<std::map<std::string, LogExtent>> known;
  double worst_m = 0;
  for (const auto& [agent, extents] : run.extents) {
    if (std::find(known.begin(), known.end(), extents) != known.end()) continue;
    known.push_back(extents);
    TeamLog logs;
    for (const RobotLog& log : run.logs.at(agent)) logs.add(log);
    const RunResult result = run_pipeline(mission_of(logs), params).result;
    const auto ate_m = ate_rmse_m(team_estimate(result), truth, result.dimension);
    if (!ate_m) return std::nullopt;
    worst_m = std::max(worst_m, *ate_m);
  }
  return worst_m;
}

void add_team(const TeamRun& run, const std::vector<ScriptedRobot>& script, TeamSample& sample) {
  std::vector<double> errors_m;
  for (const KnownThen& then : run.known) {
    sample.way_share += then.share / static_cast<double>(run.known.size());
    if (then.error_m) errors_m.push_back(*then.error_m);
  }
  sample.way_ate_m = median_of(std::move(errors_m));
  for (const auto& [key, traffic] : run.traffic) {
    sample.bytes += traffic.bytes;
    sample.messages += traffic.messages;
    sample.lost += traffic.lost;
  }
  Stamp last = script.front().runs.front().begin;
  sample.all_know_all = true;
  for (const ScriptedRobot& robot : script) {
    const auto& records = robot.runs.back().records;
    for (const auto& [stamp, record] : records) last = std::max(last, stamp);
    for (const auto& [agent, extents] : run.extents) {
      const auto found = extents.find(robot.name);
      if (found == extents.end() || found->second.records != records.size()) sample.all_know_all = false;
    }
  }
  sample.settled_s = std::max(0.0, seconds_between(last, run.settled));
}

/// The estimate without a network, and what other ways of sharing the same mission would send.
void add_other_ways(const Simulation& town, const std::vector<ScriptedRobot>& script, const RunParams& params,
                    double descriptor_bytes, TeamSample& sample) {
  const std::size_t others = script.size() - 1;
  for (std::size_t r = 0; r < script.size(); ++r) {
    RobotLog log{script[r].name, {}};
    for (const auto& [stamp, record] : script[r].runs.back().records) log.records.push_back(record);
    sample.bytes_at_one += r == 0 ? 0 : log.bytes().size();
    sample.bytes_to_all += others * log.bytes().size();
  }
  std::set<std::tuple<RobotIndex, std::uint32_t, RobotIndex>> asked;  ///< robot, keyframe, for which robot
  RunOptions how;
  how.overlap_only = true;
  how.search = SearchMethod::kDistributed;
  how.take_candidates = [&](const CandidateList::Group& group, const CandidateList&) {
    for (const CandidateList::Row& row : group.rows) {
      asked.emplace(group.robot_i, row.keyframe_i, group.robot_j);
      asked.emplace(group.robot_j, row.keyframe_j, group.robot_i);
    }
  };
  const RunResult result = run_pipeline(town.mission, params, how).result;
  sample.run_ate_m = ate_rmse_m(team_estimate(result), town.truth, result.dimension);
  std::size_t keyframes = 0, boxes = 0;
  for (const RobotResult& robot : result.robots) keyframes += robot.estimate.stamps().size();
  if (result.exchange)
    for (const auto& of_robot : result.exchange->bytes)
      for (const auto& [kind, bytes] : of_robot) boxes += bytes;
  const auto bytes_of = [&](std::size_t descriptors) {
    return static_cast<std::size_t>(std::lround(descriptor_bytes * static_cast<double>(descriptors)));
  };
  sample.bytes_of_descriptors = bytes_of(others * keyframes);
  sample.bytes_boxes_first = boxes + bytes_of(asked.size());
}

TeamSample sample_of(const TeamCase& of, std::uint64_t seed, double descriptor_bytes) {
  const Simulation town = simulate_city(town_of(of), seed);
  const RunParams params;
  const VirtualTeamSetup setup{
      .dimension = town.mission.dimension,
      .run = params,
      .agent = {},
      .network = faults_of(of, town.mission, seed),
      .solvers = of.robots <= kMostSolvers ? of.robots : 1,
      .store = [](const std::string& robot) { return store_in_memory(robot, 1); },
      .error_of = [&](const auto& frame) { return ate_rmse_m(frame, town.truth, town.mission.dimension); }};
  const auto script = scripted_robots(town.mission, params);
  const TeamRun run = run_team(script, setup);
  TeamSample sample;
  sample.driven_m = of.path_m * static_cast<double>(of.robots);
  sample.agent_ate_m = worst_ate_m(run, town.truth, params);
  add_team(run, script, sample);
  add_other_ways(town, script, params, descriptor_bytes, sample);
  return sample;
}

}  // namespace

std::vector<TeamCase> team_cases() {
  std::vector<TeamCase> cases;
  for (const double loss : {0.0, 0.1, 0.3, 0.5}) cases.push_back({.loss = loss});
  for (const double partition_s : {15, 30, 60}) cases.push_back({.partition_s = partition_s});
  cases.push_back({.loss = 0.3, .partition_s = 60});
  for (const std::size_t robots : {2U, 3U, 5U, 10U, 20U, 50U}) cases.push_back({robots, kShortPath_m});
  return cases;
}

TeamStudy study_team(const std::vector<TeamCase>& cases, std::uint64_t first_seed, int seeds,
                     const Progress& progress) {
  const auto per_case = static_cast<std::size_t>(seeds);
  TeamStudy study{first_seed, mean_descriptor_bytes(first_seed), cases, {}};
  study.samples.assign(cases.size(), std::vector<TeamSample>(per_case));
  ProgressCounter counter(progress, "teams", cases.size() * per_case);
  parallel_for(cases.size() * per_case, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t at = begin; at < end; ++at) {
      const std::size_t k = cases.size() * per_case - 1 - at;  // large teams first
      study.samples[k / per_case][k % per_case] =
          sample_of(cases[k / per_case], first_seed + k % per_case, study.descriptor_bytes);
      counter.one_more();
    }
  });
  return study;
}

std::string text_of(const TeamCase& of) {
  std::string text = std::to_string(of.robots) + " x " + number_text(of.path_m, 0) + " m";
  if (of.loss > 0) text += ", loss " + percent_text(of.loss, 0);
  if (of.partition_s > 0) text += ", partition " + number_text(of.partition_s, 0) + " s";
  return text;
}

StudyTable team_table(const TeamStudy& study) {
  const std::size_t seeds = study.samples.empty() ? 0 : study.samples.front().size();
  StudyTable table{
      "A team of agents on a bad network",
      "Teams in simulated towns, robots times metres driven at 4 m/s; radio links, no scans. " +
          seeds_text(study.first_seed, seeds) + "; bytes per robot and metre.",
      {"run, m", "worst agent, m", "on the way, m", "known on the way", "all know all", "after, s", "lost",
       "agents, B", "logs at one, B", "logs to all, B", "descriptors, B", "boxes first, B"},
      {},
      {"Bytes are counted for each receiver, lost ones too. On the way: what those that estimate "
       "know, observed every five seconds; in teams of more than " +
           std::to_string(kMostSolvers) + " robots one estimates, and all others take its solution.",
       "After: seconds from the last record until nobody lacks one.",
       "Other ways have a perfect network. Descriptors and boxes first are what place recognition "
       "takes, without the estimate; a descriptor has " +
           number_text(study.descriptor_bytes, 0) + " bytes, one a keyframe."}};
  for (std::size_t k = 0; k < study.cases.size(); ++k) {
    const auto& samples = study.samples[k];
    const auto median = [&](const auto& value) {
      return median_over(samples, [&](const TeamSample& s) { return std::optional<double>(value(s)); });
    };
    const auto bytes = [&](std::size_t TeamSample::*of) {
      return number_text(median([&](const TeamSample& s) { return static_cast<double>(s.*of) / s.driven_m; }),
                         0);
    };
    const auto all =
        std::count_if(samples.begin(), samples.end(), [](const auto& s) { return s.all_know_all; });
    table.rows.push_back(
        {text_of(study.cases[k]),
         {number_text(median([](const auto& s) { return s.run_ate_m; }), 2),
          number_text(median([](const auto& s) { return s.agent_ate_m; }), 2),
          number_text(median([](const auto& s) { return s.way_ate_m; }), 2),
          percent_text(median([](const auto& s) { return s.way_share; }), 1),
          std::to_string(all) + " of " + std::to_string(samples.size()),
          number_text(median([](const auto& s) { return s.settled_s; }), 0),
          percent_text(median([](const auto& s) {
                         return static_cast<double>(s.lost) /
                                static_cast<double>(std::max<std::size_t>(1, s.messages));
                       }),
                       0),
          bytes(&TeamSample::bytes), bytes(&TeamSample::bytes_at_one), bytes(&TeamSample::bytes_to_all),
          bytes(&TeamSample::bytes_of_descriptors), bytes(&TeamSample::bytes_boxes_first)}});
  }
  return table;
}

}  // namespace radioslam
