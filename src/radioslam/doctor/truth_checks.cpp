// Whether ground truth fits the odometry, on its clock, in metres, not as its mirror image and not as that of
// another robot.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/doctor/check_mission.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"
#include "radioslam/doctor/truth_fit.hpp"

namespace radioslam {
namespace {

constexpr double kMaxRatio = 0.4;   // of a corrected fit's RMSE to that as recorded
constexpr double kMinMisfit = 0.1;  // of the truth's extent, before a mirror image or another robot counts
constexpr double kMinMisfitOfClock = 0.025;  // turns alone show a clock
constexpr double kMinGain_m = 0.1;
constexpr double kMaxMisfit = 0.35;  // of the truth's extent
constexpr double kMinPlaces = 20;
constexpr double kMinFactor = 1.07, kMinFactorOfSparse = 2;
constexpr double kMinInside = 0.05;  // of the truth's rows, within the odometry's times
constexpr std::array kShifts_s = {0.5, 1.,  1.5, 2.,  3.,  4.,  5.,  6.,  8.,
                                  10., 12., 15., 20., 25., 30., 40., 50., 60.};
const char* unit_of(double factor) {
  for (const auto& [name, metres] : kLengthUnits)
    if (std::abs(std::log(factor * metres)) < 0.1) return name;
  return nullptr;
}

struct Explanation {
  double relative = 0;  ///< of the fit that it leads to
  const char* kind = "";
  std::string found, expected, advice;
};

Finding finding_on(const Robot& robot, const char* kind, std::string found, std::string expected,
                   std::string advice) {
  return {kind,
          Severity::kWarning,
          robot.id,
          robot_file(robot.id, "groundtruth.tum"),
          std::move(found),
          std::move(expected),
          std::move(advice)};
}

/// Times on another clock, or in another unit.
std::optional<Finding> check_times(const Robot& robot, const RobotTruth& truth) {
  const double begin_s = robot.odometry.front().stamp.seconds(),
               end_s = robot.odometry.back().stamp.seconds();
  const double first_s = truth.poses.front().stamp.seconds(), last_s = truth.poses.back().stamp.seconds();
  const auto inside = std::count_if(truth.poses.begin(), truth.poses.end(), [&](const auto& row) {
    return row.stamp.seconds() >= begin_s && row.stamp.seconds() <= end_s;
  });
  const std::string times = "times from " + time_text(first_s) + " to " + time_text(last_s);
  const std::string clock =
      "the clock of the odometry, " + time_text(begin_s) + " to " + time_text(end_s) + " s";
  if (static_cast<double>(inside) < kMinInside * static_cast<double>(truth.poses.size()))
    for (const auto& [name, seconds] : kTimeUnits)
      if (first_s * seconds < end_s && last_s * seconds > begin_s &&
          (last_s - first_s) * seconds > 0.1 * (end_s - begin_s))
        return finding_on(robot, "unit", times + ", which look like " + name, clock,
                          "convert the times to seconds");
  if (first_s <= end_s && last_s >= begin_s) return std::nullopt;
  return finding_on(robot, "clock", times + " s", clock,
                    "no error can be evaluated until both are on one clock");
}

class RobotTruthCheck {
 public:
  RobotTruthCheck(const Mission& mission, const std::vector<Track>& tracks, std::size_t r,
                  const RobotTruth& truth)
      : mission_(mission), tracks_(tracks), r_(r), truth_(truth) {}

  std::optional<Finding> run() {
    if (auto finding = check_times(robot(), truth_)) return finding;
    recorded_ = fit({});
    if (recorded_.places == 0) return std::nullopt;
    if (auto finding = frozen_against(robot(), truth_)) return finding;
    return explanation();
  }

 private:
  const Robot& robot() const { return mission_.robots[r_]; }
  TruthFit fit(const TruthCorrection& correction) const {
    return fit_truth(tracks_[r_], truth_, mission_.dimension, correction);
  }

  std::optional<Finding> explanation() {
    std::vector<Explanation> all;
    add_mirrored(all);
    add_scaled(all);
    add_shifted(all);
    add_other(all);
    const auto best = std::min_element(all.begin(), all.end(),
                                       [](const auto& a, const auto& b) { return a.relative < b.relative; });
    if (best != all.end()) return finding_on(robot(), best->kind, best->found, best->expected, best->advice);
    if (is_sparse() || recorded_.relative() <= kMaxMisfit) return std::nullopt;
    return finding_on(robot(), "frame",
                      "the ground truth does not fit the odometry (" + misfit(recorded_) +
                          " in stretches of " + number(kTruthStretch_m) + " m)",
                      "the path of the same robot", "check whose truth it is, its clock and its unit");
  }

  /// A few waypoints: too little against dead reckoning of any quality.
  bool is_sparse() const { return recorded_.places < kMinPlaces; }

  static std::string misfit(const TruthFit& fit) { return number(fit.rmse_m()) + " m rmse"; }

  /// Straight stretches are their own mirror images.
  void add_mirrored(std::vector<Explanation>& all) {
    const TruthFit mirrored = fit({0, 1, true});
    if (recorded_.relative() <= kMinMisfit || mirrored.relative() >= kMaxRatio * recorded_.relative()) return;
    all.push_back({mirrored.relative(), "handedness",
                   "the ground truth fits the odometry only as a mirror image (" + misfit(mirrored) +
                       " over " + number(kTruthStretch_m) + " m, " + number(recorded_.rmse_m()) +
                       " m without reflection)",
                   "both in right-handed frames, y to the left of x",
                   "change the sign of y, or exchange x and y, of one"});
  }

