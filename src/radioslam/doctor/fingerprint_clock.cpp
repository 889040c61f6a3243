// Whether a robot's fingerprints are on the clock of its odometry: how similar two scans are should depend on
// how far apart the odometry has them.
//
// For every lag of the scans, similarity is fitted by a step function of distance; the lag with the least sum
// of squares is the likeliest. Turns, stops and places passed in both directions make distances depend on the
// lag; a straight path at constant speed does not. Pairs of scans share noise, so the gain over no lag must
// be found in most stretches of the recording, besides being large.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxScans = 400;                  // compared with each other
constexpr double kCompared_s = 240, kCompared_m = 400;  // within which dead reckoning is exact enough
constexpr std::size_t kMinScans = 60, kMinPairs = 300;
constexpr int kMaxLag_s = 40, kMinLag_s = 2;
constexpr double kMaxLagRatio = 1.0 / 7;  // of the recording: short ones fit a large lag by chance
constexpr std::size_t kStretches = 12;
constexpr double kMinGain = 0.08;          // of the sum of squares
constexpr double kMinStudent = 1.5;        // of the gains of the stretches
constexpr std::ptrdiff_t kMinGaining = 8;  // stretches
constexpr std::array kDistances_m{2.0F, 4.0F, 7.0F, 10.0F, 14.0F, 20.0F, 28.0F, 40.0F, 56.0F, 80.0F, 120.0F};

struct ComparedPair {
  std::uint32_t a, b;
  std::uint32_t stretch;
  float similarity;
};

using Gains = std::array<double, kStretches>;  ///< of the sum of squares, per stretch

class FingerprintClock {
 public:
  FingerprintClock(const Robot& robot, const Track& track) : track_(track) {
    const std::size_t stride = std::max<std::size_t>(1, (robot.wifi.size() + kMaxScans - 1) / kMaxScans);
    for (std::size_t k = 0; k < robot.wifi.size(); k += stride)
      if (const auto row = track_.at(robot.wifi[k].stamp.seconds())) {
        scans_.push_back(&robot.wifi[k]);
        path_m_.push_back(row->path_m);
      }
    if (scans_.size() >= kMinScans) add_pairs();
  }

  bool is_enough() const { return pairs_.size() >= kMinPairs; }

  /// Squared residuals of all pairs at this lag; NaN where the odometry does not reach.
  std::vector<float> squares(int lag_s) const {
    const float unknown = std::numeric_limits<float>::quiet_NaN();
    std::vector<Eigen::Vector3f> places;
    for (const WifiScan* scan : scans_) {
      const auto row = track_.at(scan->stamp.seconds() - lag_s);
      places.push_back(row ? Eigen::Vector3f(row->position_m.cast<float>()) : Eigen::Vector3f(unknown, 0, 0));
    }
    std::array<double, kDistances_m.size() + 1> sums{}, counts{};
    std::vector<std::uint8_t> bins;
    std::vector<float> result;
    bins.reserve(pairs_.size()), result.reserve(pairs_.size());
    for (const ComparedPair& pair : pairs_) {
      const float distance_m = (places[pair.a] - places[pair.b]).norm();
      const auto bin = std::upper_bound(kDistances_m.begin(), kDistances_m.end(), distance_m);
      bins.push_back(static_cast<std::uint8_t>(bin - kDistances_m.begin()));
      result.push_back(std::isfinite(distance_m) ? 0 : unknown);
      if (std::isfinite(distance_m))
        sums[bins.back()] += static_cast<double>(pair.similarity), counts[bins.back()] += 1;
    }
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      const float mean = static_cast<float>(sums[bins[k]] / std::max(1.0, counts[bins[k]]));
      result[k] += (pairs_[k].similarity - mean) * (pairs_[k].similarity - mean);  // NaN stays
    }
    return result;
  }

  /// What `after` gains on `before`, relative to the sum over all pairs known in both; nothing if these are
  /// few.
  Gains gains(const std::vector<float>& before, const std::vector<float>& after) const {
    Gains gains{};
    double sum = 0, known = 0;
    for (std::size_t k = 0; k < pairs_.size(); ++k) {
      if (!std::isfinite(before[k]) || !std::isfinite(after[k])) continue;
      gains[pairs_[k].stretch] += static_cast<double>(before[k] - after[k]);
      sum += static_cast<double>(before[k]), known += 1;
    }
    if (known < 0.5 * static_cast<double>(pairs_.size()) || sum <= 0) return {};
    for (double& gain : gains) gain /= sum;
    return gains;
  }

 private:
  void add_pairs() {
    for (std::uint32_t a = 0; a < scans_.size(); ++a)
      for (std::uint32_t b = a + 1; b < scans_.size(); ++b) {
        if (seconds_between(scans_[a]->stamp, scans_[b]->stamp) > kCompared_s ||
            path_m_[b] - path_m_[a] > kCompared_m)
          break;
        const auto stretch = static_cast<std::uint32_t>((a + b) / 2 * kStretches / scans_.size());
        pairs_.push_back({a, b, stretch, static_cast<float>(fingerprint_similarity(*scans_[a], *scans_[b]))});
      }
  }

  const Track& track_;
  std::vector<const WifiScan*> scans_;
  std::vector<double> path_m_;  ///< at the scans
  std::vector<ComparedPair> pairs_;
};

