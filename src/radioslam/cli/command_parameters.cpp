// radioslam parameters: what can be set, in which unit and range.
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "radioslam/cli/anchors_params.hpp"
#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/similarity_params.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/airodump_csv.hpp"
#include "radioslam/io/carmen.hpp"
#include "radioslam/io/iw_ftm.hpp"
#include "radioslam/io/printed_scans.hpp"
#include "radioslam/io/wifi_capture.hpp"
#include "radioslam/io/wifi_rtt.hpp"
#include "radioslam/mission/dead_reckoning.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/sim/scenarios.hpp"

namespace radioslam::cli {
namespace {

struct ParametersOptions {
  std::string command = "run";
  bool json = false;
};

/// The parameters of one command.
struct ParameterSet {
  std::string command;
  std::function<std::vector<ParameterDescription>()> describe;
};

std::vector<ParameterSet> parameter_sets() {
  return {{"run", describe_parameters<RunParams>},
          {"simulate", describe_parameters<CarparkParams>},
          {"carpark", describe_parameters<CarparkParams>},
          {"city", describe_parameters<CityParams>},
          {"corridors", describe_parameters<CorridorsParams>},
          {"csi", describe_parameters<CsiRoomParams>},
          {"hall", describe_parameters<HallParams>},
          {"kitti", describe_parameters<KittiParams>},
          {"optimize", describe_parameters<OptimizerParams>},
          {"similarity", describe_parameters<SimilarityCommandParams>},
          {"aoa", describe_parameters<ArrivalParams>},
          {"anchors", describe_parameters<AnchorsParams>},
          {"import", describe_parameters<DeadReckoningParams>},
          {"indoor-location", describe_parameters<DeadReckoningParams>},
          {"iw-ftm", describe_parameters<IwFtmParams>},
          {"iw", describe_parameters<PrintedScanParams>},
          {"iwlist", describe_parameters<PrintedScanParams>},
          {"nmcli", describe_parameters<PrintedScanParams>},
          {"airodump", describe_parameters<AirodumpParams>},
          {"pcap", describe_parameters<WifiCaptureParams>},
          {"wifi-rtt", describe_parameters<WifiRttParams>},
          {"carmen", describe_parameters<CarmenParams>}};
}

std::vector<ParameterDescription> parameters_of(const std::string& command) {
  for (const char* kind : {"rosbag", "wifine"})
    if (command == kind) throw InputError("parameters " + command, 0, "this import has no parameters");
  std::vector<std::string> commands;
  for (const auto& set : parameter_sets()) {
    if (set.command == command) return set.describe();
    commands.push_back(set.command);
  }
  throw InputError("parameters " + command, 0, "no such list" + did_you_mean(command, commands));
}

nlohmann::ordered_json json_of(const std::vector<ParameterDescription>& parameters) {
  auto object = nlohmann::ordered_json::object();
  for (const auto& parameter : parameters) {
    object[parameter.key] = {{"default", parameter.default_value},
                             {"unit", parameter.unit},
                             {"range", parameter.range},
                             {"meaning", parameter.meaning}};
  }
  return object;
}

void list_parameters(const ParametersOptions& options) {
  const auto parameters = parameters_of(options.command);
  if (options.json) {
    std::cout << json_of(parameters).dump(2) << '\n';
  } else {
    std::cout << parameter_list_text(parameters);
  }
}

}  // namespace

void add_parameters(CLI::App& program) {
  const auto options = std::make_shared<ParametersOptions>();
  auto* command = program.add_subcommand("parameters", "List what --set and --config can change");
  command->add_option(
      "COMMAND", options->command,
      "run (default), simulate, carpark, city, corridors, csi, hall, kitti, optimize, similarity, aoa, "
      "anchors, import, indoor-location, iw-ftm, iw, iwlist, nmcli, airodump, pcap, wifi-rtt or carmen");
  add_json_option(*command, options->json);
  command->footer("Example:\n  radioslam parameters run | less");
  command->callback([options] { list_parameters(*options); });
}

}  // namespace radioslam::cli
