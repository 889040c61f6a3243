#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/corrections.hpp"
#include "radioslam/doctor/link_fit.hpp"
#include "radioslam/doctor/starts.hpp"
#include "radioslam/doctor/team_links.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kWindowsOfPair = 3;
constexpr std::size_t kMinWindows = 12;  // or three per robot
constexpr double kGoodRatio = 0.8;       // of direct links, in a window that needs no correction
constexpr int kMaxCorrections = 3;
/// Gain in log evidence that a correction must bring: at all, and per link that it concerns.
constexpr double kMinGain = 30;
constexpr double kMinGainPerLink = 0.15;
constexpr double kMinGainOfOthers = 12;    // than the window that gains most
constexpr double kWindowGain = 3;          // by which a window is for or against a correction
constexpr double kMinExplainedMore = 0.1;  // of the links it concerns
constexpr double kMinExplainedByNoise = 0.88;
constexpr double kMinExplained = 0.1;  // of all links, in a mission without a finding
constexpr double kClockOffsets_s[] = {0.5, 1,  1.5, 2,  3,  4,  5,  6,  8,  10,
                                      12,  15, 18,  21, 25, 30, 35, 40, 50, 60};
/// Of stated starts, and of dead reckoning up to the window, beyond its stated noise.
constexpr double kSigmaStart_m = 0.5, kSigmaStart_rad = 0.05;
constexpr double kDriftRatio = 0.01, kDriftPerMetre_rad = 0.0005;
constexpr double kMinGainOfStart = 12;
constexpr double kMinDirectOfOneWindow = 0.7;
/// Robots whose own corrections are tried: of a large team those whose links fit worst.
constexpr std::size_t kSuspects = 6;

struct FittedWindow {
  LinkWindow window;
  LinkFit fit;
};

/// What a correction brings in the windows that it concerns.
struct Gain {
  double log_evidence = 0;
  double before = 0, after = 0;  // links explained
  double links = 0;
  double min_explained = 0, min_explained_after = 0;  // further links and all that it must explain, of all
  double most = 0;                                    // log evidence gained in one window
  int windows = 0, gained = 0, lost = 0;

  /// Enough, and not in one window alone, where dead reckoning may have slipped.
  bool is_significant() const {
    const bool is_enough = log_evidence > std::max(kMinGain, kMinGainPerLink * links) &&
                           after > std::max(before + min_explained * links, min_explained_after * links);
    const bool is_common =
        gained >= std::min(2, windows) && (windows < 2 || log_evidence - most > kMinGainOfOthers);
    return is_enough && is_common && gained > 4 * lost;
  }
};

/// Whether links fit at all only after the correction; a constant error bends the trajectories before.
bool explains_links(const Correction& correction) {
  const Finding& finding = correction.finding;
  return finding.kind != "height" && !(finding.kind == "bias" && finding.file == kRangesFile);
}

/// Windows that the correction concerns, those first in which it should gain most: with the least evidence
/// per link, or with the longest paths.
std::vector<const FittedWindow*> concerned(const Correction& correction,
                                           const std::vector<FittedWindow>& windows) {
  std::vector<const FittedWindow*> result;
  for (const FittedWindow& window : windows)
    if (correction.concerns(window.window.i, window.window.j)) result.push_back(&window);
  const auto order = [&](const FittedWindow* w) {
    return explains_links(correction) ? w->fit.log_evidence / static_cast<double>(w->fit.links)
                                      : -w->window.path_m;
  };
  std::stable_sort(result.begin(), result.end(), [&](auto* x, auto* y) { return order(x) < order(y); });
  return result;
}

/// The robots of whose links the fewest are explained, by windows.
std::set<std::string> suspects(const Mission& mission, const std::vector<FittedWindow>& windows) {
  std::vector<std::pair<double, std::size_t>> by_explained;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    double explained = 0, links = 0;
    for (const auto& [window, fit] : windows) {
      if (window.i != r && window.j != r) continue;
      explained += fit.explained;
      links += static_cast<double>(fit.links);
    }
    if (links > 0) by_explained.emplace_back(explained / links, r);
  }
  std::sort(by_explained.begin(), by_explained.end());
  std::set<std::string> ids;
  for (std::size_t k = 0; k < std::min(kSuspects, by_explained.size()); ++k)
    ids.insert(mission.robots[by_explained[k].second].id);
  return ids;
}

/// Whether the correction of one robot has nothing to correct. Heights bend all ranges a little.
bool is_needless(const Correction& correction, const std::set<std::string>& suspected,
                 const std::vector<FittedWindow>& windows) {
  if (correction.finding.robot.empty()) return false;
  if (!suspected.contains(correction.finding.robot)) return true;
  if (correction.finding.kind == "height") return false;
  return std::all_of(windows.begin(), windows.end(), [&](const FittedWindow& w) {
    return w.fit.explained >= kGoodRatio * static_cast<double>(w.fit.links) ||
           !correction.concerns(w.window.i, w.window.j);
  });
}

