// Voxel downsampling: the mean of the points in every cell of a regular grid, or the first surfel in it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

/// Means in the order of each cell's first point. Cost: one hash access per point.
std::vector<Eigen::Vector3f> voxel_downsample(const std::vector<Eigen::Vector3f>& points, double cell_m);

/// Mean points with their mean times; no times if the input has none.
struct DownsampledPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<float> times_s;
};
DownsampledPoints voxel_downsample(const std::vector<Eigen::Vector3f>& points,
                                   const std::vector<float>& times_s, double cell_m);

/// The first surfel in every cell, in input order.
std::vector<Surfel> voxel_first(const std::vector<Surfel>& surfels, double cell_m);

}  // namespace radioslam
