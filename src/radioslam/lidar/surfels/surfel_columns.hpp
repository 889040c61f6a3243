// Surfels that no longer change, in columns along z on a square grid: nearest neighbours without a hash.
//
// Columns are a quarter of the largest search distance wide, wider where most would be empty. They are looked
// into ring by ring around the point's own, each from the point's height up and down, until none can hold a
// surfel closer than the best.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

class SurfelColumns {
 public:
  SurfelColumns(const std::vector<Surfel>& surfels, double max_distance_m);

  /// Largest search distance.
  double max_distance_m() const { return max_distance_m_; }
  const std::vector<Surfel>& surfels() const { return surfels_; }
  std::size_t bytes() const {
    return sizeof(std::uint32_t) * first_.size() +
           (sizeof(Eigen::Vector3f) + sizeof(Surfel)) * surfels_.size();
  }

  /// The nearest surfel closer than the root of `squared_max_distance`, or null; valid as long as this.
  const Surfel* nearest(const Eigen::Vector3f& point, float squared_max_distance) const;

 private:
  struct Best {
    float squared;
    const Surfel* surfel = nullptr;
  };

  void lay_out(const Eigen::Vector2f& least, const Eigen::Vector2f& most);
  std::size_t column_of(const Eigen::Vector3f& point) const;
  void look_into(std::size_t column, const Eigen::Vector3f& point, Best& best) const;

  double max_distance_m_;
  float column_m_;
  Eigen::Vector2f corner_ = Eigen::Vector2f::Zero();
  int columns_x_ = 1, columns_y_ = 1;
  std::vector<std::uint32_t> first_;        ///< of every column's surfels, and the number of all
  std::vector<Eigen::Vector3f> positions_;  ///< of the surfels
  std::vector<Surfel> surfels_;             ///< column by column, each from below
};

}  // namespace radioslam
