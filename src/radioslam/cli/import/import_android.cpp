#include <iostream>
#include <string>

#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/import/import_commands.hpp"
#include "radioslam/cli/import/wifi_summary.hpp"
#include "radioslam/io/datasets/android_recording.hpp"
#include "radioslam/io/mission/mission_output.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/csv.hpp"

namespace radioslam::cli {

void import_android(const ImportOptions& options) {
  const auto params = params_of<AndroidParams>(options);
  const ImportedRobot robot = robot_of_import(options);
  refuse_replacing_inputs(options.output, options.sources);
  MissionOutput output(options.output, existing_of(options));
  AndroidRecording recording =
      read_android_recording({options.sources.begin(), options.sources.end()}, params);
  const std::vector<WifiRow>& rows = recording.wifi.rows;
  const bool has_motion = !recording.robot.odometry.empty();
  if (has_motion) output.expect_free(robot.id, true);
  if (!rows.empty()) write_file(output.folder_of(robot.id) / "wifi.csv", format_wifi_rows(rows));
  Mission mission;
  mission.name = name_of_source(options.output);
  recording.robot.id = robot.id;
  mission.robots.push_back(std::move(recording.robot));
  Truth truth;
  if (!recording.truth.empty()) truth.robots.push_back({robot.id, recording.truth, false});
  output.commit(mission, truth);
  print_notes(recording.wifi);
  for (const auto& notes : {recording.warnings, output.notes(), notes_on(options, robot)})
    for (const std::string& note : notes) std::cout << "note: " << note << '\n';
  std::cout << options.output << ": " << (has_motion ? std::to_string(recording.steps) + " steps" : "")
            << (has_motion && !rows.empty() ? ", " : "") << (rows.empty() ? "" : wifi_summary(rows)) << " of "
            << robot.id << '\n';
}

}  // namespace radioslam::cli
