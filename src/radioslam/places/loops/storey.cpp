#include "radioslam/places/loops/storey.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace radioslam {
namespace {

constexpr double kMinStorey_m = 2.5;  // height
constexpr float kIndoors_m = 30;      // range of most points on a storey
constexpr float kOverhead_m = 0.5;    // height above the body
constexpr float kTilt_rad = 0.01F;    // of the body, which tilts the ceiling
constexpr float kMinLayer_m = 0.15F;  // half the thickness of what is at one height
constexpr double kCeilingShare = 0.3;
constexpr std::size_t kMinOverhead = 20;

float quantile(std::vector<float>& values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

bool has_ceiling(const std::vector<float>& heights_m, float range_m) {
  std::vector<float> overhead_m;
  for (const float height_m : heights_m)
    if (height_m > kOverhead_m) overhead_m.push_back(height_m);
  if (overhead_m.size() < kMinOverhead) return false;
  const float top_m = quantile(overhead_m, 0.95), layer_m = std::max(kMinLayer_m, kTilt_rad * range_m);
  const auto at_top = std::count_if(overhead_m.begin(), overhead_m.end(),
                                    [&](float height_m) { return std::abs(height_m - top_m) <= layer_m; });
  return static_cast<double>(at_top) >= kCeilingShare * static_cast<double>(overhead_m.size());
}

}  // namespace

std::optional<double> storey_height_m(const ScanPyramid& scan) {
  std::vector<float> heights_m, ranges_m;
  for (const Surfel& surfel : scan.all) {
    heights_m.push_back(surfel.position.z());
    ranges_m.push_back(surfel.position.head<2>().norm());
  }
  if (heights_m.empty()) return std::nullopt;
  const float range_m = quantile(ranges_m, 0.9);
  if (range_m > kIndoors_m && !has_ceiling(heights_m, range_m)) return std::nullopt;
  return std::max(kMinStorey_m, static_cast<double>(quantile(heights_m, 0.98) - quantile(heights_m, 0.05)));
}

double prior_density(double squared_distance) {
  constexpr std::array<double, 4> kScales{0.25, 0.5, 1, 2};
  double sum = 0;
  for (const double a : kScales) sum += std::exp(-squared_distance / (2 * a * a)) / a;
  return sum / static_cast<double>(kScales.size());
}

double other_storeys(double storey_m, double z_m, const std::vector<ExpectedHeight>& expected,
                     double sigma_m) {
  constexpr double kLeast = 1e-12;
  const auto density = [&](double at_m) {
    double sum = kLeast;
    for (const auto& [expected_m, share] : expected) {
      const double off = (at_m - expected_m) / sigma_m;
      sum += share * prior_density(off * off);
    }
    return sum;
  };
  double sum = 0;
  for (const double side : {-1.0, 1.0}) {
    double most = 0;
    for (const ExpectedHeight& at : expected)
      most = std::max(most, density(z_m + side * std::clamp(side * (at.z_m - z_m), storey_m, 2 * storey_m)));
    sum += most;
  }
  return sum / density(z_m);
}

}  // namespace radioslam
