#include "radioslam/map/occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace radioslam {
namespace {

constexpr std::size_t kColumns = 720;
constexpr std::uint16_t kMaxCount = 65535;
constexpr double kMinNeighbourRatio = 0.1;  // of the hits of a wall, below which a cell holds its noise

void count(std::uint16_t& of) { of = static_cast<std::uint16_t>(std::min<int>(kMaxCount, of + 1)); }

/// Part of a ray, from 0 to 1, in which its height is within the slice; empty if begin > end.
struct RayPart {
  double begin = 0, end = 1;

  RayPart(double from_height_m, double to_height_m, double bottom_m, double top_m) {
    const double rise = to_height_m - from_height_m;
    if (std::abs(rise) < 1e-9) {
      if (from_height_m < bottom_m || from_height_m > top_m) begin = 2;
      return;
    }
    const double a = (bottom_m - from_height_m) / rise, b = (top_m - from_height_m) / rise;
    begin = std::max(0.0, std::min(a, b));
    end = std::min(1.0, std::max(a, b));
  }
};

}  // namespace

OccupancyBuilder::OccupancyBuilder(const Eigen::AlignedBox2d& bounds, const MapParams& params)
    : params_(params), cell_m_(params.cell_m), columns_(kColumns) {
  const auto cells_along = [&](int axis) {
    return std::floor(bounds.max()[axis] / cell_m_) - std::floor(bounds.min()[axis] / cell_m_) + 1;
  };
  while (cells_along(0) * cells_along(1) > params.max_cells) cell_m_ *= 2;
  width_ = static_cast<std::int64_t>(cells_along(0));
  height_ = static_cast<std::int64_t>(cells_along(1));
  origin_m_ = {cell_m_ * std::floor(bounds.min().x() / cell_m_),
               cell_m_ * std::floor(bounds.min().y() / cell_m_)};
  cells_.resize(static_cast<std::size_t>(width_ * height_));
}

OccupancyBuilder::Cell* OccupancyBuilder::cell_at(const Eigen::Vector2d& position) {
  const Eigen::Vector2d at = (position - origin_m_) / cell_m_;
  const auto x = static_cast<std::int64_t>(std::floor(at.x())),
             y = static_cast<std::int64_t>(std::floor(at.y()));
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return nullptr;
  return &cells_[static_cast<std::size_t>(y * width_ + x)];
}

void OccupancyBuilder::gather(const PlacedScan& scan, const MappedRobot& robot) {
  for (Column& column : columns_) column.from_m = column.to_m = 0;
  const Eigen::Matrix3d R = scan.T_frame_body.rotation_matrix();
  const Eigen::Vector3d body = scan.T_frame_body.translation(), scanner = R * robot.geometry.scanner_m;
  const Eigen::Vector2d velocity = (R * scan.velocity_mps).head<2>();
  const bool is_planar = robot.kind == ScannerKind::kPlanar;
  const double from_height_m = scanner.z() - robot.geometry.ground_m;
  for (std::size_t k = 0; k < scan.returns.points.size(); ++k) {
    const Eigen::Vector3d at = R * scan.returns.points[k].cast<double>();
    Eigen::Vector2d origin = scanner.head<2>();
    if (!scan.returns.times_s.empty()) origin += static_cast<double>(scan.returns.times_s[k]) * velocity;
    const Eigen::Vector2d ray = at.head<2>() - origin;
    const double range_m = ray.norm(), height_m = at.z() - robot.geometry.ground_m;
    if (!(range_m > 0)) continue;
    if (is_planar || (params_.slice_bottom_m <= height_m && height_m <= params_.slice_top_m))
      count_hit((body + at).head<2>());
    RayPart part(from_height_m, height_m, params_.slice_bottom_m, params_.slice_top_m);
    if (is_planar) part.begin = 0, part.end = 1;
    if (part.begin > part.end) continue;
    const double turn = (std::atan2(ray.y(), ray.x()) + std::numbers::pi) / (2 * std::numbers::pi);
    Column& column = columns_[std::min(kColumns - 1, static_cast<std::size_t>(turn * kColumns))];
    const double begin_m = part.begin * range_m, end_m = part.end * range_m;
    column.from_m = column.to_m > 0 ? std::min(column.from_m, begin_m) : begin_m;
    if (end_m <= column.to_m) continue;
    column.to_m = end_m;
    column.origin = body.head<2>() + origin;
    column.direction = ray / range_m;
  }
}

void OccupancyBuilder::count_hit(const Eigen::Vector2d& position) {
  Cell* cell = cell_at(position);
  if (!cell || cell->last == scan_) return;
  cell->last = scan_;
  count(cell->hits);
}

void OccupancyBuilder::count_through(const Column& column) {
  // Half a cell in front of the farthest point: what is there is a surface, not free.
  const auto steps = static_cast<int>(column.to_m / cell_m_ - 0.5);
  for (auto step = static_cast<int>(column.from_m / cell_m_); step < steps; ++step) {
    Cell* cell = cell_at(column.origin + (step + 0.5) * cell_m_ * column.direction);
    if (!cell || cell->last == scan_) continue;
    cell->last = scan_;
    count(cell->through);
  }
}

void OccupancyBuilder::add(const PlacedScan& scan, const MappedRobot& robot) {
  ++scan_;
  gather(scan, robot);
  for (const Column& column : columns_)
    if (column.to_m > 0) count_through(column);
}

const OccupancyBuilder::Cell& OccupancyBuilder::cell(std::int64_t x, std::int64_t y) const {
  static const Cell none;
  return x < 0 || y < 0 || x >= width_ || y >= height_ ? none
                                                       : cells_[static_cast<std::size_t>(y * width_ + x)];
}

CellState OccupancyBuilder::state_of(std::int64_t x, std::int64_t y) const {
  const Cell& of = cell(x, y);
  const int scans = of.hits + of.through;
  if (scans == 0) return CellState::kUnknown;
  if (of.hits == 0 || of.hits < params_.min_occupied_ratio * scans) return CellState::kFree;
  int most = 0;  // hits of a neighbour
  for (std::int64_t dy = -1; dy <= 1; ++dy)
    for (std::int64_t dx = -1; dx <= 1; ++dx) most = std::max<int>(most, cell(x + dx, y + dy).hits);
  return of.hits < kMinNeighbourRatio * most ? CellState::kUnknown : CellState::kOccupied;
}

OccupancyGrid OccupancyBuilder::grid() const {
  std::int64_t left = width_, right = -1, bottom = height_, top = -1;
  for (std::int64_t y = 0; y < height_; ++y)
    for (std::int64_t x = 0; x < width_; ++x)
      if (cell(x, y).hits + cell(x, y).through > 0) {
        left = std::min(left, x), right = std::max(right, x);
        bottom = std::min(bottom, y), top = std::max(top, y);
      }
  OccupancyGrid grid;
  grid.cell_m = cell_m_;
  if (right < 0) return grid;
  grid.origin_m =
      origin_m_ + cell_m_ * Eigen::Vector2d(static_cast<double>(left), static_cast<double>(bottom));
  grid.width = static_cast<std::size_t>(right - left + 1);
  grid.height = static_cast<std::size_t>(top - bottom + 1);
  for (std::int64_t y = bottom; y <= top; ++y)
    for (std::int64_t x = left; x <= right; ++x) grid.cells.push_back(state_of(x, y));
  return grid;
}

}  // namespace radioslam