Gain gain_of(const Correction& correction, const TeamLinks& team, const std::vector<FittedWindow>& windows) {
  TeamLinks corrected = team;
  correction.apply(corrected);
  Gain gain;
  gain.min_explained = explains_links(correction) ? kMinExplainedMore : 0;
  // Wide enough, any noise explains detours.
  if (correction.finding.kind == "noise") gain.min_explained_after = kMinExplainedByNoise;
  std::size_t tried = 0;
  for (const FittedWindow* known : concerned(correction, windows)) {
    if (tried == 1 && gain.log_evidence < 0) break;
    if (tried == 2 && gain.log_evidence < kWindowGain) break;
    ++tried;
    const auto& [window, fit] = *known;
    const LinkFit other = fit_links(corrected, window);
    const double difference = other.log_evidence - fit.log_evidence;
    const double links = static_cast<double>(fit.links);
    gain.log_evidence += difference;
    gain.most = std::max(gain.most, difference);
    ++gain.windows;
    gain.gained += difference > kWindowGain;
    gain.lost += difference < -kWindowGain;
    gain.links += links;
    gain.before += fit.explained;
    gain.after += other.explained;
  }
  return gain;
}

std::vector<FittedWindow> fitted(const TeamLinks& team, const std::vector<LinkWindow>& windows) {
  std::vector<FittedWindow> result(windows.size());
  parallel_for(windows.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) result[k] = {windows[k], fit_links(team, windows[k])};
  });
  return result;
}

struct Chosen {
  Correction correction;
  Gain gain;
};

/// Keeps the better of the two; what is equally good stays with the first.
void keep_best(std::optional<Chosen>& best, const std::vector<Correction>& corrections, const TeamLinks& team,
               const std::set<std::string>& suspected, const std::vector<FittedWindow>& windows) {
  std::vector<Gain> gains(corrections.size());
  parallel_for(corrections.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (!is_needless(corrections[k], suspected, windows)) gains[k] = gain_of(corrections[k], team, windows);
  });
  for (std::size_t k = 0; k < corrections.size(); ++k)
    if (gains[k].is_significant() && (!best || gains[k].log_evidence > 1.02 * best->gain.log_evidence + 2))
      best = Chosen{corrections[k], gains[k]};
}

/// Offsets of clocks between half a second and a minute, refined to a tenth of a second.
void try_clocks(std::optional<Chosen>& best, const Mission& mission, const TeamLinks& team,
                const std::set<std::string>& suspected, const std::vector<FittedWindow>& windows) {
  std::optional<std::pair<Chosen, double>> clock;
  const auto try_offset = [&](double seconds) {
    std::optional<Chosen> found;
    keep_best(found, clock_corrections(mission, team, seconds), team, suspected, windows);
    if (found && (!clock || found->gain.log_evidence > clock->first.gain.log_evidence))
      clock.emplace(*found, seconds);
  };
  for (const double magnitude : kClockOffsets_s)
    for (const double sign : {1., -1.}) try_offset(sign * magnitude);
  if (!clock) return;
  for (const double step : {2., 1., 0.5, 0.2, 0.1}) {
    const double middle = clock->second;
    try_offset(middle - step);
    try_offset(middle + step);
  }
  if (!best || clock->first.gain.log_evidence > 1.1 * best->gain.log_evidence + 6) best = clock->first;
}

std::optional<Chosen> best_correction(const Mission& mission, const TeamLinks& team,
                                      const std::vector<FittedWindow>& windows) {
  const auto suspected = suspects(mission, windows);
  std::optional<Chosen> best;
  keep_best(best, discrete_corrections(mission, team), team, suspected, windows);
  try_clocks(best, mission, team, suspected, windows);
  // Constant errors bend to almost any contradiction a little: they come last.
  std::optional<Chosen> offset;
  keep_best(offset, offset_corrections(mission, team), team, suspected, windows);
  if (offset && (!best || offset->gain.log_evidence > 1.3 * best->gain.log_evidence + 6)) best = offset;
  return best;
}

double explained_ratio(const std::vector<FittedWindow>& windows) {
  double explained = 0, links = 0;
  for (const auto& [window, fit] : windows) {
    explained += fit.explained;
    links += static_cast<double>(fit.links);
  }
  return links > 0 ? explained / links : 1;
}

/// Corrects one fault after the other; `team` is corrected with them.
std::vector<Finding> corrected_faults(const Mission& mission, TeamLinks& team,
                                      std::vector<FittedWindow>& windows) {
  std::vector<Finding> findings;
  for (int k = 0; k < kMaxCorrections && !windows.empty(); ++k) {
    const auto best = best_correction(mission, team, windows);
    if (!best) break;
    Finding finding = best->correction.finding;
    finding.found += " (" + number(100 * best->gain.after / best->gain.links) + " % of the links fit then, " +
                     number(100 * best->gain.before / best->gain.links) + " % as recorded)";
    findings.push_back(std::move(finding));
    best->correction.apply(team);
    std::vector<LinkWindow> same;
    for (auto& window : windows) same.push_back(std::move(window.window));
    windows = fitted(team, same);
  }
  return findings;
}

