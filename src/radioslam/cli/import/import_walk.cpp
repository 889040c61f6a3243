#include <iostream>
#include <string>

#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/import/import_commands.hpp"
#include "radioslam/io/datasets/walker_tables.hpp"
#include "radioslam/io/mission/mission_output.hpp"
#include "radioslam/io/mission/odometry_table.hpp"
#include "radioslam/io/mission/recorded_odometry.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/mission/dead_reckoning.hpp"

namespace radioslam::cli {
namespace {

/// The mission that gets a robot's odometry.
class OdometryOutput {
 public:
  /// Refuses (InputError) a robot that has odometry.
  explicit OdometryOutput(const ImportOptions& options)
      : options_(options), robot_(robot_of_import(options)) {
    refuse_replacing_inputs(options.output, options.sources);
    output_.expect_free(robot_.id, true);
  }

  /// `what` is the rest of the summary.
  void commit(Trajectory<SE3> odometry, const OdometryNoise& noise, const std::vector<std::string>& notes,
              const std::string& what, int dimension = 2) {
    Mission mission;
    mission.dimension = dimension;
    mission.name = name_of_source(options_.output);
    Robot& robot = mission.robots.emplace_back();
    robot.id = robot_.id;
    robot.odometry = std::move(odometry);
    robot.odometry_noise = noise;
    output_.commit(mission);
    for (const auto& some : {notes, output_.notes(), notes_on(options_, robot_)})
      for (const std::string& note : some) std::cout << "note: " << note << '\n';
    std::cout << options_.output << ": " << what << " of " << robot_.id << '\n';
  }

 private:
  const ImportOptions& options_;
  ImportedRobot robot_;
  MissionOutput output_{options_.output, existing_of(options_)};
};

/// "12.3 m" of a path.
std::string length_of(const Trajectory<SE3>& path) {
  double length_m = 0;
  for (std::size_t k = 1; k < path.size(); ++k)
    length_m += (path[k].pose.translation() - path[k - 1].pose.translation()).norm();
  constexpr double kShown_m = 0.1;
  return format_number(std::round(length_m / kShown_m) / 10) + " m";
}

}  // namespace

void import_odometry(const ImportOptions& options) {
  OdometryOutput output(options);
  std::vector<std::string> notes;
  const Trajectory<SE3> recorded = read_odometry_table(read_tool_output(only_source(options)), notes);
  Trajectory<SE3> odometry = from_start({recorded.begin(), recorded.end()});
  const int dimension = is_in_plane(odometry) ? 2 : 3;
  const std::string what =
      std::to_string(odometry.size()) + " poses, " + length_of(odometry) + " of odometry";
  output.commit(std::move(odometry), OdometryNoise{}, notes, what, dimension);
}

void import_imu(const ImportOptions& options) {
  const auto params = params_of<DeadReckoningParams>(options);
  OdometryOutput output(options);
  std::vector<Text> tables;
  for (const std::string& source : options.sources) tables.push_back(read_tool_output(source));
  std::vector<std::string> notes;
  const PhoneMotion motion = read_walker_imu(tables, notes);
  const auto &forces = motion.specific_force_mps2, &rates = motion.angular_rate_radps;
  const Stamp begin = std::min(forces.front().stamp, rates.front().stamp),
              end = std::max(forces.back().stamp, rates.back().stamp);
  if (end <= begin) throw InputError(options.sources.front(), 0, "all samples have the same time");
  const DeadReckoning walk = dead_reckon(motion, begin, end, params);
  if (walk.steps.empty()) notes.push_back("no steps detected; the robot does not move");
  output.commit(walk.odometry, walking_noise(), notes,
                std::to_string(walk.steps.size()) + " steps, " + length_of(walk.odometry));
}

void import_waypoints(const ImportOptions& options) {
  OdometryOutput output(options);
  std::vector<std::string> notes;
  const Trajectory<SE3> path = read_waypoints(read_tool_output(only_source(options)), notes);
  const SE3 start = path.front().pose;
  std::vector<StampedPose<SE3>> poses;
  for (const auto& [stamp, pose] : path) poses.push_back({stamp, start.inverse() * pose});
  notes.push_back("its start on the plan is initial_pose: [" + format_number(start.translation().x()) + ", " +
                  format_number(start.translation().y()) + ", 0, " + format_number(start.yaw()) +
                  "]; mission.yaml does not state it, because the plan's frame may not be the team's");
  OdometryNoise noise = walking_noise();  // between waypoints, whose errors do not accumulate
  noise.sigma_yaw_drift_per_m_rad = noise.sigma_scale = 0;
  output.commit(Trajectory<SE3>(std::move(poses)), noise, notes, length_of(path) + " of odometry");
}

}  // namespace radioslam::cli
