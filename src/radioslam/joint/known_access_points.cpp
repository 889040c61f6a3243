#include "radioslam/joint/known_access_points.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace radioslam {
namespace {

constexpr double kGate_sigma = 3, kLeastDisplacement_m = 10;
constexpr double kTenths = 10;

std::string list_of(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string metres(double value_m) {
  const auto tenths = std::lround(kTenths * value_m);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " m";
}

bool has_any(const AccessPointFixes& fixes) {
  return std::any_of(fixes.robots.begin(), fixes.robots.end(),
                     [](const std::vector<PositionFix>& of) { return !of.empty(); });
}

std::string used_note(const Mission& mission, const AccessPointFixes& fixes) {
  std::vector<std::string> robots;
  double least_m = 0, most_m = 0;
  std::size_t count = 0;
  for (std::size_t r = 0; r < fixes.robots.size(); ++r)
    for (const PositionFix& fix : fixes.robots[r]) {
      if (robots.empty() || robots.back() != mission.robots[r].id) robots.push_back(mission.robots[r].id);
      least_m = count == 0 ? fix.sigma_m : std::min(least_m, fix.sigma_m);
      most_m = std::max(most_m, fix.sigma_m);
      ++count;
    }
  return std::to_string(fixes.known.size()) + " access points at the positions of radio/anchors.csv give " +
         std::to_string(count) + " position fixes of " + list_of(robots) + ", with standard deviations of " +
         metres(least_m) + " to " + metres(most_m) + ", from signal strengths";
}

std::string unused_note(const Mission& mission, const AccessPointFixes& fixes,
                        const AccessPointFixParams& params) {
  const std::string begin = "the known positions of " + std::to_string(fixes.known.size()) +
                            " access points (radio/anchors.csv) are not used: ";
  if (!params.use_known) return begin + "access_points.use_known is false";
  if (mission.dimension != 2) return begin + "their signal strengths give positions in the plane only";
  return begin + "no fingerprint determines a position by at least " + std::to_string(params.known_at_once) +
         " of them within " + metres(params.known_max_sigma_m);
}

/// "02:.. by 45.0 m" for access points that are estimated elsewhere.
std::vector<std::string> displaced(const RunResult& result, const Mission& mission,
                                   const AccessPointFixes& fixes) {
  std::vector<std::string> found;
  for (const KnownAccessPoint& known : fixes.known) {
    const std::string& bssid = mission.access_points[known.access_point.index()];
    for (const AccessPointResult& estimated : result.access_points) {
      if (estimated.bssid != bssid || estimated.status != AccessPointStatus::kFound) continue;
      const double distance_m = (estimated.position_m - known.position_m).norm();
      const double variance =
          estimated.covariance.topLeftCorner<2, 2>().trace() + known.sigma_m * known.sigma_m;
      if (distance_m > kLeastDisplacement_m && distance_m > kGate_sigma * std::sqrt(variance))
        found.push_back(bssid + " by " + metres(distance_m));
    }
  }
  return found;
}

/// Whether a robot of the first component was placed by fixes or has a known start.
bool is_in_common_frame(const RunResult& result, const Mission& mission) {
  if (result.components.empty()) return false;
  const auto& first = result.components.front().robots;
  for (std::size_t r = 0; r < mission.robots.size() && r < result.robots.size(); ++r) {
    const bool is_first = std::find(first.begin(), first.end(), mission.robots[r].id) != first.end();
    const auto& fixes = result.robots[r].fixes;
    if (is_first && (mission.robots[r].initial_pose || (fixes && fixes->place))) return true;
  }
  return false;
}

}  // namespace

KnownAccessPoints use_known_access_points(const Mission& mission, const RadioMeasurements& radio,
                                          const AccessPointStageParams& params) {
  KnownAccessPoints known{fixes_by_access_points(mission, radio.robots, params.known, params.fit),
                          std::nullopt};
  if (!has_any(known.fixes)) return known;
  known.mission = mission;
  for (std::size_t r = 0; r < mission.robots.size(); ++r)
    if (mission.robots[r].fixes.empty()) known.mission->robots[r].fixes = known.fixes.robots[r];
  return known;
}

void add_known_access_points(RunResult& result, const Mission& mission, const AccessPointFixes& fixes,
                             const AccessPointFixParams& params) {
  if (fixes.known.empty()) return;
  result.counts["access_points_known"] = static_cast<double>(fixes.known.size());
  result.notes.push_back(has_any(fixes) ? used_note(mission, fixes) : unused_note(mission, fixes, params));
  if (!is_in_common_frame(result, mission)) return;
  const auto elsewhere = displaced(result, mission, fixes);
  if (!elsewhere.empty())
    result.notes.push_back("access points are estimated elsewhere than radio/anchors.csv has them: " +
                           list_of(elsewhere));
}

}  // namespace radioslam
