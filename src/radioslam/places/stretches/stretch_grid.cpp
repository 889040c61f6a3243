#include "radioslam/places/stretches/stretch_grid.hpp"

#include <algorithm>
#include <cmath>

namespace radioslam {
namespace {

constexpr int kMargin = 1 << StretchGrid::kLevels;  // cells around what was seen
constexpr int kPassesPerHit = 8;
constexpr int kSpread = 2;     // cells
constexpr int kBeforeHit = 2;  // cells before a point that its ray does not count in
constexpr std::uint16_t kMost = 60000;

/// Points and rays counted in a grid.
struct Counts {
  Eigen::Vector2i corner;
  int width, height;
  std::vector<std::uint16_t> hits, passes;

  Counts(const Eigen::Vector2i& least, const Eigen::Vector2i& most)
      : corner(least.array() - kMargin),
        width(most.x() - least.x() + 1 + 2 * kMargin),
        height(most.y() - least.y() + 1 + 2 * kMargin),
        hits(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)),
        passes(hits.size()) {}

  std::size_t at(const Eigen::Vector2i& cell) const {
    return static_cast<std::size_t>(cell.x() - corner.x()) * static_cast<std::size_t>(height) +
           static_cast<std::size_t>(cell.y() - corner.y());
  }

  void add_ray(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool ends_there) {
    const double length = (to - from).norm() / StretchGrid::kCell_m;
    const Eigen::Vector2d step = (to - from) / std::max(1.0, std::ceil(length));
    const int steps = static_cast<int>(std::ceil(length)) - (ends_there ? kBeforeHit : 0);
    for (int k = 0; k < steps; ++k) {
      std::uint16_t& passed = passes[at(StretchGrid::cell_of(from + k * step))];
      passed = std::min(kMost, static_cast<std::uint16_t>(passed + 1));
    }
    if (!ends_there) return;
    std::uint16_t& hit = hits[at(StretchGrid::cell_of(to))];
    hit = std::min(kMost, static_cast<std::uint16_t>(hit + 1));
  }
};

}  // namespace

StretchGrid::StretchGrid(const std::vector<StretchView>& views, double range_m) {
  struct Ray {
    Eigen::Vector2d from, to;
    bool ends_there;
  };
  std::vector<Ray> rays;
  Eigen::Vector2i least = Eigen::Vector2i::Zero(), most = least;
  for (const StretchView& view : views)
    for (const Eigen::Vector2d& point : view.points) {
      const double range = point.norm();
      const bool is_near = range <= range_m;
      const Ray ray{view.T_stretch_scan.translation(),
                    view.T_stretch_scan * (is_near ? point : Eigen::Vector2d(range_m / range * point)),
                    is_near};
      for (const Eigen::Vector2d& end : {ray.from, ray.to}) {
        least = least.cwiseMin(cell_of(end));
        most = most.cwiseMax(cell_of(end));
      }
      rays.push_back(ray);
    }
  Counts counts(least, most);
  for (const Ray& ray : rays) counts.add_ray(ray.from, ray.to, ray.ends_there);
  corner_ = counts.corner;
  levels_[0] = {counts.width, counts.height, std::vector<std::uint8_t>(counts.hits.size(), kUnseen)};
  std::vector<std::uint8_t>& values = levels_[0].values;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (counts.passes[k] > 0) values[k] = 0;
  constexpr std::array<std::uint8_t, 9> kBySquares{kOccupied, 210, 180, 0, 150, kNear, 0, 0, 0};
  for (int x = kSpread; x < counts.width - kSpread; ++x)
    for (int y = kSpread; y < counts.height - kSpread; ++y) {
      const Eigen::Vector2i cell = corner_ + Eigen::Vector2i(x, y);
      const std::size_t k = counts.at(cell);
      if (counts.hits[k] == 0 || counts.hits[k] * kPassesPerHit < counts.passes[k]) continue;
      occupied_.push_back((cell.cast<double>().array() + 0.5) * kCell_m);
      for (int dx = -kSpread; dx <= kSpread; ++dx)
        for (int dy = -kSpread; dy <= kSpread; ++dy) {
          std::uint8_t& value = values[counts.at(cell + Eigen::Vector2i(dx, dy))];
          value = std::max(value, kBySquares[static_cast<std::size_t>(dx * dx + dy * dy)]);
        }
    }
  for (std::size_t level = 1; level < levels_.size(); ++level) make_coarser(level);
}

void StretchGrid::make_coarser(std::size_t level) {
  const Level& fine = levels_[level - 1];
  Level& coarse = levels_[level];
  coarse.width = (fine.width + 1) / 2;
  coarse.height = (fine.height + 1) / 2;
  coarse.values.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
  for (int x = 0; x < coarse.width; ++x)
    for (int y = 0; y < coarse.height; ++y) {
      std::uint8_t most = 0;
      for (int fx = 2 * x; fx <= 2 * x + 2; ++fx)
        for (int fy = 2 * y; fy <= 2 * y + 2; ++fy) {
          const bool is_inside = fx < fine.width && fy < fine.height;
          most = std::max(
              most, is_inside
                        ? fine.values[static_cast<std::size_t>(fx) * static_cast<std::size_t>(fine.height) +
                                      static_cast<std::size_t>(fy)]
                        : static_cast<std::uint8_t>(kUnseen));
        }
      coarse.values[static_cast<std::size_t>(x) * static_cast<std::size_t>(coarse.height) +
                    static_cast<std::size_t>(y)] = most;
    }
}

int StretchGrid::sum(int level, const std::vector<Eigen::Vector2i>& cells, const Eigen::Vector2i& shift,
                     const std::array<Eigen::Vector2i, 2>& box) const {
  const Level& of = levels_[static_cast<std::size_t>(level)];
  const Eigen::Vector2i by = shift - corner_, least = box[0] + by, most = box[1] + by;
  int sum = 0;
  if (least.minCoeff() < 0 || (most.x() >> level) >= of.width || (most.y() >> level) >= of.height) {
    for (const Eigen::Vector2i& cell : cells) sum += value(level, cell + shift);
    return sum;
  }
  for (const Eigen::Vector2i& cell : cells)
    sum += of.values[static_cast<std::size_t>(((cell.x() + by.x()) >> level) * of.height +
                                              ((cell.y() + by.y()) >> level))];
  return sum;
}

StretchLikeness likeness(const StretchGrid& a, const StretchGrid& b, const SE2& T_a_b) {
  StretchLikeness result;
  const auto add = [&](const StretchGrid& grid, const SE2& T_grid_points, const StretchGrid& of) {
    for (const Eigen::Vector2d& point : of.occupied()) {
      const int value = grid.value(0, StretchGrid::cell_of(T_grid_points * point));
      result.met += value >= StretchGrid::kNear;
      result.against += value == 0;
      result.score += StretchGrid::score(value);
    }
  };
  add(a, T_a_b, b);
  add(b, T_a_b.inverse(), a);
  const double all = static_cast<double>(std::max<std::size_t>(1, a.occupied().size() + b.occupied().size()));
  return {result.met / all, result.against / all, result.score / all};
}

}  // namespace radioslam
