#include "radioslam/doctor/check_mission.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/odometry_noise.hpp"

namespace radioslam {
namespace {

void append(std::vector<Finding>& all, std::vector<Finding> found) {
  for (Finding& finding : found) all.push_back(std::move(finding));
}

bool has_error(const std::vector<Finding>& findings) {
  return std::any_of(findings.begin(), findings.end(),
                     [](const Finding& finding) { return finding.severity == Severity::kError; });
}

}  // namespace

std::vector<Finding> check_mission(const Mission& mission) {
  std::vector<Finding> findings = mission.reading_findings;
  append(findings, check_odometry(mission));
  append(findings, check_odometry_coverage(mission));
  append(findings, check_odometry_noise(mission));
  append(findings, check_frozen_odometry(mission));
  append(findings, check_times(mission));
  append(findings, check_wifi(mission));
  append(findings, check_inertial(mission));
  append(findings, check_scans(mission));
  append(findings, check_connections(mission));
  append(findings, check_matches(mission));
  // With wrong units or clocks, links contradict the odometry without saying anything new.
  if (!has_error(findings)) {
    append(findings, check_links(mission));
    append(findings, check_fingerprint_starts(mission));
  }
  std::stable_sort(findings.begin(), findings.end(),
                   [](const Finding& a, const Finding& b) { return a.severity < b.severity; });
  return findings;
}

}  // namespace radioslam
