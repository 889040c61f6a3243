#include "radioslam/results/result_notes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <map>
#include <sstream>

namespace radioslam {
namespace {

constexpr double kMinLookAlikes = 1.0 / 3;  // of the compared places

constexpr double kMinFitting = 0.5;   // of ranges, angles and fixes, for links that fit
constexpr std::size_t kMinLinks = 6;  // ranges or angles: fewer may all be obstructed by chance

struct Counts {
  std::size_t accepted = 0, rejected = 0;
  std::size_t all() const { return accepted + rejected; }
};

Counts count(const std::vector<ClosureResult>& closures, ClosureKind kind) {
  Counts counts;
  for (const ClosureResult& closure : closures)
    if (closure.kind == kind && closure.robot_i != closure.robot_j)
      ++(closure.status == ClosureStatus::kAccepted ? counts.accepted : counts.rejected);
  return counts;
}

/// Whether most ranges, angles and position fixes agree with the result.
bool do_links_fit(const RunResult& result) {
  Counts links;
  for (const ClosureKind kind : {ClosureKind::kRange, ClosureKind::kAoa}) {
    const Counts of_kind = count(result.closures, kind);
    links.accepted += of_kind.accepted, links.rejected += of_kind.rejected;
  }
  for (const RobotResult& robot : result.robots)
    if (robot.fixes) links.accepted += robot.fixes->used, links.rejected += robot.fixes->rejected;
  return links.all() > 0 &&
         static_cast<double>(links.accepted) >= kMinFitting * static_cast<double>(links.all());
}

bool is_placed(const RunResult& result, const std::string& id) {
  return std::find(result.unplaced.begin(), result.unplaced.end(), id) == result.unplaced.end();
}

std::string listed(const std::vector<std::string>& names) {
  std::string text = names.size() == 1 ? "robot " : "robots ";
  for (std::size_t k = 0; k < names.size(); ++k) text += (k == 0 ? "" : ", ") + names[k];
  return text;
}

/// The reason of most of them.
std::string usual_reason(const std::vector<ClosureResult>& closures, ClosureKind kind) {
  std::map<std::string, std::size_t> reasons;
  for (const ClosureResult& closure : closures)
    if (closure.kind == kind && closure.robot_i != closure.robot_j) ++reasons[closure.reason];
  const auto most = std::max_element(reasons.begin(), reasons.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most->first;
}

struct RejectedKind {
  ClosureKind kind;
  std::size_t min;  ///< fewer are not noted
  const char *name, *advice;
};

constexpr std::array kRejectedKinds{
    RejectedKind{ClosureKind::kMatch, 2, "matches", "their stamps, their poses T_i_j and their sigmas"},
    RejectedKind{ClosureKind::kFile, 2, "relative poses between robots", "their poses and covariances"},
    RejectedKind{ClosureKind::kRange, kMinLinks, "ranges", "their unit, their clock and their sigmas"},
    RejectedKind{ClosureKind::kAoa, kMinLinks, "angles",
                 "their clock, their sense of rotation and their sigmas"},
    RejectedKind{ClosureKind::kSequence, 2, "sequence closures", "the clock of the WiFi scans"}};

}  // namespace

std::vector<std::string> finding_notes(const std::vector<Finding>& findings, const RunResult& result) {
  std::vector<std::string> notes;
  for (const Finding& finding : findings) {
    // Of no robot and no file: that links do not fit.
    const bool is_of_links = finding.kind == "frame" && finding.robot.empty() && finding.file.empty();
    if (finding.kind == "not-connected" || (is_of_links && do_links_fit(result))) continue;
    notes.push_back(text_of(finding));
  }
  return notes;
}

std::vector<std::string> component_notes(const RunResult& result) {
  std::vector<std::string> notes;
  for (std::size_t c = 1; c < result.components.size(); ++c) {
    std::vector<std::string> robots;
    for (const std::string& id : result.components[c].robots)
      if (is_placed(result, id)) robots.push_back(id);
    if (robots.empty()) continue;
    notes.push_back(listed(robots) +
                    (robots.size() == 1 ? " has a frame of its own" : " have a frame of their own") +
                    ": no measurement that can be trusted ties " + (robots.size() == 1 ? "it" : "them") +
                    " to the other robots, and positions and distances between the frames mean nothing");
  }
  return notes;
}

std::vector<std::string> rejection_notes(const std::vector<ClosureResult>& closures) {
  std::vector<std::string> notes;
  for (const RejectedKind& kind : kRejectedKinds) {
    const Counts counts = count(closures, kind.kind);
    if (counts.accepted > 0 || counts.rejected < kind.min) continue;
    const std::string reason = usual_reason(closures, kind.kind);
    notes.push_back("all " + std::to_string(counts.rejected) + " " + kind.name +
                    " were rejected, so that the estimate stands without them" +
                    (reason.empty() ? "" : " (most often: " + reason + ")") + "; check " + kind.advice);
  }
  return notes;
}

std::optional<std::string> look_alike_note(const std::vector<ClosureResult>& closures,
                                           std::string_view elsewhere) {
  std::size_t compared = 0, alike = 0, accepted = 0;
  for (const ClosureResult& closure : closures) {
    if (!closure.robot_i.valid() || !closure.robot_j.valid() || closure.robot_i == closure.robot_j) continue;
    const bool is_accepted = closure.status == ClosureStatus::kAccepted;
    if (closure.kind != ClosureKind::kLidar) {
      if (is_accepted) return std::nullopt;
      continue;
    }
    ++compared;
    accepted += is_accepted;
    alike += closure.reason == elsewhere;
  }
  if (accepted == 0 || kMinLookAlikes * static_cast<double>(compared) > static_cast<double>(alike))
    return std::nullopt;
  return "places look alike here: the scans of " + std::to_string(alike) + " of " + std::to_string(compared) +
         " compared places of two robots fit elsewhere, too, and nothing but scans ties the robots to each "
         "other; their common frame may be that of look-alikes, whatever its sigma says, and has a weight of "
         "at most one half: add radio links, known starts or position fixes";
}

std::optional<std::string> range_bias_note(const std::vector<RangeBiasResult>& biases) {
  const auto size = [](const RangeBiasResult& bias) { return std::abs(bias.bias_m); };
  const auto largest = std::max_element(biases.begin(), biases.end(),
                                        [&](const auto& a, const auto& b) { return size(a) < size(b); });
  if (largest == biases.end()) return std::nullopt;
  std::ostringstream note;
  note << std::fixed << std::setprecision(2)
       << "ranges have constant errors, which the estimate corrects: those between " << largest->end_i
       << " and " << largest->end_j << " are " << size(*largest) << " m too "
       << (largest->bias_m > 0 ? "long" : "short") << " (range_biases in summary.json)";
  return note.str();
}

}  // namespace radioslam
