// radioslam map: makes the map of an earlier run.
#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/map_output.hpp"
#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

struct MapArguments {
  std::string run;
  std::vector<std::string> mission;
  std::string output;  ///< empty: the run's folder
  std::optional<double> voxel_m;
  std::string crop;
  bool pcd = false;
  bool json = false;
  ParameterOptions parameters;
};

/// Limits X0,X1,Y0,Y1 or X0,X1,Y0,Y1,Z0,Z1.
Eigen::AlignedBox3d crop_of(const std::string& text) {
  constexpr double kFar_m = 1e9;
  std::vector<double> limits;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = parse_number(text.substr(begin, end - begin));
    if (!number) throw InputError("--crop", 0, "'" + text + "' is not a list of numbers X0,X1,Y0,Y1[,Z0,Z1]");
    limits.push_back(*number);
    begin = end + 1;
  }
  if (limits.size() == 4) limits.insert(limits.end(), {-kFar_m, kFar_m});
  if (limits.size() != 6)
    throw InputError("--crop", 0,
                     "'" + text + "' has " + std::to_string(limits.size()) + " numbers, not 4 or 6");
  const Eigen::Vector3d low(limits[0], limits[2], limits[4]), high(limits[1], limits[3], limits[5]);
  if (!(low.array() < high.array()).all()) throw InputError("--crop", 0, "'" + text + "' contains nothing");
  return {low, high};
}

RunParams params_of(const MapArguments& arguments) {
  auto settings = collect_settings(arguments.parameters.config_path, arguments.parameters.set);
  RunParams params = with_settings(RunParams{}, settings);
  if (arguments.voxel_m) params.map.voxel_m = *arguments.voxel_m;
  params.map.pcd = params.map.pcd || arguments.pcd;
  params.map.max_shown_points = 0;
  return params;
}

/// The robots with scans, on the trajectories of the run or of one of its hypotheses.
std::vector<ScannedTrajectory> placed_by(const fs::path& folder, const RunFolder& run,
                                         std::vector<ScannedTrajectory> robots) {
  for (ScannedTrajectory& robot : robots) {
    if (!has_frame(robot.id, run.components, run.unplaced)) continue;
    if (auto poses = read_dense(folder, robot.id)) robot.poses = *std::move(poses);
  }
  const auto has_poses = [](const ScannedTrajectory& robot) { return !robot.poses.empty(); };
  if (std::none_of(robots.begin(), robots.end(), has_poses))
    throw InputError(folder.string(), 0,
                     "has no continuous trajectory (dense/<robot>.tum) of a robot with scans");
  return robots;
}

/// The run's components; one of all robots where it names none.
std::vector<Component> components_of(const RunFolder& run) {
  if (!run.components.empty()) return run.components;
  Component all;
  for (const auto& robot : run.robots) all.robots.push_back(robot.id);
  return {all};
}

nlohmann::ordered_json json_of(const std::vector<MapResult>& maps) {
  auto json = nlohmann::ordered_json::array();
  for (const MapResult& map : maps)
    json.push_back({{"robots", map.robots},
                    {"points", map.all_points},
                    {"seen_through", map.seen_through},
                    {"voxel_m", map.voxel_m},
                    {"scans", map.scans},
                    {"cell_m", map.grid.cell_m},
                    {"cells", map.grid.cells.size()}});
  return json;
}

/// Of the run first, then of its alternatives.
nlohmann::ordered_json json_of(const std::vector<WrittenMaps>& written) {
  auto hypotheses = nlohmann::ordered_json::array();
  for (std::size_t k = 1; k < written.size(); ++k) hypotheses.push_back({{"maps", json_of(written[k].maps)}});
  return {{"maps", json_of(written.front().maps)},
          {"hypotheses", std::move(hypotheses)},
          {"notes", written.front().notes}};
}

