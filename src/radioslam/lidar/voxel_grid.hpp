// Thins a cloud: the mean of the points in every cell of a regular grid.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/lidar/surfel.hpp"

namespace radioslam {

/// In the order in which the cells are first met. Cost: one hash access per point.
std::vector<Eigen::Vector3f> thin_by_voxels(const std::vector<Eigen::Vector3f>& points, double cell_m);

/// Likewise with the means of the points' times, if there are any.
struct ThinnedPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> times_s;
};
ThinnedPoints thin_by_voxels(const std::vector<Eigen::Vector3f>& points, const std::vector<float>& times_s,
                             double cell_m);

/// The first surfel in every cell, in their order.
std::vector<Surfel> first_per_voxel(const std::vector<Surfel>& surfels, double cell_m);

}  // namespace radioslam
