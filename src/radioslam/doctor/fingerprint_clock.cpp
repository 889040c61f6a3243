#include "radioslam/doctor/fingerprint_clock.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "radioslam/doctor/correlation.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxScans = 400;  // compared with each other for the clock
constexpr double kCompared_s = 240;     // within which dead reckoning is exact enough

class ClockCheck {
 public:
  ClockCheck(const Robot& robot, const Track& track, std::vector<Finding>& findings)
      : robot_(robot), track_(track), findings_(findings) {}

  /// Revisits and turns show by how much the scans are late.
  void check_clock() {
    const auto pairs = compared_pairs();
    if (robot_.wifi.size() < 60 || pairs.size() < 300) return;
    const double as_recorded = agreement(pairs, 0);
    double best = as_recorded, offset = 0;
    for (double seconds = -60; seconds <= 60; seconds += 1) {
      const double value = agreement(pairs, seconds);
      if (value > best) best = value, offset = seconds;
    }
    // Fisher's z of pairs that are far from independent: a tenth of the scans counts.
    const double gain = std::atanh(std::min(best, 0.999)) - std::atanh(std::max(as_recorded, -0.999));
    if (std::abs(offset) < 2 || best < 0.4 || gain < 0.12) return;
    add("clock", Severity::kWarning,
        "fingerprints fit the odometry best if they are " + number(std::abs(offset)) + " s " +
            (offset > 0 ? "late" : "early") + " (correlation " + number(best) + " instead of " +
            number(as_recorded) + ")",
        "the clock of the odometry", "subtract " + number(offset) + " s from t_s");
  }

 private:
  void add(const char* kind, Severity severity, std::string found, std::string expected, std::string advice) {
    findings_.push_back({kind, severity, robot_.id, robot_file(robot_.id, "wifi.csv"), std::move(found),
                         std::move(expected), std::move(advice)});
  }

  static double similarity(const WifiScan& a, const WifiScan& b) {
    double both = 0, difference = 0, any = 0;
    auto x = a.readings.begin(), y = b.readings.begin();
    while (x != a.readings.end() || y != b.readings.end()) {
      any += 1;
      if (y == b.readings.end() || (x != a.readings.end() && x->access_point < y->access_point)) {
        ++x;
      } else if (x == a.readings.end() || y->access_point < x->access_point) {
        ++y;
      } else {
        both += 1;
        difference += std::abs(static_cast<double>(x->rssi_dbm) - static_cast<double>(y->rssi_dbm));
        ++x, ++y;
      }
    }
    return both > 0 ? both / any * std::exp(-difference / both / 6) : 0;
  }

  struct ComparedPair {
    double t_a_s, t_b_s, similarity;
  };

  std::vector<ComparedPair> compared_pairs() const {
    std::vector<ComparedPair> pairs;
    const std::size_t stride = std::max<std::size_t>(1, (robot_.wifi.size() + kMaxScans - 1) / kMaxScans);
    for (std::size_t a = 0; a < robot_.wifi.size(); a += stride)
      for (std::size_t b = a + stride; b < robot_.wifi.size(); b += stride) {
        const double t_a = robot_.wifi[a].stamp.seconds(), t_b = robot_.wifi[b].stamp.seconds();
        if (t_b - t_a > kCompared_s) break;
        pairs.push_back({t_a, t_b, similarity(robot_.wifi[a], robot_.wifi[b])});
      }
    return pairs;
  }

  /// Correlation of similarity with nearness of the places, if the scans are `seconds` late.
  double agreement(const std::vector<ComparedPair>& pairs, double seconds) const {
    CorrelationSums sums;
    for (const ComparedPair& pair : pairs) {
      const auto a = track_.at(pair.t_a_s - seconds), b = track_.at(pair.t_b_s - seconds);
      if (!a || !b) continue;
      sums.add(std::exp(-(a->position_m - b->position_m).norm() / 8), pair.similarity);
    }
    if (sums.n < 0.5 * static_cast<double>(pairs.size())) return -1;
    const double spread = sums.spread_x() * sums.spread_y();
    return spread > 0 ? sums.spread_xy() / std::sqrt(spread) : 0;
  }

  const Robot& robot_;
  const Track& track_;
  std::vector<Finding>& findings_;
};

}  // namespace

void check_fingerprint_clock(const Robot& robot, const Track& track, std::vector<Finding>& findings) {
  ClockCheck(robot, track, findings).check_clock();
}

}  // namespace radioslam
