// radioslam import: other people's recordings become a mission folder.
#include <iostream>
#include <memory>
#include <string>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/indoor_location.hpp"
#include "radioslam/io/mission_folder.hpp"

namespace radioslam::cli {
namespace {

constexpr const char* kIndoorLocation = "indoor-location";

struct ImportOptions {
  std::string kind;
  std::string source;
  std::string output;
  ParameterOptions parameters;
};

void import_recordings(const ImportOptions& options) {
  if (options.kind != kIndoorLocation) {
    throw InputError("import " + options.kind, 0,
                     "there is no such kind of source" + did_you_mean(options.kind, {kIndoorLocation}));
  }
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto params = with_settings(DeadReckoningParams{}, settings);
  OutputFolder output(options.output, kMissionFolder);
  const ImportedMission imported = import_indoor_location(options.source, params);
  write_mission(output.path(), imported.mission, imported.truth);
  output.commit();
  for (const auto& warning : imported.warnings) std::cout << "note: " << warning << '\n';
  std::cout << options.output << ": " << imported.mission.robots.size() << " robots, "
            << imported.mission.access_points.size() << " access points\n";
}

}  // namespace

void add_import(CLI::App& program) {
  const auto options = std::make_shared<ImportOptions>();
  auto* command = program.add_subcommand("import", "Turn other people's recordings into a mission");
  command->add_option("KIND", options->kind, "indoor-location: phone logs of walks on one floor")->required();
  command->add_option("SOURCE", options->source, "A log, or a folder that holds logs at any depth")
      ->required();
  add_output_option(*command, options->output, "The mission folder to write; replaced if there is one");
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "`radioslam parameters import` lists what --set can change.\n\n"
      "Example: the walks of one floor\n"
      "  radioslam import indoor-location site1/F1 -o walks");
  command->callback([options] { import_recordings(*options); });
}

}  // namespace radioslam::cli