void print(const WrittenMaps& written, const fs::path& folder) {
  for (const MapResult& map : written.maps)
    std::cout << folder.string() << ": " << map.all_points << " points of " << map.robots.size()
              << " robots in voxels of " << map.voxel_m << " m, without " << map.seen_through
              << " that were seen through; " << map.grid.width << " x " << map.grid.height << " cells of "
              << map.grid.cell_m << " m\n";
}

/// The folders of the run that have continuous trajectories: its own, which is empty, and those of the
/// alternatives.
std::vector<fs::path> parts_of(const fs::path& run) {
  std::vector<fs::path> parts{fs::path()};
  for (std::size_t k = 0; fs::is_directory(run / hypothesis_folder(k) / "dense"); ++k)
    parts.push_back(hypothesis_folder(k));
  return parts;
}

void make_map(const MapArguments& arguments) {
  const RunParams params = params_of(arguments);
  ProgressLine line;
  MapOptions options{{}, line.progress()};
  if (!arguments.crop.empty()) options.crop = crop_of(arguments.crop);
  const RunFolder run = read_run(arguments.run);
  const auto robots = scans_of(read_input(arguments.mission).mission);
  if (robots.empty()) throw InputError(arguments.mission.front(), 0, "has no LiDAR scans to make a map of");
  const fs::path from = arguments.run, to = arguments.output.empty() ? arguments.run : arguments.output;
  const std::vector<fs::path> parts = parts_of(from);
  // All files are written beside their places before the first of them is moved there.
  std::vector<std::unique_ptr<OutputFile>> files;
  std::vector<WrittenMaps> written;
  for (const fs::path& part : parts)
    written.push_back(
        write_maps(placed_by(from / part, run, robots), components_of(run), params, options,
                   [&](const fs::path& name, const std::function<void(const AppendToFile&)>& content) {
                     files.push_back(std::make_unique<OutputFile>(to / part / name));
                     content([&](std::string_view piece) { files.back()->append(piece); });
                   }));
  for (const auto& file : files) file->commit();
  if (arguments.json) {
    std::cout << json_of(written).dump(2) << '\n';
    return;
  }
  for (const std::string& note : written.front().notes) std::cout << "note: " << note << '\n';
  for (std::size_t k = 0; k < parts.size(); ++k) print(written[k], parts[k].empty() ? to : to / parts[k]);
}

}  // namespace

void add_map(CLI::App& program) {
  const auto arguments = std::make_shared<MapArguments>();
  auto* command = program.add_subcommand("map", "Make the map of an earlier run: points and occupancy grid");
  command->add_option("OUT", arguments->run, "Output folder of `radioslam run`")->required();
  command->add_option("MISSION", arguments->mission, "Its mission folder, with LiDAR scans")
      ->required()
      ->expected(1);
  command
      ->add_option("-o,--output", arguments->output,
                   "Folder to write the files into (default: OUT); files of the same names are replaced")
      ->type_name("PATH");
  constexpr double kMinVoxel_m = 0.005, kMaxVoxel_m = 100;
  command->add_option("--voxel", arguments->voxel_m, "Voxel size (default: map.voxel_m)")
      ->check(number_from(kMinVoxel_m, kMaxVoxel_m))
      ->type_name("M");
  command
      ->add_option("--crop", arguments->crop,
                   "Leave out what is outside of these limits in the frame of the map")
      ->type_name("X0,X1,Y0,Y1[,Z0,Z1]");
  command->add_flag("--pcd", arguments->pcd, "Write map.pcd as well");
  add_parameter_options(*command, arguments->parameters);
  add_json_option(*command, arguments->json);
  add_threads_option(*command);
  command->footer(
      "Writes map.ply, map.pgm and map.yaml; of a team in several frames, map-<first robot>.ply and so on "
      "for each.\n"
      "Where the team's alignment is ambiguous, the same for each of hypotheses/<k>.\n"
      "`radioslam parameters run` lists the parameters for --set and --config; those of the map are "
      "map.*.\n\n"
      "Example:\n  radioslam map hall-out hall --voxel 0.05 --crop 0,10,-5,5");
  command->callback([arguments] { make_map(*arguments); });
}

}  // namespace radioslam::cli
