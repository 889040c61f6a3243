// radioslam anchors: locates static anchors from the distances between them, and robots from their ranges to
// the anchors (ground truth without motion capture).
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/anchors_params.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/io/mission/anchor_tables.hpp"
#include "radioslam/io/mission/team_tables.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

using Json = nlohmann::ordered_json;

struct AnchorsOptions {
  std::string distances, ranges, output;
  std::string origin, along_x, left;
  ParameterOptions parameters;
  bool json = false;
};

/// A robot's ranges and the positions estimated from them.
struct LocatedRobot {
  ReceiverRanges recorded;
  ReceiverTrack track;
};

/// The index of the anchor that an option names; nothing if the option is not given.
std::optional<std::size_t> anchor_named(const std::string& option, const std::string& id,
                                        const std::vector<std::string>& anchors) {
  if (id.empty()) return std::nullopt;
  const auto found = std::find(anchors.begin(), anchors.end(), id);
  if (found == anchors.end())
    throw InputError(option + " " + id, 0, "unknown anchor" + did_you_mean(id, anchors));
  return static_cast<std::size_t>(found - anchors.begin());
}

std::string why_not(const LayoutFailure& failure, const DistanceTable& table, int dimension) {
  const std::string& anchor = table.anchors.empty() ? std::string{} : table.anchors[failure.anchor];
  switch (failure.reason) {
    case LayoutRefusal::kTooFewAnchors:
      return "only " + std::to_string(table.anchors.size()) + " anchors; at least " +
             std::to_string(dimension + 1) + " are needed";
    case LayoutRefusal::kDisconnected:
      return "no chain of distances connects anchor '" + table.anchors.front() + "' to '" + anchor + "'";
    case LayoutRefusal::kPoorlyConstrained:
      return "too few distances: the position of anchor '" + anchor + "' is not determined";
    case LayoutRefusal::kFlat:
      return std::string("within the accuracy of the distances all anchors are on one ") +
             (dimension == 2 ? "line" : "plane") + ": robot positions would have a mirror solution";
    case LayoutRefusal::kFrame:
      return "--origin, --along-x and --left must name three anchors that are not on one line";
  }
  return {};
}

AnchorLayout layout_of(const DistanceTable& table, const AnchorsOptions& options,
                       const AnchorsParams& params) {
  const AnchorFrame frame{anchor_named("--origin", options.origin, table.anchors),
                          anchor_named("--along-x", options.along_x, table.anchors),
                          anchor_named("--left", options.left, table.anchors)};
  auto result = estimate_anchor_layout(table.anchors.size(), table.distances, frame, params.layout);
  if (const auto* failure = std::get_if<LayoutFailure>(&result))
    throw InputError(options.distances, 0, why_not(*failure, table, params.layout.dimension));
  return std::get<AnchorLayout>(std::move(result));
}

std::vector<LocatedRobot> locate(const RangeTable& table, const AnchorLayout& layout,
                                 const AnchorsParams& params) {
  std::vector<LocatedRobot> robots;
  for (const auto& receiver : table.receivers) {
    auto track = track_receiver(layout.positions_m.topRows(params.layout.dimension), receiver.ranges,
                                receiver.pairs.size(), params.track);
    robots.push_back({receiver, std::move(track)});
  }
  return robots;
}

std::string anchor_rows(const std::vector<std::string>& ids, const AnchorLayout& layout) {
  Mission mission;
  for (std::size_t k = 0; k < ids.size(); ++k)
    mission.anchors.push_back(
        {ids[k], layout.positions_m.col(static_cast<Eigen::Index>(k)), layout.sigmas_m[k]});
  return format_anchors(mission);
}

std::string position_rows(const ReceiverTrack& track) {
  std::vector<StampedPose<SE3>> poses;
  for (const auto& fix : track.fixes)
    poses.push_back({fix.stamp, SE3(fix.position_m, Eigen::Quaterniond::Identity())});
  return format_tum(Trajectory<SE3>(std::move(poses)));
}

Json json_of(const DistanceTable& table, const AnchorLayout& layout) {
  Json anchors = Json::object(), distances = Json::array();
  for (std::size_t k = 0; k < table.anchors.size(); ++k) {
    const Eigen::Vector3d p = layout.positions_m.col(static_cast<Eigen::Index>(k));
    anchors[table.anchors[k]] = {{"position_m", {p.x(), p.y(), p.z()}}, {"sigma_m", layout.sigmas_m[k]}};
  }
  for (std::size_t k = 0; k < table.distances.size(); ++k) {
    const auto& distance = table.distances[k];
    distances.push_back({{"id_i", table.anchors[distance.i]},
                         {"id_j", table.anchors[distance.j]},
                         {"distance_m", distance.distance_m},
                         {"residual_m", layout.residuals_m[k]},
                         {"used", static_cast<bool>(layout.used[k])}});
  }
  return {{"anchors", anchors},
          {"distances", distances},
          {"distance_rms_m", layout.rms_m},
          {"distance_redundancy", layout.redundancy},
          {"distance_noise_factor", layout.noise_factor}};
}

Json json_of(const LocatedRobot& robot) {
  Json biases = Json::array();
  for (std::size_t k = 0; k < robot.track.biases.size(); ++k) {
    const auto& bias = robot.track.biases[k];
    biases.push_back({{"antenna_i", robot.recorded.pairs[k].receiver},
                      {"antenna_j", robot.recorded.pairs[k].anchor},
                      {"bias_m", bias.bias_m},
                      {"sigma_m", bias.sigma_m},
                      {"spread_m", bias.spread_m},
                      {"ranges", bias.count}});
  }
  return {{"ranges", robot.recorded.ranges.size()},         {"epochs", robot.track.epochs},
          {"positions", robot.track.fixes.size()},          {"range_rms_m", robot.track.rms_m},
          {"range_noise_factor", robot.track.noise_factor}, {"biases", biases}};
}

