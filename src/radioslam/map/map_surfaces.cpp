#include "radioslam/map/map_surfaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/map/near_voxels.hpp"

namespace radioslam {
namespace {

constexpr double kNormalRadius_voxels = 2.5;
constexpr int kMaxReturns = 30;            // of a neighbour, by which it counts: what stands still has more
constexpr std::size_t kMinNeighbours = 5;  // with the point itself
constexpr double kMaxFlatness = 0.2;       // of the variances across and along a surface
constexpr float kPoolRadius_voxels = 3;
constexpr int kEnoughViews = 4;  // from which a voxel is judged by its own alone
constexpr float kSteps = 127;

Eigen::Vector3f direction_of(const Voxel& voxel) {
  return {static_cast<float>(voxel.direction[0]), static_cast<float>(voxel.direction[1]),
          static_cast<float>(voxel.direction[2])};
}

struct Neighbour {
  Eigen::Vector3d offset;
  double weight = 0;
};

/// The plane through most of a voxel's neighbours, by iteratively reweighted least squares.
struct Surface {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
  bool is_flat = false;

  /// `width_m`: distance from the plane at which a neighbour counts a quarter.
  void fit(const std::vector<Neighbour>& neighbours, double width_m, bool is_planar) {
    double weights = 0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (const auto& [offset, returns] : neighbours) {
      const double distance = normal.dot(offset - centre) / width_m;
      const double weight = returns / ((1 + distance * distance) * (1 + distance * distance));
      weights += weight;
      sum += weight * offset;
      squares += weight * offset * offset.transpose();
    }
    centre = sum / weights;
    Eigen::Matrix3d spread = squares / weights - centre * centre.transpose();
    if (is_planar) {
      spread.row(2).setZero();
      spread.col(2).setZero();
      spread(2, 2) = 1 + spread.trace();
    }
    const auto axes = symmetric_eigen(spread);
    normal = axes.vectors.col(0);
    is_flat = axes.values[0] < kMaxFlatness * axes.values[1];
  }
};

/// Normal of the surface at a voxel; zero if its neighbours, which are relative to it, lie on none, or if it
/// does not lie on theirs.
Eigen::Vector3d normal_from(const std::vector<Neighbour>& neighbours, double voxel_m, bool is_planar) {
  constexpr int kIterations = 3;
  constexpr double kWidth_voxels = 0.5, kMaxOff_voxels = 1;
  Surface surface;
  if (neighbours.size() < kMinNeighbours) return surface.normal;
  for (int k = 0; k < kIterations; ++k) surface.fit(neighbours, kWidth_voxels * voxel_m, is_planar);
  const bool is_on_it = std::abs(surface.normal.dot(surface.centre)) <= kMaxOff_voxels * voxel_m;
  return surface.is_flat && is_on_it ? surface.normal : Eigen::Vector3d(Eigen::Vector3d::Zero());
}

std::array<std::int8_t, 3> stored(const Eigen::Vector3d& normal) {
  std::array<std::int8_t, 3> result{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result[axis] =
        static_cast<std::int8_t>(std::lround(static_cast<double>(kSteps) * normal[static_cast<int>(axis)]));
  return result;
}

void count(std::uint16_t& of, int more) { of = static_cast<std::uint16_t>(std::min(65535, of + more)); }

bool has_enough_views(const Voxel& voxel) { return voxel.hits + voxel.through >= kEnoughViews; }

bool is_seen_through(const Voxel& voxel, const MapParams& params) {
  return voxel.through >= params.min_through &&
         voxel.through >= params.min_through_ratio * (voxel.hits + voxel.through);
}

/// Whether two voxels are of one surface, by their normals and the way from one to the other. What has no
/// normal belongs to nothing that has one.
bool is_one_surface(const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& from_a_to_b,
                    float voxel_m) {
  constexpr float kMinCosine = 0.95F;
  if (a.isZero() || b.isZero()) return a.isZero() && b.isZero();
  return std::abs(a.dot(b)) >= kMinCosine && std::abs(a.dot(from_a_to_b)) <= voxel_m;
}

/// Whether more rays would not change what these say.
bool is_settled(const Voxel& voxel) {
  constexpr int kEnough = 8, kMinRatio = 8;
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

/// Gives voxels with too few views those of their surface about them, of which each voxel has as many as are
/// enough at most.
void take_views_of_surface(VoxelMap& map, std::span<const VoxelMap::Tile> tiles) {
  struct Taken {
    std::size_t voxel = 0;
    double hits = 0, through = 0;
  };
  const auto voxel_m = static_cast<float>(map.voxel_m());
  const std::span<Voxel> voxels = map.voxels();
  std::vector<std::vector<Taken>> of_tile(tiles.size());
  for_each_tile(tiles, [&](std::size_t t) {
    std::optional<NearVoxels> near;
    for (std::size_t k = tiles[t].begin; k < tiles[t].end; ++k) {
      if (has_enough_views(voxels[k])) continue;
      if (!near) near.emplace(map, tiles, t, kPoolRadius_voxels * voxel_m);
      Taken taken{k};
      const Eigen::Vector3f normal = normal_of(voxels[k]);
      near->for_each(k, [&](std::size_t other, const Eigen::Vector3f& offset) {
        const Voxel& of = voxels[other];
        if (!is_one_surface(normal, normal_of(of), offset, voxel_m)) return;
        const double share = kEnoughViews / std::max<double>(kEnoughViews, of.hits + of.through);
        taken.hits += share * of.hits;
        taken.through += share * of.through;
      });
      if (taken.hits + taken.through >= kEnoughViews) of_tile[t].push_back(taken);
    }
  });
  for (const auto& tile : of_tile)
    for (const Taken& taken : tile) {
      Voxel& voxel = voxels[taken.voxel];
      voxel.hits = voxel.through = 0;
      count(voxel.hits, static_cast<int>(std::lround(taken.hits)));
      count(voxel.through, static_cast<int>(std::lround(taken.through)));
    }
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
    std::vector<Neighbour> neighbours;
    for (std::size_t k = tiles[t].begin; k < tiles[t].end; ++k) {
      neighbours.clear();
      near.for_each(k, [&](std::size_t other, const Eigen::Vector3f& offset) {
        const int returns = std::min<int>(kMaxReturns, map.voxels()[other].returns);
        neighbours.push_back({offset.cast<double>(), static_cast<double>(returns)});
      });
      Voxel& voxel = map.voxels()[k];
      Eigen::Vector3d normal = normal_from(neighbours, map.voxel_m(), is_planar[VoxelMap::robot_of(voxel)]);
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
        if (votes.hits + votes.through > 0) count(votes.through > votes.hits ? voxel.through : voxel.hits, 1);
      }
    }
  });
}

std::size_t leave_out_seen_through(VoxelMap& map, std::span<const VoxelMap::Tile> tiles,
                                   const MapParams& params) {
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) take_views_of_surface(map, tiles);
  std::size_t left_out = 0;
  for (Voxel& voxel : map.voxels()) {
    voxel.is_left_out = is_seen_through(voxel, params);
    left_out += voxel.is_left_out ? 1 : 0;
  }
  return left_out;
}

}  // namespace radioslam
