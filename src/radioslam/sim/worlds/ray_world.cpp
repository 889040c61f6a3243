#include "radioslam/sim/worlds/ray_world.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace radioslam {
namespace {

constexpr double kCellsPerShape = 8;
constexpr double kSmallestCell_m = 0.5;
constexpr double kMargin_m = 1e-6;  ///< around everything, so that no shape is on the border

std::vector<Eigen::AlignedBox2d> footprints_of(const WorldShapes& shapes) {
  std::vector<Eigen::AlignedBox2d> footprints;
  for (const auto& box : shapes.boxes) footprints.push_back(footprint(box));
  for (const auto& pillar : shapes.pillars) footprints.push_back(footprint(pillar));
  return footprints;
}

}  // namespace

FloorGrid::FloorGrid(const std::vector<Eigen::AlignedBox2d>& footprints) {
  if (footprints.empty()) return;
  for (const auto& footprint : footprints) bounds_.extend(footprint);
  bounds_ = {Eigen::Vector2d(bounds_.min().array() - kMargin_m),
             Eigen::Vector2d(bounds_.max().array() + kMargin_m)};
  const Eigen::Vector2d size = bounds_.sizes();
  const double cells = kCellsPerShape * static_cast<double>(footprints.size());
  // At most the wanted number of cells, in total and per row.
  cell_m_ = std::max({kSmallestCell_m, std::sqrt(size.x() * size.y() / cells), size.maxCoeff() / cells});
  for (const int axis : {0, 1})
    count_[static_cast<std::size_t>(axis)] = static_cast<std::ptrdiff_t>(size(axis) / cell_m_) + 1;

  begin_.assign(static_cast<std::size_t>(count_[0] * count_[1]) + 1, 0);
  for (const auto& footprint : footprints)
    for_each_cell(footprint, [&](std::size_t cell) { ++begin_[cell + 1]; });
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  shapes_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t k = 0; k < footprints.size(); ++k)
    for_each_cell(footprints[k], [&](std::size_t cell) { shapes_[next[cell]++] = k; });
}

std::ptrdiff_t FloorGrid::cell_of(double coordinate_m, int axis) const {
  const double cell = std::floor((coordinate_m - bounds_.min()(axis)) / cell_m_);
  return std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(cell), 0,
                                    count_[static_cast<std::size_t>(axis)] - 1);
}

template <class Visit>
void FloorGrid::for_each_cell(const Eigen::AlignedBox2d& rectangle, const Visit& visit) const {
  // Slightly enlarged: a ray that hits a shape on the line between two cells may traverse either.
  const Eigen::Vector2d low = rectangle.min().array() - kMargin_m, high = rectangle.max().array() + kMargin_m;
  for (std::ptrdiff_t row = cell_of(low.y(), 1); row <= cell_of(high.y(), 1); ++row)
    for (std::ptrdiff_t column = cell_of(low.x(), 0); column <= cell_of(high.x(), 0); ++column)
      visit(index_of({column, row}));
}

FloorGrid::Walk::Walk(const FloorGrid& grid, const Eigen::Vector2d& origin, const Eigen::Vector2d& direction,
                      double most)
    : grid_(grid), end_(most) {
  if (grid.bounds_.isEmpty()) return;
  double begin = 0;
  for (const int axis : {0, 1}) {
    const double low = grid.bounds_.min()(axis) - origin(axis),
                 high = grid.bounds_.max()(axis) - origin(axis);
    if (direction(axis) == 0 && (low > 0 || high < 0)) return;
    if (direction(axis) == 0) continue;
    const double a = low / direction(axis), b = high / direction(axis);
    begin = std::max(begin, std::min(a, b));
    end_ = std::min(end_, std::max(a, b));
  }
  over_ = begin > end_;
  for (const int axis : {0, 1}) {
    const auto k = static_cast<std::size_t>(axis);
    cell_[k] = grid.cell_of(origin(axis) + begin * direction(axis), axis);
    step_[k] = direction(axis) > 0 ? 1 : -1;
    spacing_[k] = direction(axis) == 0 ? 0 : grid.cell_m_ / std::abs(direction(axis));
    const double border = grid.bounds_.min()(axis) +
                          grid.cell_m_ * static_cast<double>(cell_[k] + (direction(axis) > 0 ? 1 : 0));
    next_[k] = direction(axis) == 0 ? std::numeric_limits<double>::infinity()
                                    : (border - origin(axis)) / direction(axis);
  }
}

std::span<const std::uint32_t> FloorGrid::Walk::shapes() const {
  const std::size_t cell = grid_.index_of(cell_);
  return {grid_.shapes_.data() + grid_.begin_[cell], grid_.shapes_.data() + grid_.begin_[cell + 1]};
}

void FloorGrid::Walk::go_on() {
  const std::size_t axis = next_[0] < next_[1] ? 0 : 1;
  over_ = next_[axis] > end_;
  cell_[axis] += step_[axis];
  next_[axis] += spacing_[axis];
  over_ = over_ || cell_[axis] < 0 || cell_[axis] >= grid_.count_[axis];
}

RayWorld::RayWorld(WorldShapes shapes) : shapes_(std::move(shapes)), grid_(footprints_of(shapes_)) {}

std::optional<RayHit> RayWorld::cast(const Ray& ray, double max_m) const {
  std::optional<RayHit> nearest = cast_at_ground(ray, max_m);
  const auto keep_nearer = [&](std::optional<RayHit> hit) {
    if (hit && hit->range_m <= (nearest ? nearest->range_m : max_m)) nearest = hit;
  };
  keep_nearer(cast_at_ceiling(ray, max_m));
  FloorGrid::Walk walk(grid_, ray.origin.head<2>(), ray.direction.head<2>(),
                       nearest ? nearest->range_m : max_m);
  for (; !walk.over(); walk.go_on()) {
    for (const std::uint32_t shape : walk.shapes()) keep_nearer(cast_at_shape(ray, shape));
    if (nearest && nearest->range_m <= walk.leaves()) break;
  }
  return nearest;
}

std::optional<RayHit> RayWorld::cast_at_ground(const Ray& ray, double max_m) const {
  const auto cast = [&](const auto& ground) -> std::optional<RayHit> {
    const auto range_m = ground.ray_m(ray.origin, ray.direction, max_m);
    if (!range_m) return std::nullopt;
    const Eigen::Vector2d slope = ground.gradient((ray.origin + *range_m * ray.direction).template head<2>());
    return RayHit{*range_m, Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized()};
  };
  return std::visit(cast, shapes_.ground);
}

std::optional<RayHit> RayWorld::cast_at_ceiling(const Ray& ray, double max_m) const {
  if (!shapes_.ceiling_m || ray.direction.z() <= 0) return std::nullopt;
  const double range_m = (*shapes_.ceiling_m - ray.origin.z()) / ray.direction.z();
  if (range_m <= 0 || range_m > max_m) return std::nullopt;
  return RayHit{range_m, -Eigen::Vector3d::UnitZ()};
}

std::optional<RayHit> RayWorld::cast_at_shape(const Ray& ray, std::size_t shape) const {
  const std::size_t boxes = shapes_.boxes.size();
  return shape < boxes ? ray_hit(ray, shapes_.boxes[shape]) : ray_hit(ray, shapes_.pillars[shape - boxes]);
}

}  // namespace radioslam
