// WiFi scans that repeat older ones: readings that a phone or driver kept and listed again while the robot
// moved on.
//
// A reading in two scans at different places has the same value by chance; levels are whole dBm, so chance is
// not rare. Whole scans: with probability p of one equal reading, which the other pairs of scans show, a scan
// of n readings has at least 0.9 n equal ones with the tail of Bin(n, p); the number of repeats is tested
// against the sum of those (Poisson, Chernoff bound). Single readings: differences between scans have a
// smooth density, so that the number of zeros follows from those of one and two steps as of a Gaussian; kept
// readings add zeros to it.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "radioslam/base/statistics.hpp"
#include "radioslam/doctor/checks.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLags = 12;  // scans back
constexpr double kMinMoved_m = 1;
constexpr double kMinCommon = 5;            // readings
constexpr double kRepeatedRatio = 0.9;      // of the readings of a scan that repeats another
constexpr double kMaxLogProbability = -14;  // one in a million
constexpr int kDifferences = 5;             // 0 to 4 dB
constexpr double kMinExcessRatio = 0.15;    // of readings equal beyond chance
constexpr double kMinDifferences = 150;
constexpr double kPeakedness = 1.3;  // of densities with mixed noise over that of a Gaussian

struct Comparison {
  std::size_t later = 0, lag = 0;
  double moved_m = 0;
  double common = 0, any = 0, equal = 0;
  std::array<double, kDifferences> differences{};  ///< number of readings by |difference| in dB

  double equal_ratio() const { return equal / common; }
  bool is_repeat() const { return common >= kMinCommon && equal >= kRepeatedRatio * any; }
};

void compare(const WifiScan& a, const WifiScan& b, Comparison& result) {
  for_common_readings(a, b, [&](const WifiReading& x, const WifiReading& y) {
    const double difference = std::abs(static_cast<double>(x.rssi_dbm) - static_cast<double>(y.rssi_dbm));
    result.common += 1;
    result.equal += difference < 1e-6;
    if (std::round(difference) < kDifferences)
      result.differences[static_cast<std::size_t>(std::lround(difference))] += 1;
  });
  result.any = static_cast<double>(a.readings.size() + b.readings.size()) - result.common;
}

std::vector<Comparison> compared_scans(const Robot& robot, const Track& track) {
  std::vector<std::optional<Track::Row>> places;
  for (const WifiScan& scan : robot.wifi) places.push_back(track.at(scan.stamp.seconds()));
  std::vector<Comparison> result;
  for (std::size_t k = 1; k < robot.wifi.size(); ++k)
    for (std::size_t lag = 1; lag <= std::min(k, kLags); ++lag) {
      if (!places[k] || !places[k - lag]) continue;
      Comparison comparison{k, lag, (places[k]->position_m - places[k - lag]->position_m).norm()};
      if (comparison.moved_m < kMinMoved_m) continue;
      compare(robot.wifi[k - lag], robot.wifi[k], comparison);
      if (comparison.common >= kMinCommon) result.push_back(comparison);
    }
  return result;
}

/// Probability of at least `least` successes out of `n` of probability `p`.
double binomial_tail(double n, double least, double p) {
  double sum = 0;
  for (double k = std::ceil(least); k <= n; k += 1)
    sum += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
                    (n - k) * std::log1p(-p));
  return sum;
}

/// Probability that a reading is equal by chance: usual for these scans, raised because scans differ in it.
double chance_of_equality(const std::vector<Comparison>& comparisons) {
  std::vector<double> ratios;
  for (const Comparison& comparison : comparisons) ratios.push_back(comparison.equal_ratio());
  return std::min(0.9, 0.05 + 1.5 * median(ratios));
}

struct Repeats {
  double scans = 0, repeated = 0, expected = 0;
  std::vector<double> moved_m;  ///< since the scan that is repeated
};

/// Per number of common readings, the probability that a scan seems to repeat another one by chance.
std::vector<double> chances_of_repeat(const std::vector<Comparison>& comparisons) {
  const double p = chance_of_equality(comparisons);
  double most = 0;
  for (const Comparison& comparison : comparisons) most = std::max(most, comparison.common);
  std::vector<double> chances;
  for (double n = 0; n <= most; n += 1) chances.push_back(binomial_tail(n, kRepeatedRatio * n, p));
  return chances;
}

Repeats repeats_among(const std::vector<Comparison>& comparisons) {
  const std::vector<double> chances = chances_of_repeat(comparisons);
  Repeats repeats;
  for (std::size_t k = 0; k < comparisons.size();) {
    double chance = 0;
    const Comparison* repeat = nullptr;
    const std::size_t later = comparisons[k].later;
    for (; k < comparisons.size() && comparisons[k].later == later; ++k) {
      const Comparison& c = comparisons[k];
      chance += chances[static_cast<std::size_t>(c.common)];
      if (!repeat && c.is_repeat()) repeat = &c;
    }
    repeats.scans += 1;
    repeats.expected += std::min(1.0, chance);
    if (!repeat) continue;
    repeats.repeated += 1;
    repeats.moved_m.push_back(repeat->moved_m);
  }
  return repeats;
}

/// Chernoff bound of the logarithm of the probability of so many.
bool is_beyond_chance(const Repeats& repeats) {
  const double n = repeats.repeated, expected = std::max(repeats.expected, 1e-3);
  return n >= 3 && n > expected && n - expected - n * std::log(n / expected) < kMaxLogProbability;
}

/// Ratio of the readings that are equal beyond what the numbers of small differences let expect.
double excess_ratio(const std::vector<Comparison>& comparisons, std::size_t lag) {
  std::array<double, kDifferences> of{};
  double all = 0;
  for (const Comparison& comparison : comparisons) {
    if (comparison.lag != lag) continue;
    for (std::size_t d = 0; d < of.size(); ++d) of[d] += comparison.differences[d];
    all += comparison.common;
  }
  if (all < kMinDifferences) return 0;
  // Some cards know even levels only.
  const std::size_t step = of[1] < 0.3 * of[2] ? 2 : 1;
  const double one = 0.5 * of[step], two = std::max(1.0, 0.5 * of[2 * step]);  // of either sign
  const double zero = one * std::cbrt(std::max(1.0, one / two)), excess = of[0] - kPeakedness * zero;
  return excess > 5 * std::sqrt(of[0] + zero) ? excess / all : 0;
}

}  // namespace

void check_stale_scans(const Robot& robot, const Track& track, std::vector<Finding>& findings) {
  const auto comparisons = compared_scans(robot, track);
  if (comparisons.size() < 10) return;
  const auto add = [&](std::string found) {
    findings.push_back({"stale", Severity::kWarning, robot.id, robot_file(robot.id, "wifi.csv"),
                        std::move(found), "new readings in every scan",
                        "remove what was kept of earlier scans: it is older than its time says"});
  };
  const Repeats repeats = repeats_among(comparisons);
  if (is_beyond_chance(repeats))
    return add(number(repeats.repeated) + " of " + number(repeats.scans) +
               " scans repeat an older one, taken " + number(median(repeats.moved_m)) + " m before");
  double largest = 0;
  for (std::size_t lag = 1; lag <= kLags; ++lag) largest = std::max(largest, excess_ratio(comparisons, lag));
  if (largest > kMinExcessRatio)
    add(number(100 * largest) + " % of the readings repeat those of an older scan, " +
        "beyond what is equal by chance");
}

}  // namespace radioslam
