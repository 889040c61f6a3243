#include "radioslam/places/scan_context.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr double kGroundQuantile = 0.05;  ///< of the heights; the lowest points are outliers below the ground

struct PolarPoint {
  Eigen::Index ring, sector;
  float height_m;
};

std::vector<PolarPoint> polar_points(const std::vector<Eigen::Vector3f>& points, double max_range_m,
                                     const ScanContextParams& params) {
  std::vector<PolarPoint> found;
  found.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    if (!point.allFinite()) continue;
    const double range_m = std::hypot(static_cast<double>(point.x()), static_cast<double>(point.y()));
    if (range_m == 0 || range_m >= max_range_m) continue;
    const double turns = static_cast<double>(std::atan2(point.y(), point.x())) / (2 * std::numbers::pi);
    const double sector = (turns < 0 ? turns + 1 : turns) * params.sectors;
    found.push_back({std::min(params.rings - 1, static_cast<int>(range_m / max_range_m * params.rings)),
                     static_cast<int>(sector) % params.sectors, point.z()});
  }
  return found;
}

float ground_height(const std::vector<PolarPoint>& points) {
  std::vector<float> heights;
  heights.reserve(points.size());
  for (const PolarPoint& point : points) heights.push_back(point.height_m);
  const auto k = static_cast<std::ptrdiff_t>(kGroundQuantile * static_cast<double>(heights.size()));
  std::nth_element(heights.begin(), heights.begin() + k, heights.end());
  return heights[static_cast<std::size_t>(k)];
}

std::uint64_t lowest_bits(int count) { return ~std::uint64_t{0} >> (64 - count); }

/// Bit j becomes bit j + shift, modulo `count` bits.
std::uint64_t rotated(std::uint64_t bits, int shift, int count) {
  if (shift == 0) return bits;
  return ((bits << shift) | (bits >> (count - shift))) & lowest_bits(count);
}

double yaw_of(int shift, int sectors) {
  const int turned = 2 * shift > sectors ? shift - sectors : shift;
  return 2 * std::numbers::pi * turned / sectors;
}

}  // namespace

ScanContext::Rounded::Rounded(const Eigen::MatrixXf& values) {
  constexpr float kMostSteps = std::numeric_limits<std::int16_t>::max();
  step = values.size() > 0 ? values.cwiseAbs().maxCoeff() / kMostSteps : 0;
  steps = values.unaryExpr([&](float value) {
    if (value == 0) return std::int16_t{0};
    const float rounded = std::round(value / step);
    return static_cast<std::int16_t>(rounded == 0 ? std::copysign(1.0F, value) : rounded);
  });
}

ScanContext::ScanContext(const Eigen::MatrixXf& bins, double min_common_ratio)
    : bins_(bins), spectra_(Eigen::MatrixXf()) {
  RADIOSLAM_CHECK(rings() >= 1 && sectors() <= kMaxSectors, "at least one ring, at most 64 sectors");
  min_common_ = std::max(1, static_cast<int>(std::ceil(min_common_ratio * sectors())));
  Eigen::MatrixXf unit = bins;
  for (int j = 0; j < sectors(); ++j) {
    const float norm = unit.col(j).norm();
    if (!(norm > 0)) continue;
    unit.col(j) /= norm;
    columns_ |= std::uint64_t{1} << j;
  }
  spectra_ = Rounded(SectorDft::complete(sectors()).spectra_of_rows(unit));
}

ScanContext make_scan_context(const std::vector<Eigen::Vector3f>& points, double max_range_m,
                              ScanContextKind kind, const ScanContextParams& params) {
  RADIOSLAM_CHECK(max_range_m > 0, "a grid needs a range");
  Eigen::MatrixXf bins = Eigen::MatrixXf::Zero(params.rings, params.sectors);
  const std::vector<PolarPoint> found = polar_points(points, max_range_m, params);
  const bool has_heights = kind == ScanContextKind::kHeight && !found.empty();
  const float ground_m = has_heights ? ground_height(found) : 0;
  for (const PolarPoint& point : found) {
    float& bin = bins(point.ring, point.sector);
    bin = std::max(bin, has_heights ? point.height_m - ground_m : 1.0F);
  }
  return {bins, params.min_common_ratio};
}

ContextMatch compare(const ScanContext& a, const ScanContext& b) {
  RADIOSLAM_CHECK(a.rings() == b.rings() && a.sectors() == b.sectors(), "grids of one shape");
  const int sectors = a.sectors(), min_common = std::max(a.min_common(), b.min_common());
  ContextMatch best;
  if (a.empty() || b.empty()) return best;
  const auto sums = SectorDft::complete(sectors).correlation(a.spectra(), b.spectra());
  const std::uint64_t all = lowest_bits(sectors);
  const bool same_count = a.columns() == all || b.columns() == all;
  int common = std::popcount(a.columns() & b.columns());
  double best_mean = 0;
  for (int shift = 0; shift < sectors; ++shift) {
    if (!same_count) common = std::popcount(a.columns() & rotated(b.columns(), shift, sectors));
    if (common < min_common) continue;
    const double mean = static_cast<double>(sums[shift]) / common;
    if (mean <= best_mean) continue;
    best_mean = mean;
    best.shift = shift;
  }
  best.distance = std::clamp(1 - best_mean, 0.0, 1.0);
  best.yaw_rad = yaw_of(best.shift, sectors);
  return best;
}

std::size_t wire_bytes(const ScanContext& context) {
  constexpr std::size_t kHeader = 2 + 2 + 4;  // rings, sectors, metres per step
  return kHeader + static_cast<std::size_t>(context.rings() * context.sectors());
}

}  // namespace radioslam
