#include "radioslam/cli/parameter_sets.hpp"

#include <array>
#include <set>
#include <utility>
#include <vector>

#include "radioslam/cli/commands/anchors_params.hpp"
#include "radioslam/cli/commands/similarity_params.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/datasets/wifi_rtt.hpp"
#include "radioslam/io/lidar/carmen.hpp"
#include "radioslam/io/wifi/airodump_csv.hpp"
#include "radioslam/io/wifi/iw_ftm.hpp"
#include "radioslam/io/wifi/wifi_capture.hpp"
#include "radioslam/io/wifi/wifi_scan_log.hpp"
#include "radioslam/mission/dead_reckoning.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/sim/scenarios/scenarios.hpp"
#include "radioslam/study/robustness_map/robustness_map.hpp"
#include "radioslam/study/wi_closure_kitti/wi_closure_kitti.hpp"

namespace radioslam::cli {
namespace {

template <class Params>
DefaultParameters defaults_in(Params params) {
  auto values = std::make_shared<Params>(std::move(params));
  auto parameters = parameters_in(*values);
  return {std::move(values), std::move(parameters)};
}

template <class Params>
DefaultParameters defaults_of() {
  return defaults_in(Params{});
}

DefaultParameters wi_closure_defaults() { return defaults_in(wi_closure_drive()); }
DefaultParameters robustness_defaults() { return defaults_in(robustness_town()); }

/// Lists of no more parameters than this are not shortened.
constexpr std::size_t kShortList = 20;

constexpr std::string_view kNoneOfCommand = "this command has no parameters";
constexpr std::string_view kNoneOfImport = "this import has no parameters";
constexpr std::string_view kNoneOfTable = "this table has no parameters";
constexpr std::string_view kNameATable = "each table has parameters of its own; give its name";

constexpr std::array kParameterSets = std::to_array<ParameterSet>({
    {"run", defaults_of<RunParams>},
    {"prune", defaults_of<RunParams>, "run"},
    {"evaluate", nullptr, {}, kNoneOfCommand},
    {"simulate carpark", defaults_of<CarparkParams>},
    {"simulate city", defaults_of<CityParams>},
    {"simulate corridors", defaults_of<CorridorsParams>},
    {"simulate csi", defaults_of<CsiRoomParams>},
    {"simulate hall", defaults_of<HallParams>},
    {"simulate kitti", defaults_of<KittiParams>},
    {"simulate", defaults_of<CarparkParams>, "simulate carpark"},
    {"optimize", defaults_of<OptimizerParams>},
    {"similarity", defaults_of<SimilarityCommandParams>},
    {"aoa", defaults_of<AoaParams>},
    {"anchors", defaults_of<AnchorsParams>},
    {"import indoor-location", defaults_of<DeadReckoningParams>},
    {"import iw-ftm", defaults_of<IwFtmParams>},
    {"import iw", defaults_of<ScanListParams>},
    {"import iwlist", defaults_of<ScanListParams>, "import iw"},
    {"import nmcli", defaults_of<ScanListParams>, "import iw"},
    {"import airodump", defaults_of<AirodumpParams>},
    {"import pcap", defaults_of<WifiCaptureParams>},
    {"import wifi-rtt", defaults_of<WifiRttParams>},
    {"import carmen", defaults_of<CarmenParams>},
    {"import kitti", nullptr, {}, kNoneOfImport},
    {"import rosbag", nullptr, {}, kNoneOfImport},
    {"import wifine", nullptr, {}, kNoneOfImport},
    {"import dpgo", nullptr, {}, kNoneOfImport},
    {"import", defaults_of<DeadReckoningParams>, "import indoor-location"},
    {"reproduce wi-closure-kitti", wi_closure_defaults, "simulate kitti"},
    {"reproduce robustness-map", robustness_defaults, "simulate city"},
    {"reproduce overlap-growth", nullptr, {}, kNoneOfTable},
    {"reproduce aoa", defaults_of<AoaParams>, "aoa"},
    {"reproduce aoa-paths", defaults_of<AoaParams>, "aoa"},
    {"reproduce sequence-closures", defaults_of<CarparkParams>, "simulate carpark"},
    {"reproduce fingerprint-tables", defaults_of<CarparkParams>, "simulate carpark"},
    {"reproduce threshold-sweep", defaults_of<CarparkParams>, "simulate carpark"},
    {"reproduce", nullptr, {}, kNameATable},
    {"parameters", nullptr, {}, kNoneOfCommand},
});

const ParameterSet* find_set(std::string_view name) {
  for (const ParameterSet& set : kParameterSets)
    if (set.call == name) return &set;
  for (const ParameterSet& set : kParameterSets)
    if (set.name() == name) return &set;
  return nullptr;
}

std::vector<std::string> set_names() {
  std::set<std::string> names;
  for (const ParameterSet& set : kParameterSets) names.emplace(set.name());
  return {names.begin(), names.end()};
}

}  // namespace

std::span<const ParameterSet> parameter_sets() { return kParameterSets; }

const ParameterSet& parameter_set(const std::string& name) {
  const ParameterSet* set = find_set(name);
  if (set == nullptr)
    throw InputError("parameters " + name, 0,
                     "unknown command, scenario, kind of import or table" + did_you_mean(name, set_names()));
  if (set->defaults == nullptr) throw InputError("parameters " + name, 0, std::string(set->reason));
  return *set;
}

std::vector<ParameterDescription> basic_parameters(const std::vector<ParameterDescription>& parameters) {
  if (parameters.size() <= kShortList) return parameters;
  std::vector<ParameterDescription> basic;
  for (const ParameterDescription& parameter : parameters)
    if (parameter.level == Field::Level::kBasic) basic.push_back(parameter);
  return basic.empty() ? parameters : basic;
}

}  // namespace radioslam::cli
