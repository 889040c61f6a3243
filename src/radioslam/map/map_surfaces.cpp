#include "radioslam/map/map_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/map/near_voxels.hpp"

namespace radioslam {
namespace {

constexpr double kNormalRadius_voxels = 2.5;
constexpr int kMinNeighbours = 5;     // with the point itself
constexpr double kMaxFlatness = 0.2;  // of the variances across and along a surface
constexpr double kPoolRadius_voxels = 3;
constexpr int kOwnRays = 4;  // from which a voxel is judged by its own rays alone
constexpr float kSteps = 127;

Eigen::Vector3f direction_of(const Voxel& voxel) {
  return {static_cast<float>(voxel.direction[0]), static_cast<float>(voxel.direction[1]),
          static_cast<float>(voxel.direction[2])};
}

/// The normal of points with these moments; zero if they lie on no surface.
Eigen::Vector3d normal_from(const Eigen::Matrix3d& covariance, bool is_planar) {
  Eigen::Matrix3d spread = covariance;
  if (is_planar) {
    spread.row(2).setZero();
    spread.col(2).setZero();
    spread(2, 2) = 1 + covariance.trace();
  }
  const auto axes = symmetric_eigen(spread);
  if (!(axes.values[0] < kMaxFlatness * axes.values[1])) return Eigen::Vector3d::Zero();
  return axes.vectors.col(0);
}

std::array<std::int8_t, 3> stored(const Eigen::Vector3d& normal) {
  std::array<std::int8_t, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] =
        static_cast<std::int8_t>(std::lround(static_cast<double>(kSteps) * normal[static_cast<int>(axis)]));
  return result;
}

void count(std::uint16_t& of, int more) { of = static_cast<std::uint16_t>(std::min(65535, of + more)); }

bool is_seen_through(double hits, double through, const MapParams& params) {
  return through >= params.min_through && through >= params.min_through_ratio * (hits + through);
}

/// Whether more rays would not change what these say.
bool is_settled(const Voxel& voxel) {
  constexpr int kEnough = 16, kMinRatio = 10;
  const int few = std::min(voxel.hits, voxel.through), many = std::max(voxel.hits, voxel.through);
  return many >= kEnough && many >= kMinRatio * few;
}

/// Calls body(tile) for every tile, in parallel.
template <class Body>
void for_each_tile(std::span<const VoxelMap::Tile> tiles, const Body& body) {
  parallel_for(tiles.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) body(t);
  });
}

}  // namespace

Eigen::Vector3f normal_of(const Voxel& voxel) {
  const Eigen::Vector3f normal = direction_of(voxel);
  const float length = normal.norm();
  return length > 0 ? Eigen::Vector3f(normal / length) : Eigen::Vector3f(Eigen::Vector3f::Zero());
}

void estimate_normals(VoxelMap& map, std::span<const VoxelMap::Tile> tiles,
                      const std::vector<bool>& is_planar) {
  const auto radius_m = static_cast<float>(kNormalRadius_voxels * map.voxel_m());
  for_each_tile(tiles, [&](std::size_t t) {
    const NearVoxels near(map, tiles, t, radius_m);
    for (std::size_t k = tiles[t].begin; k < tiles[t].end; ++k) {
      int points = 0;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
      near.for_each(k, [&](std::size_t, const Eigen::Vector3f& offset) {
        const Eigen::Vector3d d = offset.cast<double>();
        ++points;
        sum += d;
        squares += d * d.transpose();
      });
      Voxel& voxel = map.voxels()[k];
      Eigen::Vector3d normal = Eigen::Vector3d::Zero();
      if (points >= kMinNeighbours)
        normal = normal_from(squares / points - sum * sum.transpose() / (points * points),
                             is_planar[VoxelMap::robot_of(voxel)]);
      if (normal.dot(direction_of(voxel).cast<double>()) < 0) normal = -normal;
      voxel.direction = stored(normal);
    }
  });
}

void count_rays(VoxelMap& map, std::span<const VoxelMap::Tile> tiles, std::span<const RayView> views,
                const MapParams& params) {
  const auto radius_m = static_cast<float>(params.through_radius_voxels * map.voxel_m());
  const auto depth_m = static_cast<float>(params.through_depth_m);
  const double width_m = map.tile_width_m();
  for_each_tile(tiles, [&](std::size_t t) {
    const VoxelMap::Tile& tile = tiles[t];
    const Eigen::Vector2d centre = width_m * Eigen::Vector2d(tile.x + 0.5, tile.y + 0.5);
    for (const RayView& view : views) {
      if ((view.scanner().head<2>() - centre).norm() > params.view_range_m + width_m * std::sqrt(0.5))
        continue;
      for (std::size_t k = tile.begin; k < tile.end; ++k) {
        Voxel& voxel = map.voxels()[k];
        if (is_settled(voxel)) continue;
        const auto votes = view.at(map.position(voxel), normal_of(voxel), radius_m, depth_m);
        count(voxel.hits, votes.hits);
        count(voxel.through, votes.through);
      }
    }
  });
}

std::size_t leave_out_seen_through(VoxelMap& map, std::span<const VoxelMap::Tile> tiles,
                                   const MapParams& params) {
  const auto radius_m = static_cast<float>(kPoolRadius_voxels * map.voxel_m());
  for_each_tile(tiles, [&](std::size_t t) {
    const NearVoxels near(map, tiles, t, radius_m);
    for (std::size_t k = tiles[t].begin; k < tiles[t].end; ++k) {
      Voxel& voxel = map.voxels()[k];
      double hits = voxel.hits, through = voxel.through;
      if (hits + through < kOwnRays) {
        hits = through = 0;
        near.for_each(k, [&](std::size_t other, const Eigen::Vector3f&) {
          hits += map.voxels()[other].hits;
          through += map.voxels()[other].through;
        });
      }
      voxel.is_left_out = is_seen_through(hits, through, params);
    }
  });
  return static_cast<std::size_t>(std::count_if(map.voxels().begin(), map.voxels().end(),
                                                [](const Voxel& voxel) { return voxel.is_left_out; }));
}

}  // namespace radioslam
