// radioslam poses: where the robots of a run were at given times.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/run/run_tables.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

struct PosesArguments {
  std::string run, at, robot, output;
};

struct AskedPose {
  std::size_t robot = 0;
  Stamp stamp;
};

/// The robots of a run between their keyframes.
class EstimatedMotion {
 public:
  explicit EstimatedMotion(const std::filesystem::path& folder) : robots_(read_run(folder).robots) {
    for (const EstimatedTrajectory& robot : robots_)
      dense_.push_back(read_dense(folder, robot.id).value_or(robot.poses));
  }

  std::optional<std::size_t> index(std::string_view id) const {
    const auto found =
        std::find_if(robots_.begin(), robots_.end(), [&](const auto& robot) { return robot.id == id; });
    if (found == robots_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - robots_.begin());
  }
  const std::string& id(std::size_t robot) const { return robots_[robot].id; }

  /// Nothing before the first keyframe, after the last, and in stretches without poses.
  std::optional<SE3> pose(const AskedPose& asked) const {
    const auto& untied = robots_[asked.robot].untied;
    if (std::any_of(untied.begin(), untied.end(), [&](const auto& stretch) {
          return stretch.first < asked.stamp && asked.stamp < stretch.second;
        }))
      return std::nullopt;
    return dense_[asked.robot].at(asked.stamp);
  }

  /// The variance is interpolated between keyframes. Nothing where the run states none.
  std::optional<double> sigma(const AskedPose& asked,
                              std::vector<double> EstimatedTrajectory::*sigmas) const {
    const EstimatedTrajectory& robot = robots_[asked.robot];
    const std::vector<double>& of = robot.*sigmas;
    if (of.size() != robot.poses.size() || !robot.poses.covers(asked.stamp)) return std::nullopt;
    if (of.size() == 1) return of.front();
    const std::size_t k = robot.poses.segment(asked.stamp);
    const double share = seconds_between(robot.poses[k].stamp, asked.stamp) /
                         seconds_between(robot.poses[k].stamp, robot.poses[k + 1].stamp);
    return std::sqrt((1 - share) * of[k] * of[k] + share * of[k + 1] * of[k + 1]);
  }

 private:
  std::vector<EstimatedTrajectory> robots_;
  std::vector<Trajectory<SE3>> dense_;
};

std::vector<AskedPose> read_asked(const PosesArguments& options, const EstimatedMotion& motion) {
  CsvReader::Columns columns{{"t_s"}};
  (options.robot.empty() ? columns.required : columns.optional).push_back("robot");
  const auto of_option = motion.index(options.robot);
  if (!options.robot.empty() && !of_option)
    throw InputError("--robot", 0, "'" + options.robot + "' is not a robot of " + options.run);
  const Text text = read_text(options.at);
  CsvReader csv(text, columns);
  std::vector<AskedPose> asked;
  while (csv.next()) {
    const auto robot = csv.given(1) ? motion.index(csv.field(1)) : of_option;
    if (!robot) csv.fail("unknown robot '" + std::string(csv.given(1) ? csv.field(1) : "") + "'");
    asked.push_back({*robot, csv.stamp(0)});
  }
  return asked;
}

void answer(const PosesArguments& options) {
  const EstimatedMotion motion(options.run);
  std::optional<OutputFile> file;
  if (!options.output.empty()) file.emplace(options.output);
  std::string table = "robot,t_s,x,y,z,qx,qy,qz,qw,sigma_m,sigma_rad,sigma_team_m\n";
  std::map<std::size_t, std::size_t> without;
  for (const AskedPose& asked : read_asked(options, motion)) {
    const auto pose = motion.pose(asked);
    if (!pose) ++without[asked.robot];
    table += motion.id(asked.robot) + "," + format_stamp(asked.stamp);
    append_pose_fields(table, pose);
    for (const auto sigmas : {&EstimatedTrajectory::sigma_position_m, &EstimatedTrajectory::sigma_rad,
                              &EstimatedTrajectory::sigma_team_m}) {
      table += ',';
      const auto sigma = pose ? motion.sigma(asked, sigmas) : std::nullopt;
      if (sigma) append_number(table, *sigma);
    }
    table += '\n';
  }
  for (const auto& [robot, count] : without)
    std::cerr << "note: robot " << motion.id(robot) << ": " << count
              << " times have no pose: the run has none of it there\n";
  if (file)
    file->commit(table);
  else
    std::cout << table;
}

}  // namespace

void add_poses(CLI::App& program) {
  const auto options = std::make_shared<PosesArguments>();
  auto* command = program.add_subcommand("poses", "Print where the robots of a run were at given times");
  command->add_option("RUN", options->run, "Folder that `radioslam run` wrote")->required();
  command
      ->add_option("--at", options->at,
                   "CSV table of times: columns t_s and robot, or t_s alone with --robot; any order")
      ->required()
      ->type_name("FILE");
  command->add_option("--robot", options->robot, "The robot, where the table names none")->type_name("ID");
  command->add_option("-o,--output", options->output, "File to write (default: standard output)")
      ->type_name("FILE");
  command->footer(
      "A row per time: robot,t_s,x,y,z,qx,qy,qz,qw,sigma_m,sigma_rad,sigma_team_m, the pose in the frame of\n"
      "the run and standard deviations as in uncertainty.csv. Poses are interpolated between those of\n"
      "dense/<robot>.tum, variances between keyframes. Where a run has no pose the fields are empty, with a\n"
      "note on standard error.\n\n"
      "Example:\n"
      "  radioslam poses carpark-out --at images.csv -o image-poses.csv");
  command->callback([options] { answer(*options); });
}

}  // namespace radioslam::cli
