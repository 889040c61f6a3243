// radioslam doctor: lists what looks wrong in a mission, with the likeliest correction.
#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/mission_check.hpp"

namespace radioslam::cli {
namespace {

struct DoctorArguments {
  std::string mission;
  bool json = false;
};

nlohmann::ordered_json text_or_null(const std::string& text) {
  return text.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(text);
}

const char* severity_name(Severity severity) { return severity == Severity::kError ? "error" : "warning"; }

nlohmann::ordered_json findings_json(const std::vector<Finding>& findings) {
  auto list = nlohmann::ordered_json::array();
  for (const Finding& finding : findings)
    list.push_back({{"kind", finding.kind},
                    {"severity", severity_name(finding.severity)},
                    {"robot", text_or_null(finding.robot)},
                    {"file", text_or_null(finding.file)},
                    {"found", finding.found},
                    {"expected", finding.expected},
                    {"advice", finding.advice}});
  return {{"findings", list}};
}

void print_findings(const std::vector<Finding>& findings, const std::string& mission) {
  for (const Finding& finding : findings) {
    std::cout << severity_name(finding.severity) << " (" << finding.kind << "): ";
    if (!finding.robot.empty() && finding.file.find("robots/" + finding.robot + "/") == std::string::npos)
      std::cout << "robot " << finding.robot << ": ";
    std::cout << text_of(finding) << '\n';
  }
  const auto errors = std::count_if(findings.begin(), findings.end(),
                                    [](const Finding& f) { return f.severity == Severity::kError; });
  std::cout << mission << ": " << errors << (errors == 1 ? " error, " : " errors, ")
            << std::ssize(findings) - errors
            << (std::ssize(findings) - errors == 1 ? " warning" : " warnings") << '\n';
}

void examine(const DoctorArguments& options) {
  const std::vector<Finding> findings = examine_mission(options.mission);
  if (options.json)
    std::cout << findings_json(findings).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace)
              << '\n';
  else
    print_findings(findings, options.mission);
}

}  // namespace

void add_doctor(CLI::App& program) {
  const auto options = std::make_shared<DoctorArguments>();
  auto* command =
      program.add_subcommand("doctor", "List what looks wrong in a mission, with the likeliest correction");
  command->add_option("MISSION", options->mission, "Mission folder (with mission.yaml)")->required();
  add_json_option(*command, options->json);
  command->footer(
      "Checks units, clocks, frames, order of columns, starts, gaps, repeated rows, and whether ranges, "
      "angles,\n"
      "fixes, fingerprints and IMU agree with the odometry. `radioslam run` makes the same checks: it "
      "refuses\n"
      "missions with errors and notes warnings. Exit status 0 whatever is found.\n\n"
      "Example:\n"
      "  radioslam doctor carpark");
  command->callback([options] { examine(*options); });
}

}  // namespace radioslam::cli
