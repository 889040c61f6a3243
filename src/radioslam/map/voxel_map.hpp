// Returns of a team gathered in voxels, one mean per voxel and robot, in bounded memory.
//
// A voxel takes 32 bytes and an index of 8 to 16 more. If there would be more than `max_points`, the voxel
// size is doubled and what lies in one of the larger voxels is joined. Positions are kept as the voxel and
// the offset in it, so that they are as exact far from the origin as near it. The voxels' order, and so every
// result, follows from the order of the returns alone. Cost: one random access per return.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace radioslam {

/// A return in the frame of the map.
struct MapReturn {
  Eigen::Vector3d position;
  Eigen::Vector3f to_scanner;  ///< of unit length
  float intensity = 0;
  std::uint32_t time_ms = 0;  ///< since the map's start
  std::uint16_t robot = 0;
};

/// Mean of one robot's returns in a voxel.
struct Voxel {
  std::uint64_t key = 0;  ///< VoxelMap::key_of
  float intensity = 0;
  std::uint32_t time_ms = 0;              ///< of the first return
  std::array<std::uint16_t, 3> offset{};  ///< in the voxel, in 65536ths
  std::uint16_t returns = 0;              ///< at most 65535
  std::uint16_t hits = 0, through = 0;    ///< views whose rays end here, and go through (ray_view.hpp)
  /// To the scanner of the steepest return, which sees floors least grazing; then the normal. In 127ths.
  std::array<std::int8_t, 3> direction{};
  bool is_left_out = false;
};

class VoxelMap {
 public:
  static constexpr std::size_t kMaxRobots = 1024;

  VoxelMap(double voxel_m, std::size_t max_points);

  double voxel_m() const { return voxel_m_; }
  std::span<const Voxel> voxels() const { return voxels_; }
  std::span<Voxel> voxels() { return voxels_; }
  std::size_t beyond() const { return beyond_; }  ///< returns too far from the origin for the voxel size

  void add(std::span<const MapReturn> returns);

  /// Puts the voxels in the order of square tiles of about `tile_m`, by y, then x, then voxel; releases the
  /// index, after which nothing can be added. The tiles are consecutive ranges of voxels().
  struct Tile {
    std::int32_t x = 0, y = 0;  ///< covers [x, x + 1) times the tiles' width, and the same in y
    std::size_t begin = 0, end = 0;
  };
  std::vector<Tile> sort_into_tiles(double tile_m);
  /// Width of the tiles, a multiple of the voxel size.
  double tile_width_m() const { return voxel_m_ * tile_voxels_; }

  Eigen::Vector3d position(const Voxel& voxel) const;
  static std::uint16_t robot_of(const Voxel& voxel) { return static_cast<std::uint16_t>(voxel.key >> 54U); }

 private:
  using Cell = std::array<std::int32_t, 3>;

  void add(const MapReturn& of);
  void fetch_index(const MapReturn& of) const;
  void fetch_voxel(const MapReturn& of) const;
  std::optional<std::uint64_t> key_of(const MapReturn& of) const;
  static std::optional<std::uint64_t> key_of(const Cell& cell, std::uint16_t robot);
  static Cell cell_of(std::uint64_t key);
  std::size_t place_of(std::uint64_t key) const;
  void grow_index(std::size_t places);
  void double_voxels();

  double voxel_m_;
  std::size_t max_points_;
  std::size_t beyond_ = 0;
  std::int32_t tile_voxels_ = 1;
  std::vector<Voxel> voxels_;
  std::vector<std::uint32_t> index_;  ///< hash table of voxels_, open addressing; kEmpty: none
};

}  // namespace radioslam