int largest_lag_s(const Robot& robot) {
  const double length_s = seconds_between(robot.wifi.front().stamp, robot.wifi.back().stamp);
  return static_cast<int>(std::min(static_cast<double>(kMaxLag_s), kMaxLagRatio * length_s));
}

double total(const Gains& gains) {
  double sum = 0;
  for (const double gain : gains) sum += gain;
  return sum;
}

double student(const Gains& gains) {
  const double n = static_cast<double>(kStretches), mean = total(gains) / n;
  double squares = 0;
  for (const double gain : gains) squares += (gain - mean) * (gain - mean);
  return squares > 0 ? mean / std::sqrt(squares / (n * (n - 1))) : 0;
}

}  // namespace

double fingerprint_similarity(const WifiScan& a, const WifiScan& b) {
  double both = 0, difference = 0;
  for_common_readings(a, b, [&](const WifiReading& x, const WifiReading& y) {
    both += 1;
    difference += std::abs(static_cast<double>(x.rssi_dbm) - static_cast<double>(y.rssi_dbm));
  });
  const double any = static_cast<double>(a.readings.size() + b.readings.size()) - both;
  return both > 0 ? both / any * std::exp(-difference / both / 6) : 0;
}

void check_fingerprint_clock(const Robot& robot, const Track& track, std::vector<Finding>& findings) {
  const FingerprintClock clock(robot, track);
  if (!clock.is_enough()) return;
  const auto as_recorded = clock.squares(0);
  Gains best{};
  int best_lag_s = 0;
  const int max_lag_s = largest_lag_s(robot);
  for (int lag_s = -max_lag_s; lag_s <= max_lag_s; ++lag_s) {
    const Gains gains = clock.gains(as_recorded, clock.squares(lag_s));
    if (total(gains) > total(best)) best = gains, best_lag_s = lag_s;
  }
  if (std::abs(best_lag_s) < kMinLag_s || std::abs(best_lag_s) == max_lag_s || total(best) < kMinGain ||
      student(best) < kMinStudent ||
      std::count_if(best.begin(), best.end(), [](double gain) { return gain > 0; }) < kMinGaining)
    return;
  findings.push_back({"clock", Severity::kWarning, robot.id, robot_file(robot.id, "wifi.csv"),
                      "fingerprints fit the odometry best if they are " +
                          std::to_string(std::abs(best_lag_s)) + " s " + (best_lag_s > 0 ? "late" : "early") +
                          " (" + number(100 * total(best)) + " % less variance of their similarities)",
                      "the clock of the odometry", "subtract " + std::to_string(best_lag_s) + " s from t_s"});
}

}  // namespace radioslam