/// T_i_j that two stated starts give; the world's is the common frame.
std::optional<SE3> stated_alignment(const Mission& mission, const TeamLinks& team, std::size_t i,
                                    std::size_t j) {
  const auto start = [&](std::size_t node) -> std::optional<SE3> {
    if (node < mission.robots.size()) return mission.robots[node].initial_pose;
    return SE3(team.world_origin_m, Eigen::Quaterniond::Identity());
  };
  const auto a = start(i), b = start(j);
  if (!a || !b) return std::nullopt;
  return a->inverse() * *b;
}

/// Path of the window's robots up to its end, in which their dead reckoning may drift.
double path_to_end_m(const TeamLinks& team, const LinkWindow& window) {
  double path_m = window.path_m;
  for (const std::size_t node : {window.i, window.j})
    if (node < team.tracks.size())
      if (const auto row = team.tracks[node].at(team.links[window.links.front()].t_s)) path_m += row->path_m;
  return path_m;
}

/// Where the links of a window put the starts, if those stated are much less likely.
std::optional<StartError> contradiction(const TeamLinks& team, const FittedWindow& fitted,
                                        const SE3& stated) {
  const double path_m = path_to_end_m(team, fitted.window);
  const StatedAlignment near{stated, kSigmaStart_m + kDriftRatio * path_m,
                             kSigmaStart_rad + kDriftPerMetre_rad * path_m};
  const LinkFit at_stated = fit_links_near(team, fitted.window, near);
  if (fitted.fit.log_evidence - at_stated.log_evidence < kMinGainOfStart) return std::nullopt;
  return StartError{stated.inverse() * fitted.fit.T_i_j, near.sigma_m, near.sigma_rad};
}

/// That of all windows of a pair: each contradicts the starts, and by the same error, since detours round
/// different corners do not agree. Where there is one window, most of its links must be direct.
std::optional<StartError> common_contradiction(const TeamLinks& team,
                                               const std::vector<const FittedWindow*>& of_pair,
                                               const SE3& stated) {
  std::optional<StartError> common;
  for (const FittedWindow* fitted : of_pair) {
    const auto found = contradiction(team, *fitted, stated);
    if (!found || (common && !common->agrees_with(*found))) return std::nullopt;
    if (!common || found->sigma_m < common->sigma_m) common = found;
  }
  if (!common->is_far()) return std::nullopt;
  const LinkFit& first = of_pair.front()->fit;
  const bool is_alone = of_pair.size() == 1;
  if (is_alone && first.explained < kMinDirectOfOneWindow * static_cast<double>(first.links))
    return std::nullopt;
  return common;
}

std::vector<Finding> check_starts(const Mission& mission, const TeamLinks& team,
                                  const std::vector<FittedWindow>& windows) {
  std::map<std::pair<std::size_t, std::size_t>, std::vector<const FittedWindow*>> windows_of;
  for (const FittedWindow& fitted : windows)
    windows_of[{fitted.window.i, fitted.window.j}].push_back(&fitted);
  std::vector<PairOfStarts> pairs;
  for (const auto& [nodes, of_pair] : windows_of)
    if (const auto stated = stated_alignment(mission, team, nodes.first, nodes.second))
      pairs.push_back({nodes.first, nodes.second, common_contradiction(team, of_pair, *stated)});
  return start_findings(mission, pairs, "the radio links");
}

std::vector<LinkWindow> windows_to_check(const TeamLinks& team) {
  std::vector<LinkWindow> windows = link_windows(team, kWindowsOfPair);
  std::vector<LinkWindow> kept;
  const std::size_t count = std::min(windows.size(), std::max(kMinWindows, 3 * team.tracks.size()));
  for (std::size_t k = 0; k < count; ++k) kept.push_back(std::move(windows[k * windows.size() / count]));
  return kept;
}

}  // namespace

std::vector<Finding> check_links(const Mission& mission) {
  TeamLinks team = team_links(mission);
  std::vector<LinkWindow> chosen = windows_to_check(team);
  keep_links_of(chosen, team);
  std::vector<FittedWindow> windows = fitted(team, chosen);
  std::vector<Finding> findings = corrected_faults(mission, team, windows);
  for (Finding& start : check_starts(mission, team, windows)) findings.push_back(std::move(start));
  const double explained = explained_ratio(windows);
  if (findings.empty() && explained < kMinExplained)
    findings.push_back({"frame", Severity::kWarning, "", "",
                        "the radio links do not fit the trajectories (" + number(100 * explained) + " % do)",
                        "most links to agree with the odometry of their robots",
                        "check units, clocks and frames"});
  return findings;
}

}  // namespace radioslam
