// Whether ground truth fits the odometry, on its clock, in metres, not as its mirror image and not as that of
// another robot; and whether stated starts and ranges fit the truth.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/check_mission.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/starts.hpp"
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
/// Of a pair of starts against the truth.
constexpr double kSigmaStart_m = 1.3, kSigmaStart_rad = 0.1;
constexpr std::size_t kMinRanges = 10;
constexpr double kMinBias_m = 0.3;                        // that four fifths of the ranges exceed
constexpr double kMaxSpreadSigmas = 3, kMaxSpread = 0.3;  // of the middle half, of the bias

const char* unit_of(double factor) {
  for (const auto& [name, per_metre] :
       {std::pair{"millimetres", 1000.}, {"centimetres", 100.}, {"feet", 3.281}, {"kilometres", 1e-3}})
    if (std::abs(std::log(factor / per_metre)) < 0.1) return name;
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
    for (const auto& [name, per_second] :
         {std::pair{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}})
      if (first_s / per_second < end_s && last_s / per_second > begin_s &&
          (last_s - first_s) / per_second > 0.1 * (end_s - begin_s))
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
    // Carrying the odometry onto the truth keeps its extent.
    const double path_m = path_of_truth_m();
    if (!(path_m > 0) || !(path_within_m_ > 0)) return;
    const double factor = path_m / path_within_m_;
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

  /// Between the truth's rows; sets the odometry's path between the same times.
  double path_of_truth_m() {
    double path_m = 0;
    const StampedPose<SE3>* last = nullptr;
    std::optional<Track::Row> last_row;
    path_within_m_ = 0;
    for (const auto& row : truth_.poses) {
      const auto at = tracks_[r_].at(row.stamp.seconds());
      if (!at) continue;
      // Small steps are noise.
      if (last && at->path_m - last_row->path_m < 1) continue;
      if (last) {
        path_m += (row.pose.translation() - last->pose.translation()).norm();
        path_within_m_ += (at->position_m - last_row->position_m).norm();
      }
      last = &row;
      last_row = at;
    }
    return path_m;
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
  double path_within_m_ = 0;
};

/// Known starts of robots whose truth fits, against its relative poses.
void check_starts(const Mission& mission, const std::vector<std::optional<SE3>>& T_truth_start,
                  std::vector<Finding>& findings) {
  std::vector<PairOfStarts> pairs;
  for (std::size_t j = 1; j < mission.robots.size(); ++j)
    for (std::size_t i = 0; i < j; ++i) {
      const auto &a = mission.robots[i].initial_pose, &b = mission.robots[j].initial_pose;
      if (!a || !b || !T_truth_start[i] || !T_truth_start[j]) continue;
      const SE3 stated = a->inverse() * *b, found = T_truth_start[i]->inverse() * *T_truth_start[j];
      const StartError error{stated.inverse() * found, kSigmaStart_m, kSigmaStart_rad};
      pairs.push_back({i, j, error.is_far() ? std::optional(error) : std::nullopt});
    }
  for (Finding& finding : start_findings(mission, pairs, "the ground truth"))
    findings.push_back(std::move(finding));
}

struct Residuals {
  std::vector<double> m;
  double sigma_m = 0;
};

double quantile(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// Ranges between robots that mostly differ from the true distances by the same.
void check_ranges(const Mission& mission, const Truth& truth,
                  const std::vector<std::optional<SE3>>& T_truth_start, std::vector<Finding>& findings) {
  std::map<std::pair<std::size_t, std::size_t>, Residuals> of_pair;
  const auto place = [&](const LinkEnd& end, Stamp stamp) -> std::optional<Eigen::Vector3d> {
    if (!end.robot.valid() || !T_truth_start[end.robot.index()]) return std::nullopt;
    const RobotTruth& robot = truth.robots[end.robot.index()];
    const auto pose = robot.poses.at(stamp);
    if (!pose || (!robot.has_orientation && !end.lever_arm_m.isZero())) return std::nullopt;
    return *pose * end.lever_arm_m;
  };
  for (const RangeMeasurement& range : mission.ranges) {
    const auto a = place(range.i, range.stamp), b = place(range.j, range.stamp);
    if (!a || !b) continue;
    Residuals& residuals = of_pair[std::minmax(range.i.robot.index(), range.j.robot.index())];
    residuals.m.push_back(range.range_m - (*b - *a).norm());
    residuals.sigma_m = std::max(residuals.sigma_m, range.sigma_m);
  }
  for (auto& [pair, residuals] : of_pair) {
    if (residuals.m.size() < kMinRanges) continue;
    std::sort(residuals.m.begin(), residuals.m.end());
    const double middle = quantile(residuals.m, 0.5);
    const bool is_long = quantile(residuals.m, 0.2) > kMinBias_m,
               is_short = quantile(residuals.m, 0.8) < -kMinBias_m;
    const double spread = quantile(residuals.m, 0.75) - quantile(residuals.m, 0.25);
    if ((!is_long && !is_short) ||
        spread > std::max(kMaxSpreadSigmas * residuals.sigma_m, kMaxSpread * std::abs(middle)))
      continue;
    findings.push_back({"bias", Severity::kWarning, "", kRangesFile,
                        "distances between " + mission.robots[pair.first].id + " and " +
                            mission.robots[pair.second].id + " are about " + number(std::abs(middle)) +
                            " m too " + (is_long ? "long" : "short") + " by the ground truth",
                        "unbiased distances", "subtract the antenna delay, about " + number(middle) + " m"});
  }
}

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
  check_starts(mission, T_truth_start, findings);
  check_ranges(mission, truth, T_truth_start, findings);
  return findings;
}

}  // namespace radioslam
