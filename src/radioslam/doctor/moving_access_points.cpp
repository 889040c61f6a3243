#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/correlation.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr double kNear_dbm = -65;  // of a radio carried along
constexpr double kMaxCarriedSigma_db = 6;
constexpr double kMinCarriedExtent_m = 60;  // over which a fixed radio's strength varies by more
constexpr std::size_t kMinStrengths = 40;
constexpr double kMinVariance_db2 = 16;
constexpr int kGrid = 20;
constexpr double kUsuallyExplained = 0.6, kRarelyExplained = 0.42;  // of the variance of strengths

/// Of strengths at one place: those at about one time, and those at times between which a radio may have
/// moved.
constexpr double kSamePlace_m = 5, kSameTime_s = 20, kOtherTime_s = 60;
constexpr std::size_t kMinReturns = 20;
constexpr double kMinChange_db = 6, kMinChangeRatio = 2;

struct Strength {
  double t_s;
  Eigen::Vector2d position_m;
  double rssi_dbm;
};

/// Whether strengths at one place change with time. Walls and shadowing, which no distance law explains, do
/// not.
bool change_at_places(const std::vector<Strength>& strengths) {
  std::vector<double> soon, later;
  for (std::size_t a = 0; a < strengths.size(); ++a)
    for (std::size_t b = a + 1; b < strengths.size(); ++b) {
      const double gap_s = std::abs(strengths[a].t_s - strengths[b].t_s);
      if (gap_s > kSameTime_s && gap_s < kOtherTime_s) continue;
      if ((strengths[a].position_m - strengths[b].position_m).norm() > kSamePlace_m) continue;
      (gap_s > kSameTime_s ? later : soon).push_back(std::abs(strengths[a].rssi_dbm - strengths[b].rssi_dbm));
    }
  if (later.size() < kMinReturns) return false;
  const double noise_db = soon.size() < kMinReturns ? 0 : upper_median(std::move(soon));
  return upper_median(std::move(later)) > std::max(kMinChange_db, kMinChangeRatio * noise_db);
}

/// Share of the variance that a line over the logarithm of the distance to `place` explains; falling ones
/// only.
double explained_from(const std::vector<Strength>& strengths, const Eigen::Vector2d& place) {
  CorrelationSums sums;
  for (const Strength& s : strengths) sums.add(std::log10(2 + (s.position_m - place).norm()), s.rssi_dbm);
  const double vx = sums.spread_x(), vy = sums.spread_y(), vxy = sums.spread_xy();
  return vx > 0 && vy > 0 && vxy < 0 ? vxy * vxy / (vx * vy) : 0;
}

/// At most about 400 of them, evenly.
std::vector<Strength> thinned(const std::vector<Strength>& strengths) {
  const std::size_t stride = strengths.size() / 400 + 1;
  std::vector<Strength> result;
  for (std::size_t k = 0; k < strengths.size(); k += stride) result.push_back(strengths[k]);
  return result;
}

/// The same for the best place on a grid; nothing where the strengths are too few or too even to tell.
std::optional<double> explained_by_a_place(const std::vector<Strength>& strengths) {
  if (strengths.size() < kMinStrengths) return std::nullopt;
  Eigen::Vector2d low = strengths.front().position_m, high = low;
  double sum = 0, squares = 0;
  for (const Strength& s : strengths) {
    low = low.cwiseMin(s.position_m);
    high = high.cwiseMax(s.position_m);
    sum += s.rssi_dbm, squares += s.rssi_dbm * s.rssi_dbm;
  }
  const double n = static_cast<double>(strengths.size()), variance = squares / n - sum * sum / (n * n);
  if (variance < kMinVariance_db2 || (high - low).norm() < kMinCarriedExtent_m) return std::nullopt;
  const Eigen::Vector2d margin = 0.2 * (high - low) + Eigen::Vector2d::Constant(10),
                        step = (high - low + 2 * margin) / kGrid;
  double best = 0;
  for (int x = 0; x <= kGrid; ++x)
    for (int y = 0; y <= kGrid; ++y)
      best = std::max(best,
                      explained_from(strengths, low - margin + Eigen::Vector2d(x * step.x(), y * step.y())));
  return best;
}

