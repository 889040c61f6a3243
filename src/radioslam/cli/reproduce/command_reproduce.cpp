// radioslam reproduce: reproduces published tables, and runs the project's own studies.
#include "radioslam/cli/reproduce/command_reproduce.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/distributed_optimization.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/recorded_drive.hpp"
#include "radioslam/io/datasets/wsr_results.hpp"
#include "radioslam/io/datasets/wsr_trial.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/study/rendezvous/rendezvous_json.hpp"
#include "radioslam/study/study_json.hpp"
#include "radioslam/study/study_page.hpp"
#include "radioslam/study/wi_closure_hall/hall_tables.hpp"

namespace radioslam::cli {
namespace {

/// Recorded trials of the WSR data set and the results that its authors published for them.
struct RecordedTrials {
  std::vector<WsrTrialFiles> trials;
  std::vector<WsrResult> published;  ///< empty if the results are not available
};

namespace fs = std::filesystem;

constexpr int kFoldersAbove = 2;

std::optional<fs::path> results_beside(const std::string& dataset) {
  fs::path place = fs::weakly_canonical(fs::absolute(dataset));
  for (int above = 0; above <= kFoldersAbove; ++above) {
    if (fs::path results = place / "2D-Displacement_output_files"; fs::is_directory(results)) return results;
    place = place.parent_path();
  }
  return std::nullopt;
}

/// Refuses (InputError, prefixed by `call`) an empty `dataset`. If `authors` is empty, the results are
/// searched in 2D-Displacement_output_files within the data set's folder or up to two folders above it.
RecordedTrials find_trials(const std::string& call, const std::string& dataset, const std::string& authors) {
  if (dataset.empty()) throw InputError(call, 0, "needs recorded trials: --dataset DIR");
  RecordedTrials recorded{find_wsr_trials(dataset), {}};
  const auto results = authors.empty() ? results_beside(dataset) : std::optional<fs::path>(authors);
  if (results) recorded.published = read_wsr_results(*results);
  return recorded;
}

constexpr int kMaxSeeds = 1000;
constexpr std::size_t kMaxPoses = 1000000;
constexpr double kMinCut = 0.01, kMaxCut = 0.99;
constexpr double kMinRadius_m = 0.1, kMaxRadius_m = 1000;
constexpr const char* kStudyFolder = "table.json";

struct ReproduceOptions {
  std::string table;
  std::string output;
  std::string trajectory;
  std::string odometry;
  std::string dataset;
  std::string authors;
  std::vector<std::string> teams, missions;
  std::string measure;
  std::optional<double> cut, radius_m;
  std::uint64_t seed = 1;
  std::optional<int> seeds;
  std::optional<std::size_t> poses;
  std::vector<std::string> set;
  bool json = false;
};

/// The outputs of one table.
struct Study {
  StudyTable table;
  nlohmann::ordered_json json;
  std::string page;
  std::string links_csv = {};            ///< one row per measurement; empty for tables without
  std::vector<StudyTable> further = {};  ///< printed below the table
};

/// A study of one table, on a page with nothing else.
Study study_of(StudyTable table, nlohmann::ordered_json json) {
  std::string page = render_table_page(table);
  return {std::move(table), std::move(json), std::move(page)};
}

[[noreturn]] void refuse(const ReproduceOptions& options, const std::string& reason) {
  throw InputError("reproduce " + options.table, 0, reason);
}

/// Results of every seed.
template <class Reproduce>
auto for_seeds(const ReproduceOptions& options, int default_seeds, const Reproduce& reproduce) {
  ProgressLine line;
  std::vector<decltype(reproduce(options.seed, line.progress()))> results;
  for (int k = 0; k < options.seeds.value_or(default_seeds); ++k)
    results.push_back(reproduce(options.seed + static_cast<std::uint64_t>(k), line.progress()));
  return results;
}

RecordedDrive recorded_drive(const ReproduceOptions& options) {
  return read_drive("reproduce " + options.table, options.trajectory, options.odometry);
}

/// The parameters of a drive, cut as asked.
KittiParams drive_params(const ReproduceOptions& options, const KittiParams& defaults) {
  auto scenario = with_settings(defaults, collect_settings({}, options.set));
  if (options.cut) scenario.cut = *options.cut;
  return scenario;
}

void refuse_without_scans(const ReproduceOptions& options, const LidarScannerParams& lidar) {
  if (lidar.lidar_beams == 0) refuse(options, "needs scans: lidar_beams of at least 1");
}

Study wi_closure_kitti(const ReproduceOptions& options) {
  const RecordedDrive drive = recorded_drive(options);
  const KittiParams scenario = drive_params(options, wi_closure_drive());
  const auto seeds = for_seeds(options, 1, [&](std::uint64_t seed, const Progress& progress) {
    return reproduce_wi_closure_kitti(drive, scenario, seed, progress);
  });
  return study_of(wi_closure_kitti_table(seeds), wi_closure_kitti_json(seeds));
}

Study wi_closure_table1(const ReproduceOptions& options) {
  const RecordedDrive drive = recorded_drive(options);
  const KittiParams scenario = drive_params(options, scanned_drive());
  refuse_without_scans(options, scenario.lidar);
  const auto seeds = for_seeds(options, 1, [&](std::uint64_t seed, const Progress& progress) {
    return reproduce_wi_closure_table1(drive, scenario, seed, progress);
  });
  Study study = study_of(wi_closure_table1_table(seeds), wi_closure_table1_json(seeds));
  study.page = render_places_page(study.table, {}, seeds.front().places);
  return study;
}

void refuse_drive(const ReproduceOptions& options) {
  if (!options.trajectory.empty() || !options.odometry.empty() || options.cut || options.poses)
    refuse(options, "takes no --trajectory, --odometry, --cut or --poses");
}

Study wi_closure_hall(const ReproduceOptions& options) {
  constexpr int kSeeds = 5;
  refuse_drive(options);
  const auto scenario = with_settings(scanned_hall(), collect_settings({}, options.set));
  refuse_without_scans(options, scenario.onboard.lidar);
  if (scenario.robots < 2) refuse(options, "needs robots of at least 2");
  const auto halls = for_seeds(options, kSeeds, [&](std::uint64_t seed, const Progress& progress) {
    return reproduce_wi_closure_hall(scenario, seed, options.radius_m.value_or(kThesisRadius_m), progress);
  });
  StudyTable table = wi_closure_hall_table(halls), angles = hall_angles_table(halls);
  std::string page = render_places_page(table, {angles}, halls.front().places), csv = table_csv(angles);
  return {
      std::move(table), wi_closure_hall_json(halls), std::move(page), std::move(csv), {std::move(angles)}};
}

Study robustness(const ReproduceOptions& options) {
  constexpr int kSeeds = 3;
  if (!options.trajectory.empty() || !options.odometry.empty() || options.cut || options.poses)
    refuse(options, "takes no --trajectory, --odometry, --cut or --poses: its towns are simulated");
  const auto town = with_settings(robustness_town(), collect_settings({}, options.set));
  ProgressLine line;
  const RobustnessMap map =
      map_robustness(RobustnessGrid{}, town, options.seed, options.seeds.value_or(kSeeds), line.progress());
  return {robustness_table(map), robustness_json(map), render_robustness_page(map)};
}

Study overlap_growth(const ReproduceOptions& options) {
  constexpr std::size_t kPoses = 100000;
  if (!options.trajectory.empty() || !options.odometry.empty() || options.cut || options.seeds ||
      !options.set.empty())
    refuse(options, "takes only --poses and --seed: its towns are generated");
  ProgressLine line;
  const OverlapGrowth growth =
      measure_overlap_growth(options.poses.value_or(kPoses), options.seed, line.progress());
  return {overlap_growth_table(growth), overlap_growth_json(growth), render_growth_page(growth)};
}

Study verification_budget(const ReproduceOptions& options) {
  constexpr int kSeeds = 1;
  refuse_drive(options);
  if (!options.set.empty()) refuse(options, "takes only --seed and --seeds");
  std::vector<BudgetMission> missions;
  for (auto& of_seed : for_seeds(options, kSeeds, study_budgets))
    missions.insert(missions.end(), of_seed.begin(), of_seed.end());
  return {budget_table(missions), verification_budget_json(missions), render_budget_page(missions)};
}

/// Of the given graphs, each a team's file or folder; of simulated teams if there are none.
Study distributed_optimization(const ReproduceOptions& options) {
  refuse_drive(options);
  if (options.seeds || !options.set.empty()) refuse(options, "takes only --team and --seed");
  ProgressLine line;
  std::vector<DistributedTeam> teams;
  for (const std::string& path : options.teams)
    teams.push_back(std::visit(
        [&](const auto& file) {
          const fs::path place = fs::absolute(path).lexically_normal();
          const fs::path name = place.has_filename() ? place.filename() : place.parent_path().filename();
          return study_distributed_team(name.string(), file.team, line.progress());
        },
        read_distributed_team({path})));
  if (teams.empty()) teams = study_simulated_teams(options.seed, line.progress());
  return {distributed_table(teams), distributed_optimization_json(teams), render_distributed_page(teams)};
}

Study rendezvous(const ReproduceOptions& options) {
  constexpr int kSeeds = 20;
  refuse_drive(options);
  if (!options.set.empty()) refuse(options, "takes only --seed and --seeds");
  ProgressLine line;
  const RendezvousStudy study =
      study_rendezvous(options.seed, options.seeds.value_or(kSeeds), line.progress());
  return {rendezvous_table(study), rendezvous_json(study), render_rendezvous_page(study)};
}

Study team(const ReproduceOptions& options) {
  constexpr int kSeeds = 1;
  refuse_drive(options);
  if (!options.set.empty()) refuse(options, "takes only --seed and --seeds");
  ProgressLine line;
  const TeamStudy study =
      study_team(team_cases(), options.seed, options.seeds.value_or(kSeeds), line.progress());
  return {team_table(study), team_json(study), render_team_page(study)};
}

Study aoa(const ReproduceOptions& options) {
  refuse_drive(options);
  if (options.seeds) refuse(options, "takes no --seeds: its trials are recordings");
  const auto params = with_settings(AoaParams{}, collect_settings({}, options.set));
  const RecordedTrials recorded = find_trials("reproduce " + options.table, options.dataset, options.authors);
  ProgressLine line;
  std::vector<AoaLink> links;
  for (std::size_t k = 0; k < recorded.trials.size(); ++k) {
    report_progress(line.progress(), recorded.trials[k].name,
                    static_cast<double>(k) / static_cast<double>(recorded.trials.size()));
    const WsrTrial trial = read_wsr_trial(recorded.trials[k]);
    for (const std::string& warning : trial.warnings) std::cerr << "note: " << warning << '\n';
    for (AoaLink& link : measure_wsr_trial(trial, recorded.published, params))
      links.push_back(std::move(link));
  }
  StudyTable table = aoa_table(links, recorded.published);
  std::string page = render_aoa_page(table, links);
  return {std::move(table), aoa_json(links, recorded.published), std::move(page), aoa_links_csv(links)};
}

Study aoa_paths(const ReproduceOptions& options) {
  constexpr int kSeeds = 200;
  refuse_drive(options);
  const auto params = with_settings(AoaParams{}, collect_settings({}, options.set));
  ProgressLine line;
  const auto cells = measure_aoa_paths(options.seeds.value_or(kSeeds), options.seed, params, line.progress());
  return study_of(aoa_paths_table(cells), aoa_paths_json(cells));
}

/// Of --mission DIR, or car parks.
std::vector<StudyMission> study_missions(const ReproduceOptions& options, int default_seeds) {
  refuse_drive(options);
  if (options.missions.empty()) {
    const auto carpark = with_settings(CarparkParams{}, collect_settings({}, options.set));
    return simulated_carparks(carpark, options.seed, options.seeds.value_or(default_seeds));
  }
  if (!options.set.empty()) refuse(options, "takes no --set beside --mission: it is for simulated car parks");
  std::vector<StudyMission> missions;
  for (const std::string& folder : options.missions) {
    Mission mission = read_mission(folder);
    Truth truth = read_truth(folder, mission);
    missions.push_back({std::move(mission), std::move(truth)});
    if (const auto what = lacking(missions.back())) throw InputError(folder, 0, *what);
  }
  return missions;
}

/// Car parks must have known starts, from which dead reckoning, their baseline, goes.
std::vector<StudyMission> missions_with_baseline(const ReproduceOptions& options, int default_seeds) {
  if (options.missions.empty() &&
      !with_settings(CarparkParams{}, collect_settings({}, options.set)).known_start)
    refuse(options, "needs known starts: known_start=true");
  return study_missions(options, default_seeds);
}

void refuse_unknown_measure(const ReproduceOptions& options) {
  std::vector<std::string> names = similarity_measures();
  names.emplace_back("all");
  if (!options.measure.empty() && std::find(names.begin(), names.end(), options.measure) == names.end())
    throw InputError("--measure " + options.measure, 0,
                     "unknown similarity measure" + did_you_mean(options.measure, names));
}

/// Those asked for; an empty name is the default of `run`.
std::vector<std::string> measures_of(const ReproduceOptions& options) {
  refuse_unknown_measure(options);
  if (options.measure == "all") return similarity_measures();
  return {options.measure};
}

Study sequence_closures(const ReproduceOptions& options) {
  constexpr int kSeeds = 3;
  const auto measures = measures_of(options);
  const auto missions = study_missions(options, kSeeds);
  ProgressLine line;
  const auto cells = measure_sequence_closures(missions, measures, line.progress());
  return study_of(sequence_table(cells, listed(missions)), sequence_json(cells));
}

Study fingerprint_tables(const ReproduceOptions& options) {
  constexpr int kSeeds = 3;
  refuse_unknown_measure(options);
  auto missions = missions_with_baseline(options, kSeeds);
  for (std::size_t k = 0; k < options.missions.size(); ++k) {
    take_starts_of_truth(missions[k]);
    if (const std::string unknown = of_unknown_start(missions[k].mission); !unknown.empty())
      throw InputError(
          options.missions[k], 0,
          "needs an initial_pose or two true positions, from which the algorithm starts, of " + unknown);
  }
  ProgressLine line;
  const auto tables =
      measure_fingerprint_tables(missions, fingerprint_measures(options.measure), line.progress());
  return study_of(fingerprint_tables_table(tables), fingerprint_tables_json(tables));
}

Study threshold_sweep(const ReproduceOptions& options) {
  constexpr int kSeeds = 10;
  const auto measures = measures_of(options);
  const auto missions = missions_with_baseline(options, kSeeds);
  ProgressLine line;
  const auto swept = sweep_thresholds(missions, {}, measures, line.progress());
  return study_of(threshold_sweep_table(swept), threshold_sweep_json(swept));
}

struct Table {
  std::string_view name;
  std::string_view description;
  Study (*reproduce)(const ReproduceOptions&);
};

constexpr std::array<Table, 14> kTables{
    {{"wi-closure-kitti",
      "KITTI 08 cut in two, radio noise of 0.5 m and 10 degrees, compared with Wi-Closure", wi_closure_kitti},
     {"wi-closure-table1",
      "the same drive by the whole pipeline, with recorded odometry and scans of streets made around it",
      wi_closure_table1},
     {"wi-closure-hall",
      "two scanning robots between identical pillars, with and without radio, compared with Wi-Closure",
      wi_closure_hall},
     {"robustness-map",
      "error and recall over angle noise, number of links and multipath: where estimation fails", robustness},
     {"overlap-growth", "run time of the overlap search over the size of the mission, up to a million poses",
      overlap_growth},
     {"verification-budget",
      "error over the number of scans registered between robots, by worth, similarity and at random",
      verification_budget},
     {"distributed-optimization",
      "every method of optimizing a team's graph without a centre: gap over rounds and over bytes sent",
      distributed_optimization},
     {"rendezvous",
      "teams that meet by chance, at a place, when called and by turns, compared with Wang et al. (Active "
      "Rendezvous)",
      rendezvous},
     {"team",
      "agents without a server: error, bytes and delay over loss, partitions and the size of the team, "
      "beside "
      "other ways of sharing",
      team},
     {"aoa", "angles of arrival of the WSR data set, compared with its authors' results", aoa},
     {"aoa-paths", "three simulated paths at once: which of them each AoA profile finds", aoa_paths},
     {"sequence-closures", "closures from similar fingerprint sequences, over similarity and window length",
      sequence_closures},
     {"fingerprint-tables",
      "fingerprint SLAM over threshold and measure, compared with tables I to III of Liu et al. (2020)",
      fingerprint_tables},
     {"threshold-sweep",
      "the defaults compared with the best threshold and loss of each of ten car parks or missions",
      threshold_sweep}}};

std::string table_list() {
  std::string text = "Tables:\n";
  for (const Table& table : kTables)
    text += "  " + std::string(table.name) + ": " + std::string(table.description) + "\n";
  return text;
}

const Table& table_named(const ReproduceOptions& options) {
  std::vector<std::string> names;
  for (const Table& table : kTables) {
    if (table.name == options.table) return table;
    names.emplace_back(table.name);
  }
  refuse(options, "unknown table" + did_you_mean(options.table, names));
}

std::string tables_text(const Study& study) {
  std::string text = table_text(study.table);
  for (const StudyTable& table : study.further) text += '\n' + table_text(table);
  return text;
}

void write_study(const Study& study, OutputFolder& output) {
  write_file(output.path() / "table.json", study.json.dump(2) + "\n");
  write_file(output.path() / "table.csv", table_csv(study.table));
  write_file(output.path() / "table.txt", tables_text(study));
  write_file(output.path() / "index.html", study.page);
  if (!study.links_csv.empty()) write_file(output.path() / "links.csv", study.links_csv);
  output.commit();
}

void reproduce(const ReproduceOptions& options) {
  if (options.table.empty()) {
    std::cout << table_list();
    return;
  }
  const Table& table = table_named(options);
  if (table.reproduce != aoa && !(options.dataset.empty() && options.authors.empty()))
    refuse(options, "takes no --dataset or --authors");
  if (table.reproduce != distributed_optimization && !options.teams.empty())
    refuse(options, "takes no --team");
  const bool of_fingerprints = table.reproduce == sequence_closures ||
                               table.reproduce == fingerprint_tables || table.reproduce == threshold_sweep;
  if (!of_fingerprints && !(options.missions.empty() && options.measure.empty()))
    refuse(options, "takes no --mission or --measure");
  std::optional<OutputFolder> output;
  if (!options.output.empty()) output.emplace(options.output, kStudyFolder);
  const Study study = table.reproduce(options);
  if (output) write_study(study, *output);
  if (options.json) {
    std::cout << study.json.dump(2) << '\n';
  } else {
    std::cout << tables_text(study);
  }
}

void add_table_options(CLI::App& command, ReproduceOptions& options) {
  command
      .add_option("--trajectory", options.trajectory,
                  "wi-closure-kitti, wi-closure-table1: true poses of the recorded drive")
      ->type_name("FILE");
  command
      .add_option("--odometry", options.odometry,
                  "wi-closure-kitti, wi-closure-table1: odometry of the recorded drive, in any frame")
      ->type_name("FILE");
  command
      .add_option("--cut", options.cut,
                  "wi-closure-kitti, wi-closure-table1: fraction of the drive assigned to the first robot "
                  "(default: 0.34)")
      ->check(number_from(kMinCut, kMaxCut))
      ->type_name("FRACTION");
  command
      .add_option("--radius", options.radius_m,
                  "wi-closure-hall: distance of true pairs by the second criterion (default: 3.6)")
      ->check(number_from(kMinRadius_m, kMaxRadius_m))
      ->type_name("M");
  command.add_option("--dataset", options.dataset, "aoa: folder that contains trials of the WSR data set")
      ->type_name("DIR");
  command
      .add_option(
          "--authors", options.authors,
          "aoa: folder with the authors' results (default: 2D-Displacement_output_files near the trials)")
      ->type_name("DIR");
  command
      .add_option(
          "--team", options.teams,
          "distributed-optimization: graphs of teams instead of simulated ones, each a file or a folder "
          "of g2o files, one per robot")
      ->type_name("PATH");
  auto* missions = command
                       .add_option("--mission", options.missions,
                                   "sequence-closures, fingerprint-tables, threshold-sweep: mission folders "
                                   "with true poses instead of simulated car parks")
                       ->type_name("DIR");
  command
      .add_option("--measure", options.measure,
                  "sequence-closures, fingerprint-tables, threshold-sweep: similarity measure (cosine, "
                  "gaussian, detection, slide, mended or sorensen), or all (default: that of `run`; for "
                  "fingerprint-tables those of the paper)")
      ->type_name("NAME");
  command.add_option("--seed", options.seed, "First random seed (default: 1)")
      ->check(seed_number())
      ->excludes(missions)
      ->type_name("N");
  command
      .add_option("--poses", options.poses,
                  "overlap-growth: poses per robot in the largest town (default: 100000)")
      ->check(CLI::Range(std::size_t{1000}, kMaxPoses))
      ->type_name("N");
  command.add_option("--seeds", options.seeds, "Number of seeds; the table shows medians or means over them")
      ->check(CLI::Range(1, kMaxSeeds))
      ->excludes(missions)
      ->type_name("N");
}

}  // namespace

void add_tables(CLI::App& program) {
  const auto options = std::make_shared<ReproduceOptions>();
  auto* command =
      program.add_subcommand("reproduce", "Reproduce a published table, or run one of the project's studies");
  command->add_option("TABLE", options->table, "Table to compute; without it, the tables are listed");
  command
      ->add_option("-o,--output", options->output,
                   "Folder to write: index.html, table.csv, table.json and table.txt")
      ->type_name("PATH");
  add_table_options(*command, *options);
  add_set_option(*command, options->set);
  add_json_option(*command, options->json);
  add_threads_option(*command);
  command->footer(
      table_list() +
      "\n"
      "Recorded drive (wi-closure-kitti, wi-closure-table1): two files in KITTI format with one pose of the\n"
      "LiDAR per line. The true poses are those of the odometry benchmark (cvlibs.net/datasets/kitti),\n"
      "transformed to the LiDAR frame. The GitHub repository RobotsRuning/KITTI_odometry_evaluation_tool\n"
      "contains them (ground_truth_pose/GT_LiDAR) and the odometry of A-LOAM (data/ALOAM_result_pred).\n"
      "WSR data set (aoa): the GitHub repository Harvard-REACT/WSR-Toolbox-Dataset.\n\n"
      "--set changes parameters of the simulated scenario; for aoa and aoa-paths it changes those of the\n"
      "angle estimation. `radioslam parameters TABLE` lists them.\n"
      "wi-closure-table1, wi-closure-hall, robustness-map, verification-budget, team, aoa-paths,\n"
      "fingerprint-tables and threshold-sweep take minutes, as does distributed-optimization for large "
      "--team\n"
      "graphs. wi-closure-table1 needs 1.4 GB of memory for KITTI 08.\n"
      "overlap-growth needs 1 GiB of memory per half million poses.\n\n"
      "Example:\n"
      "  radioslam reproduce wi-closure-kitti --trajectory GT_LiDAR/08.txt --odometry ALOAM/08.txt\n"
      "Example: which similarity measure suits one's own recordings\n"
      "  radioslam reproduce threshold-sweep --mission floor --measure all -o sweep\n"
      "Example: the robustness map of a team without ranges\n"
      "  radioslam reproduce robustness-map --set ranges=false -o map");
  command->callback([options] { reproduce(*options); });
}

}  // namespace radioslam::cli
