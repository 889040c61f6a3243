// radioslam log: prints what logs of robots contain.
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/io/run/robot_logs.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam::cli {
namespace {

struct LogArguments {
  std::vector<std::string> files;
  bool json = false;
};

struct KindOfLog {
  std::size_t records = 0, bytes = 0;
};

/// What is known of one robot.
struct LogSummary {
  std::map<std::size_t, KindOfLog> kinds;  ///< by the index of a record's kind
  std::size_t bytes = 0;                   ///< of all records
  double path_m = 0;                       ///< between keyframes that follow each other
};

LogSummary summary_of(const KnownLog& log) {
  LogSummary summary;
  for (const auto& [number, bytes] : log.records) {
    const auto record = decode_record(bytes);
    KindOfLog& kind = summary.kinds[record->index()];
    ++kind.records;
    kind.bytes += bytes.size();
    summary.bytes += bytes.size();
    if (const auto* keyframe = std::get_if<KeyframeRecord>(&*record); keyframe && keyframe->number > 0)
      summary.path_m += keyframe->T_before_this.translation().norm();
  }
  return summary;
}

nlohmann::ordered_json summary_json(const std::string& robot, const KnownLog& log) {
  const LogSummary summary = summary_of(log);
  nlohmann::ordered_json kinds, gaps = nlohmann::ordered_json::array();
  for (const auto& [kind, of] : summary.kinds)
    kinds[kRecordKinds[kind]] = {{"records", of.records}, {"bytes", of.bytes}};
  for (const auto& [first, last] : log.gaps()) gaps.push_back({first, last});
  return {{"robot", robot},
          {"life", log.life},
          {"records", log.records.size()},
          {"bytes", summary.bytes},
          {"by_kind", std::move(kinds)},
          {"metres", summary.path_m},
          {"missing", std::move(gaps)}};
}

void print(const std::string& robot, const KnownLog& log) {
  const LogSummary summary = summary_of(log);
  std::cout << "robot " << robot << ": " << log.records.size() << " records, " << summary.bytes << " bytes";
  if (summary.path_m > 0)
    std::cout << ", " << std::fixed << std::setprecision(1)
              << static_cast<double>(summary.bytes) / summary.path_m << " a metre of " << summary.path_m
              << " m" << std::defaultfloat;
  std::cout << '\n';
  for (const auto& [kind, of] : summary.kinds)
    std::cout << "  " << std::left << std::setw(12) << kRecordKinds[kind] << std::right << std::setw(9)
              << of.records << std::setw(11) << of.bytes << " bytes\n";
  for (const auto& [first, last] : log.gaps())
    std::cout << "  records " << first << " to " << last << " are missing\n";
}

void print_logs(const LogArguments& options) {
  const LogFiles logs = read_logs({options.files.begin(), options.files.end()});
  if (options.json) {
    nlohmann::ordered_json robots = nlohmann::ordered_json::array();
    for (const auto& [robot, log] : logs.team.robots()) robots.push_back(summary_json(robot, log));
    nlohmann::ordered_json json;
    if (robots.size() == 1)
      json = std::move(robots.front());
    else
      json["robots"] = std::move(robots);
    json["notes"] = logs.notes;
    std::cout << json.dump(2) << '\n';
    return;
  }
  for (const std::string& note : logs.notes) std::cout << "note: " << note << '\n';
  for (const auto& [robot, log] : logs.team.robots()) print(robot, log);
}

}  // namespace

void add_log(CLI::App& program) {
  const auto options = std::make_shared<LogArguments>();
  auto* command = program.add_subcommand("log", "Print what logs of robots contain");
  command
      ->add_option("FILE", options->files,
                   "Logs, as `radioslam run --log` writes them; of one or several robots")
      ->required();
  add_json_option(*command, options->json);
  command->footer("Example:\n  radioslam log logs/a.rslog");
  command->callback([options] { print_logs(*options); });
}

}  // namespace radioslam::cli
