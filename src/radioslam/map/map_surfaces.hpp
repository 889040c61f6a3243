// Surfaces of a map: the normals of its points, and which of them are left out since rays go through.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "radioslam/map/map_params.hpp"
#include "radioslam/map/ray_view.hpp"
#include "radioslam/map/voxel_map.hpp"

namespace radioslam {

/// Replaces each voxel's direction to the scanner by its surface's normal on that side, the plane through
/// most of the points within two and a half voxels, each by its returns; zero where they are too few or lie
/// on no plane, or the voxel does not lie on theirs. `is_planar`: per robot; normals of its points are
/// horizontal. Cost: a fixed neighbourhood per voxel.
void estimate_normals(VoxelMap& map, std::span<const VoxelMap::Tile> tiles,
                      const std::vector<bool>& is_planar);

/// The normal of a voxel; zero if unknown.
Eigen::Vector3f normal_of(const Voxel& voxel);

/// Counts the rays of these views that end at voxels, and that go through. Voxels of which enough rays say
/// the same are left alone, so views should come in an order in which any first few are from all of the
/// mission.
void count_rays(VoxelMap& map, std::span<const VoxelMap::Tile> tiles, std::span<const RayView> views,
                const MapParams& params);

/// Marks the voxels of which rays go through a share of at least `min_through_ratio` and at least
/// `min_through`; where too few rays meet a voxel, by those of its surface about it. Returns how many.
std::size_t leave_out_seen_through(VoxelMap& map, std::span<const VoxelMap::Tile> tiles,
                                   const MapParams& params);

}  // namespace radioslam