class AccessPointCheck {
 public:
  AccessPointCheck(const Mission& mission, const Robot& robot, const Track& track,
                   std::vector<Finding>& findings)
      : mission_(mission), robot_(robot), track_(track), findings_(findings) {}

  /// One strength wherever the robot goes: a radio on the robot itself.
  void check_carried() {
    struct Heard {
      Eigen::Vector3d low, high;
      double count = 0, sum = 0, squares = 0;
    };
    std::map<std::size_t, Heard> heard;
    for (const WifiScan& scan : robot_.wifi) {
      const auto row = track_.at(scan.stamp.seconds());
      if (!row) continue;
      for (const WifiReading& reading : scan.readings) {
        Heard& at = heard.try_emplace(reading.access_point.index(), Heard{row->position_m, row->position_m})
                        .first->second;
        at.low = at.low.cwiseMin(row->position_m);
        at.high = at.high.cwiseMax(row->position_m);
        const double rssi_dbm = static_cast<double>(reading.rssi_dbm);
        at.count += 1, at.sum += rssi_dbm, at.squares += rssi_dbm * rssi_dbm;
      }
    }
    for (const auto& [access_point, at] : heard) {
      const double mean = at.sum / at.count, extent_m = (at.high - at.low).norm();
      const double sigma = std::sqrt(std::max(0.0, at.squares / at.count - mean * mean));
      if (at.count < std::max(25.0, 0.6 * static_cast<double>(robot_.wifi.size())) ||
          extent_m < kMinCarriedExtent_m || mean < kNear_dbm || sigma > kMaxCarriedSigma_db)
        continue;
      report_moving(access_point, "is heard at " + number(mean) + " dBm, with a standard deviation of " +
                                      number(sigma) + " dB, wherever the robot goes within " +
                                      number(extent_m) + " m");
    }
  }

  /// Strengths that no fixed place of the access point explains, where those of most others are explained,
  /// and that differ where the robot returns.
  void check_moved() {
    std::map<std::size_t, std::vector<Strength>> heard;
    for (const WifiScan& scan : robot_.wifi) {
      const auto row = track_.at(scan.stamp.seconds());
      if (!row) continue;
      for (const WifiReading& reading : scan.readings)
        heard[reading.access_point.index()].push_back(
            {scan.stamp.seconds(), row->position_m.head<2>(), static_cast<double>(reading.rssi_dbm)});
    }
    std::vector<std::pair<std::size_t, double>> explained;
    std::vector<double> ratios;
    for (const auto& [access_point, strengths] : heard) {
      const auto ratio = explained_by_a_place(thinned(strengths));
      if (!ratio) continue;
      explained.emplace_back(access_point, *ratio);
      ratios.push_back(*ratio);
    }
    if (ratios.size() < 5 || median(ratios) < kUsuallyExplained) return;
    for (const auto& [access_point, ratio] : explained)
      if (ratio < std::min(kRarelyExplained, 0.55 * median(ratios)) &&
          change_at_places(thinned(heard[access_point])))
        report_moving(access_point, "has strengths that no fixed place explains (" + number(100 * ratio) +
                                        " % of their variance; usually " + number(100 * median(ratios)) +
                                        " %)");
  }

 private:
  void report_moving(std::size_t access_point, const std::string& how) {
    add("moving-access-point", Severity::kWarning, mission_.access_points[access_point] + " " + how,
        "access points that stay where they are",
        "leave it out: it moves, or several radios have this address");
  }

  void add(const char* kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back({kind, severity, robot_.id, robot_file(robot_.id, "wifi.csv"), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  const Mission& mission_;
  const Robot& robot_;
  const Track& track_;
  std::vector<Finding>& findings_;
};

}  // namespace

void check_access_points(const Mission& mission, const Robot& robot, const Track& track,
                         std::vector<Finding>& findings) {
  AccessPointCheck check(mission, robot, track, findings);
  check.check_carried();
  check.check_moved();
}

}  // namespace radioslam