  void add_scaled(std::vector<Explanation>& all) {
    const auto [of_truth_m, of_odometry_m] = paths_m();
    if (!(of_truth_m > 0) || !(of_odometry_m > 0)) return;
    const double factor = of_truth_m / of_odometry_m;
    const double least = is_sparse() ? kMinFactorOfSparse : kMinFactor;
    if (std::abs(std::log(factor)) < std::log(least)) return;
    const TruthFit scaled = fit({0, 1 / factor, false});
    if (scaled.relative() >= kMaxRatio * recorded_.relative()) return;
    const char* unit = unit_of(factor);
    all.push_back(
        {scaled.relative(), unit ? "unit" : "scale",
         "the ground truth's path is " + number(factor) + " times as long as the odometry's" +
             (unit ? std::string(", as if in ") + unit : ""),
         "metres in both",
         "multiply the positions of the truth by " + number(1 / factor) + ", or check the odometry's scale"});
  }

  /// Of the truth and of the odometry between the same times, in steps of a metre: smaller ones are noise.
  std::pair<double, double> paths_m() const {
    std::pair<double, double> paths_m{0, 0};
    const StampedPose<SE3>* last = nullptr;
    std::optional<Track::Row> last_row;
    for (const auto& row : truth_.poses) {
      const auto at = tracks_[r_].at(row.stamp.seconds());
      if (!at || (last && at->path_m - last_row->path_m < 1)) continue;
      if (last) {
        paths_m.first += (row.pose.translation() - last->pose.translation()).norm();
        paths_m.second += (at->position_m - last_row->position_m).norm();
      }
      last = &row;
      last_row = at;
    }
    return paths_m;
  }

  void add_shifted(std::vector<Explanation>& all) {
    if (is_sparse() || recorded_.relative() < kMinMisfitOfClock) return;
    std::pair<double, TruthFit> best{0, recorded_};
    const auto attempt = [&](double shift_s) {
      const TruthFit shifted = fit({shift_s, 1, false});
      if (shifted.places > 0.5 * recorded_.places && shifted.relative() < best.second.relative())
        best = {shift_s, shifted};
    };
    for (const double shift_s : kShifts_s)
      for (const double sign : {1., -1.}) attempt(sign * shift_s);
    for (const double step_s : {2., 1., 0.5, 0.2, 0.1}) {
      const double middle_s = best.first;
      attempt(middle_s - step_s);
      attempt(middle_s + step_s);
    }
    const auto& [shift_s, shifted] = best;
    if (std::abs(shift_s) < 0.4 || shifted.relative() >= kMaxRatio * recorded_.relative() ||
        recorded_.rmse_m() - shifted.rmse_m() < kMinGain_m)
      return;
    all.push_back({shifted.relative(), "clock",
                   "the ground truth's times are " + number(std::abs(shift_s)) + " s " +
                       (shift_s < 0 ? "late" : "early") + " (" + misfit(shifted) + " then, " +
                       number(recorded_.rmse_m()) + " m as recorded)",
                   "the clock of the odometry",
                   (shift_s < 0 ? "subtract " : "add ") + number(std::abs(shift_s)) + " s"});
  }

  void add_other(std::vector<Explanation>& all) {
    if (is_sparse() || recorded_.relative() <= kMinMisfit) return;
    for (std::size_t s = 0; s < tracks_.size(); ++s) {
      if (s == r_ || tracks_[s].empty()) continue;
      const TruthFit other = fit_truth(tracks_[s], truth_, mission_.dimension);
      if (other.places == 0 || other.relative() > kMinMisfit ||
          other.relative() >= kMaxRatio * recorded_.relative())
        continue;
      all.push_back({other.relative(), "robot",
                     "the ground truth fits the odometry of robot '" + mission_.robots[s].id + "' (" +
                         misfit(other) + "), not that of its own (" + number(recorded_.rmse_m()) + " m)",
                     "the path of the same robot", "exchange the files"});
    }
  }

  const Mission& mission_;
  const std::vector<Track>& tracks_;
  std::size_t r_;
  const RobotTruth& truth_;
  TruthFit recorded_;
};

}  // namespace

std::vector<Finding> check_truth(const Mission& mission, const Truth& truth) {
  std::vector<Finding> findings;
  std::vector<Track> tracks;
  for (const Robot& robot : mission.robots) tracks.emplace_back(robot);
  std::vector<std::optional<SE3>> T_truth_start(mission.robots.size());
  for (std::size_t r = 0; r < std::min(mission.robots.size(), truth.robots.size()); ++r) {
    if (tracks[r].empty() || truth.robots[r].poses.empty()) continue;
    if (auto finding = RobotTruthCheck(mission, tracks, r, truth.robots[r]).run())
      findings.push_back(std::move(*finding));
    else
      T_truth_start[r] = start_in_truth(tracks[r], truth.robots[r]);
  }
  check_by_truth(mission, truth, T_truth_start, findings);
  return findings;
}

}  // namespace radioslam
