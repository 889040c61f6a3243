#include "radioslam/cli/parameter_sets.hpp"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands/anchors_params.hpp"
#include "radioslam/cli/commands/optimize_params.hpp"
#include "radioslam/cli/commands/similarity_params.hpp"
#include "radioslam/cli/run_parameters.hpp"
#include "radioslam/io/datasets/android_recording.hpp"
#include "radioslam/io/datasets/wifi_rtt.hpp"
#include "radioslam/io/lidar/carmen.hpp"
#include "radioslam/io/wifi/airodump_csv.hpp"
#include "radioslam/io/wifi/iw_ftm.hpp"
#include "radioslam/io/wifi/wifi_capture.hpp"
#include "radioslam/io/wifi/wifi_scan_log.hpp"
#include "radioslam/mission/dead_reckoning.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/rendezvous_world/rendezvous_run.hpp"
#include "radioslam/sim/scenarios/scenarios.hpp"
#include "radioslam/sim/scenarios/study_scenarios.hpp"

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
DefaultParameters scanned_drive_defaults() { return defaults_in(scanned_drive()); }
DefaultParameters scanned_hall_defaults() { return defaults_in(scanned_hall()); }
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
    {"optimize", defaults_of<OptimizeParams>},
    {"similarity", defaults_of<SimilarityCommandParams>},
    {"aoa", defaults_of<AoaParams>},
    {"anchors", defaults_of<AnchorsParams>},
    {"rendezvous", defaults_of<RendezvousRunParams>},
    {"import indoor-location", defaults_of<DeadReckoningParams>},
    {"import android", defaults_of<AndroidParams>},
    {"import imu", defaults_of<DeadReckoningParams>, "import indoor-location"},
    {"import odometry", nullptr, {}, kNoneOfImport},
    {"import waypoints", nullptr, {}, kNoneOfImport},
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
    {"reproduce wi-closure-table1", scanned_drive_defaults, "simulate kitti"},
    {"reproduce wi-closure-hall", scanned_hall_defaults, "simulate hall"},
    {"reproduce robustness-map", robustness_defaults, "simulate city"},
    {"reproduce overlap-growth", nullptr, {}, kNoneOfTable},
    {"reproduce verification-budget", nullptr, {}, kNoneOfTable},
    {"reproduce distributed-optimization", nullptr, {}, kNoneOfTable},
    {"reproduce rendezvous", nullptr, {}, kNoneOfTable},
    {"reproduce team", nullptr, {}, kNoneOfTable},
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

using Descriptions = std::vector<ParameterDescription>;

constexpr std::string_view kOpening =
    "# Parameters\n\n"
    "`--set name=value` and `--config FILE` (YAML, one map per section) change them; `radioslam parameters\n"
    "COMMAND` lists them. The basic ones come first; the defaults of the others are meant to be kept.\n"
    "This page is written by `scripts/parameters_page.sh`.\n";

std::string cell(std::string_view text) {
  std::string escaped;
  for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
  return escaped;
}

std::string name_with_unit(const ParameterDescription& parameter) {
  return parameter.default_value + (parameter.unit.empty() ? "" : " " + parameter.unit);
}

std::string table(const Descriptions& parameters) {
  std::string text = "\n| parameter | default | range | meaning |\n| --- | --- | --- | --- |\n";
  for (const ParameterDescription& parameter : parameters)
    text += "| `" + parameter.key + "` | " + cell(name_with_unit(parameter)) + " | " + cell(parameter.range) +
            " | " + cell(parameter.description) + " |\n";
  return text;
}

std::string_view section_of(const ParameterDescription& parameter) {
  const std::size_t dot = parameter.key.rfind('.');
  return std::string_view(parameter.key).substr(0, dot == std::string::npos ? 0 : dot);
}

/// One table per section, in the program's order.
std::string sections(const Descriptions& parameters) {
  std::string text;
  for (auto begin = parameters.begin(); begin != parameters.end();) {
    const std::string_view section = section_of(*begin);
    const auto end = std::find_if(begin, parameters.end(), [&](const ParameterDescription& parameter) {
      return section_of(parameter) != section;
    });
    if (!section.empty()) text += "\n### " + std::string(section) + "\n";
    text += table(Descriptions(begin, end));
    begin = end;
  }
  return text;
}

/// A call with parameters of its own.
std::string chapter(const ParameterSet& set) {
  const Descriptions parameters = describe_parameters(set.defaults().parameters);
  const Descriptions basic = basic_parameters(parameters);
  std::string text = "\n## " + std::string(set.call) + "\n";
  if (basic.size() < parameters.size()) {
    text += "\n### Basic parameters of " + std::string(set.call) + "\n" + table(basic);
    if (section_of(parameters.front()).empty())
      text += "\n### All parameters of " + std::string(set.call) + "\n";
  }
  return text + sections(parameters);
}

/// "- `reproduce aoa`: as `aoa`", with the defaults that differ.
std::string reference(const ParameterSet& set) {
  const Descriptions own = describe_parameters(set.defaults().parameters);
  const Descriptions other = describe_parameters(parameter_set(std::string(set.like)).defaults().parameters);
  std::string differences;
  for (std::size_t k = 0; k < own.size(); ++k)
    if (own[k].default_value != other[k].default_value)
      differences +=
          (differences.empty() ? ", but with " : ", ") + ("`" + own[k].key + "` = ") + name_with_unit(own[k]);
  return "- `" + std::string(set.call) + "`: as `" + std::string(set.like) + "`" + differences + "\n";
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

std::string parameters_page() {
  std::string chapters, references = "\n## Calls with the parameters of others\n\n";
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    if (set.like.empty())
      chapters += chapter(set);
    else if (!set.like.starts_with(std::string(set.call) + " "))  // "simulate" needs a scenario
      references += reference(set);
  }
  return std::string(kOpening) + chapters + references;
}

}  // namespace radioslam::cli
