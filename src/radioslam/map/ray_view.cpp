#include "radioslam/map/ray_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr int kColumns = 720, kRows = 360;  // half a degree
constexpr float kPixels_per_rad = static_cast<float>(kColumns) / (2 * std::numbers::pi_v<float>);
constexpr int kMaxReach = 4;         // pixels about a point's direction in which rays are looked for
constexpr int kBlock = 8;            // pixels along a block
constexpr float kMinCosine = 0.05F;  // between a ray and a normal, below which the ray grazes
constexpr float kMinRange_m = 0.5F;
constexpr float kSlope = 0.1F;  // by which a surface may deviate from its normal's plane

/// To 1e-4 rad, a hundredth of a pixel.
float quick_atan2(float y, float x) {
  using std::numbers::pi_v;
  const float ax = std::abs(x), ay = std::abs(y), most = std::max(ax, ay);
  const float ratio = most > 0 ? std::min(ax, ay) / most : 0, square = ratio * ratio;
  float angle = ((-0.0464964749F * square + 0.15931422F) * square - 0.327622764F) * square * ratio + ratio;
  if (ay > ax) angle = pi_v<float> / 2 - angle;
  if (x < 0) angle = pi_v<float> - angle;
  return y < 0 ? -angle : angle;
}

std::size_t pixel_of(int column, int row) { return static_cast<std::size_t>(row * kColumns + column); }

std::size_t block_of(int column, int row) {
  return static_cast<std::size_t>(row / kBlock * (kColumns / kBlock) + column / kBlock);
}

int column_of(const Eigen::Vector3f& ray) {
  const float angle = quick_atan2(ray.y(), ray.x()) + std::numbers::pi_v<float>;
  return std::clamp(static_cast<int>(kPixels_per_rad * angle), 0, kColumns - 1);
}

int row_of(const Eigen::Vector3f& ray) {
  const float angle = quick_atan2(ray.z(), ray.head<2>().norm()) + std::numbers::pi_v<float> / 2;
  return std::clamp(static_cast<int>(kPixels_per_rad * angle), 0, kRows - 1);
}

}  // namespace

RayView::RayView(const PlacedScan& scan, const MappedRobot& robot, double view_range_m)
    : view_range_m_(view_range_m) {
  const Eigen::Matrix3f R = scan.T_frame_body.rotation_matrix().cast<float>();
  const auto middle_s = static_cast<float>(scan.returns.middle_s);
  const Eigen::Vector3d middle = robot.geometry.scanner_m + scan.returns.middle_s * scan.velocity_mps;
  origin_m_ = scan.T_frame_body * middle;
  const Eigen::Vector3f velocity = R * scan.velocity_mps.cast<float>();
  std::vector<Ray> rays;
  rays.reserve(scan.returns.points.size());
  for (std::size_t k = 0; k < scan.returns.points.size(); ++k) {
    const float time_s = scan.returns.times_s.empty() ? middle_s : scan.returns.times_s[k];
    rays.push_back({(time_s - middle_s) * velocity, R * (scan.returns.points[k] - middle.cast<float>())});
  }
  sort_rays(rays);
}

void RayView::sort_rays(const std::vector<Ray>& rays) {
  std::vector<std::uint32_t> pixels;
  std::vector<int> counts(kColumns);
  column_origins_.assign(kColumns, Eigen::Vector3f::Zero());
  farthest_m_.assign(block_of(kColumns - 1, kRows - 1) + 1, 0);
  begin_.assign(std::size_t{kColumns} * kRows + 1, 0);
  for (const Ray& ray : rays) {
    const int column = column_of(ray.hit - ray.origin), row = row_of(ray.hit - ray.origin);
    pixels.push_back(static_cast<std::uint32_t>(pixel_of(column, row)));
    ++begin_[pixels.back() + 1];
    Eigen::Vector3f& origin = column_origins_[static_cast<std::size_t>(column)];
    origin += (ray.origin - origin) / static_cast<float>(++counts[static_cast<std::size_t>(column)]);
    note_farthest(column, row, std::max(ray.origin.norm(), ray.hit.norm()));
  }
  for (std::size_t k = 1; k < begin_.size(); ++k) begin_[k] += begin_[k - 1];
  rays_.resize(rays.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t k = 0; k < rays.size(); ++k) rays_[next[pixels[k]]++] = rays[k];
}

/// In all blocks from whose pixels the ray is looked for.
void RayView::note_farthest(int column, int row, float range_m) {
  for (const int y : {row - kMaxReach, row + kMaxReach})
    for (const int x : {column - kMaxReach, column + kMaxReach}) {
      float& farthest_m = farthest_m_[block_of((x + kColumns) % kColumns, std::clamp(y, 0, kRows - 1))];
      farthest_m = std::max(farthest_m, range_m);
    }
}

RayView::Votes RayView::at(const Eigen::Vector3d& position, const Eigen::Vector3f& normal, float radius_m,
                           float depth_m) const {
  Votes votes;
  const Eigen::Vector3f p = (position - origin_m_).cast<float>();
  const float range_m = p.norm();
  if (range_m < kMinRange_m || range_m > static_cast<float>(view_range_m_)) return votes;
  const bool has_normal = normal.squaredNorm() > 0.5F;
  if (has_normal && std::abs(normal.dot(p)) < kMinCosine * range_m) return votes;  // all rays there graze
  const Eigen::Vector3f from_scanner = p - column_origins_[static_cast<std::size_t>(column_of(p))];
  const int column = column_of(from_scanner), row = row_of(from_scanner);
  if (range_m > farthest_m_[block_of(column, row)] + radius_m + depth_m) return votes;  // all rays end before
  const float angle_px = kPixels_per_rad * radius_m / from_scanner.norm();
  const int reach = std::min(kMaxReach, static_cast<int>(std::ceil(angle_px)));
  const auto vote = [&](const Ray& ray) {
    const Eigen::Vector3f along = ray.hit - ray.origin;
    const Eigen::Vector3f n = has_normal ? normal : Eigen::Vector3f(-along.normalized());
    const float from = n.dot(ray.origin - p), to = n.dot(ray.hit - p);
    if (std::abs(from - to) < kMinCosine * along.norm()) return;
    if (std::abs(to) <= depth_m) {
      const Eigen::Vector3f off = ray.hit - p;
      if ((off - to * n).squaredNorm() <= radius_m * radius_m) ++votes.hits;
    } else if ((from > 0) != (to > 0) && std::abs(to) > depth_m + kSlope * (ray.hit - p).norm()) {
      const Eigen::Vector3f crossing = ray.origin + from / (from - to) * along;
      if ((crossing - p).squaredNorm() <= radius_m * radius_m) ++votes.through;
    }
  };
  const auto vote_all = [&](int first, int last, int y) {  // columns, which are consecutive
    for (std::uint32_t k = begin_[pixel_of(first, y)]; k < begin_[pixel_of(last, y) + 1]; ++k) vote(rays_[k]);
  };
  const int first = column - reach, last = column + reach;
  for (int y = std::max(0, row - reach); y <= std::min(kRows - 1, row + reach); ++y) {
    if (first < 0) vote_all(first + kColumns, kColumns - 1, y);
    vote_all(std::max(0, first), std::min(kColumns - 1, last), y);
    if (last >= kColumns) vote_all(0, last - kColumns, y);
  }
  return votes;
}

}  // namespace radioslam
