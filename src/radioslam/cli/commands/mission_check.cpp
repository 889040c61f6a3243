#include "radioslam/cli/commands/mission_check.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <utility>

#include "radioslam/base/suggestion.hpp"
#include "radioslam/doctor/check_mission.hpp"
#include "radioslam/io/mission/mission_folder.hpp"
#include "radioslam/io/mission/mission_yaml.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// Kinds of findings, in the order of InputError::Kind.
constexpr std::array kKinds{"unreadable",   "spelling", "clock",    "too-little",
                            "column-order", "unit",     "duplicate"};

/// The name between the first two quotes, or nothing.
std::string quoted(const std::string& reason) {
  const auto begin = reason.find('\''), end = reason.find('\'', begin + 1);
  return end == std::string::npos ? "" : reason.substr(begin + 1, end - begin - 1);
}

std::vector<std::string> robots_of(const fs::path& folder) {
  std::vector<std::string> ids;
  try {
    for (const Robot& robot : read_mission_yaml(read_text(folder / "mission.yaml"), "").mission.robots)
      ids.push_back(robot.id);
  } catch (const InputError&) {
    ids.clear();
  }
  return ids;
}

/// Robot whose folder the file lies in, or that the reason names.
std::string robot_of(const std::string& file, const std::string& reason,
                     const std::vector<std::string>& ids) {
  for (const std::string& id : ids)
    if (file.starts_with("robots/" + id + "/")) return id;
  const std::string name = quoted(reason);
  for (const std::string& id : ids)
    if (id == name) return id;
  return {};
}

/// Letters and digits in lower case.
std::string canonical(const std::string& name) {
  std::string result;
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)))
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

/// The robot that a misspelled name is likeliest to mean, or nothing.
std::string meant_robot(const std::string& name, const std::vector<std::string>& ids) {
  for (const std::string& id : ids)
    if (canonical(id) == canonical(name)) return id;
  const auto near = nearest_names(name, ids);
  return near.empty() ? "" : near.front();
}

Finding refused(const InputError& error, const fs::path& folder) {
  const auto ids = robots_of(folder);
  Finding finding;
  finding.severity = Severity::kError;
  finding.kind = kKinds.at(static_cast<std::size_t>(error.kind()));
  finding.file = fs::relative(error.file(), folder).string();
  if (finding.file.starts_with("..")) finding.file = error.file();
  finding.robot = robot_of(finding.file, error.reason(), ids);
  finding.found = (error.line() > 0 ? "line " + std::to_string(error.line()) + ": " : "") + error.reason();
  finding.expected = "a file that can be read";
  finding.advice = "correct the file";
  if (error.kind() == InputError::Kind::kSpelling) {
    finding.expected = "a robot or antenna of mission.yaml";
    const std::string meant = meant_robot(quoted(error.reason()), ids);
    if (!meant.empty()) finding.advice += "; did you mean " + meant + "?";
    if (finding.robot.empty() && canonical(meant) == canonical(quoted(error.reason()))) finding.robot = meant;
  }
  return finding;
}

std::vector<Finding> checked(const Mission& mission, const Truth& truth) {
  std::vector<Finding> findings = check_mission(mission);
  for (Finding& finding : check_truth(mission, truth)) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace

std::vector<Finding> examine_mission(const fs::path& folder) {
  if (!fs::exists(folder / "mission.yaml")) read_mission(folder);  // refuses, and says why
  try {
    const Mission mission = read_mission(folder);
    return checked(mission, read_truth(folder, mission));
  } catch (const InputError& error) {
    return {refused(error, folder)};
  }
}

std::vector<Finding> warnings_about(const Mission& mission, const Truth& truth, const std::string& folder) {
  const std::vector<Finding> findings = checked(mission, truth);
  const auto errors = std::count_if(findings.begin(), findings.end(),
                                    [](const Finding& f) { return f.severity == Severity::kError; });
  if (errors == 0) return findings;
  Finding first = findings.front();
  const std::string file = first.file.empty() ? folder : (fs::path(folder) / first.file).string();
  first.file.clear();
  throw InputError(file, 0,
                   text_of(first) + (errors > 1 ? "; and " + std::to_string(errors - 1) + " more" : "") +
                       " (radioslam doctor lists all findings; --unchecked runs nevertheless)");
}

bool has_mirrored_truth(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(), [](const Finding& f) {
    return f.kind == "handedness" && f.file.ends_with("groundtruth.tum");
  });
}

}  // namespace radioslam::cli