Json summary_of(const DistanceTable& table, const AnchorLayout& layout, const RangeTable& unused,
                const std::vector<LocatedRobot>& robots) {
  Json summary = json_of(table, layout);
  summary["robots"] = Json::object();
  for (const auto& robot : robots) summary["robots"][robot.recorded.robot] = json_of(robot);
  summary["unused_ranges"] = {{"between_robots", unused.between_receivers},
                              {"between_anchors", unused.between_anchors}};
  return summary;
}

void print_anchors(const AnchorsOptions& options, const DistanceTable& table, const AnchorLayout& layout,
                   const std::vector<LocatedRobot>& robots) {
  std::cout << options.output << ": " << table.anchors.size() << " anchors from " << table.distances.size()
            << " distances, residual " << layout.rms_m << " m rms";
  if (layout.redundancy == 0) std::cout << " (no redundant distances, so errors cannot be detected)";
  std::cout << '\n';
  for (std::size_t k = 0; k < table.distances.size(); ++k)
    if (!layout.used[k])
      std::cout << "rejected distance: " << table.anchors[table.distances[k].i] << " - "
                << table.anchors[table.distances[k].j] << ", off by " << -layout.residuals_m[k] << " m\n";
  for (const auto& robot : robots) {
    std::cout << robot.recorded.robot << ": " << robot.track.fixes.size() << " positions from "
              << robot.recorded.ranges.size() << " ranges, residual " << robot.track.rms_m << " m rms\n";
    for (std::size_t k = 0; k < robot.track.biases.size(); ++k)
      std::cout << "  bias " << robot.recorded.pairs[k].receiver << " - " << robot.recorded.pairs[k].anchor
                << ": " << robot.track.biases[k].bias_m << " +- " << robot.track.biases[k].sigma_m << " m\n";
  }
}

void refuse_unplaced(const AnchorsOptions& options, const std::vector<LocatedRobot>& robots) {
  for (const auto& robot : robots)
    if (robot.track.fixes.empty())
      throw InputError(
          options.ranges, 0,
          "robot '" + robot.recorded.robot +
              "' has no position: it never measured ranges to enough anchors within epochs.epoch_s");
}

void place_anchors(const AnchorsOptions& options) {
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto params = with_settings(AnchorsParams{}, settings);
  refuse_replacing_inputs(options.output, {options.distances, options.ranges});
  OutputFolder output(options.output, kRunFolder);
  const DistanceTable table = read_distances(read_text(options.distances), params.distance_sigma_m);
  const AnchorLayout layout = layout_of(table, options, params);
  RangeTable ranges;
  if (!options.ranges.empty()) ranges = read_anchor_ranges(read_text(options.ranges), table.anchors);
  const auto robots = locate(ranges, layout, params);
  refuse_unplaced(options, robots);

  write_file(output.path() / "anchors.csv", anchor_rows(table.anchors, layout));
  for (const auto& robot : robots)
    write_file(output.path() / (robot.recorded.robot + ".tum"), position_rows(robot.track));
  const Json summary = summary_of(table, layout, ranges, robots);
  write_file(output.path() / kRunFolder, summary.dump(2) + "\n");
  output.commit();
  if (options.json)
    std::cout << summary.dump(2) << '\n';
  else
    print_anchors(options, table, layout, robots);
}

}  // namespace

void add_anchors(CLI::App& program) {
  const auto options = std::make_shared<AnchorsOptions>();
  auto* command =
      program.add_subcommand("anchors", "Locate anchors from their distances, and robots from their ranges");
  command
      ->add_option("DISTANCES", options->distances,
                   "Distances between anchors, a CSV table: id_i,id_j,distance_m[,sigma_m]")
      ->required();
  command
      ->add_option("--ranges", options->ranges,
                   "Ranges between robots and anchors, a CSV table:\n"
                   "t_s,robot_i,robot_j,range_m,sigma_m[,antenna_i,antenna_j]")
      ->type_name("RANGES");
  add_output_option(*command, options->output, "Folder to write: anchors.csv, <robot>.tum, summary.json");
  command->add_option("--origin", options->origin, "Anchor at the origin (default: the first in DISTANCES)")
      ->type_name("ID");
  command->add_option("--along-x", options->along_x, "Anchor on the positive x axis (default: the second)")
      ->type_name("ID");
  command
      ->add_option("--left", options->left,
                   "Anchor on the left of the x axis, seen from above (default: the next one that is off the "
                   "axis)")
      ->type_name("ID");
  add_json_option(*command, options->json);
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "Distances alone cannot distinguish a layout from its mirror image; --left selects one of the two.\n"
      "Names that appear in RANGES but not in DISTANCES are robots. A constant range bias per pair of "
      "antennas\n"
      "is estimated along with the positions; --set bias.prior_sigma_m=0 disables this.\n"
      "`radioslam parameters anchors` lists the parameters for --set and --config.\n\n"
      "Example:\n  radioslam anchors distances.csv --ranges ranges.csv --left A3 -o truth");
  command->callback([options] { place_anchors(*options); });
}

}  // namespace radioslam::cli
