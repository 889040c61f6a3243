// Segment of one robot's path around a fingerprint: the odometry position of each of its fingerprints in the
// body frame at the middle one. Odometry errors, decimetres over tens of metres, are neglected.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/radio/fingerprints/measurements.hpp"

namespace radioslam {

struct SequenceWindow {
  std::vector<std::size_t> nodes;  ///< RadioMeasurements::nodes, in time order
  Eigen::Matrix2Xd position_m;     ///< a column per node, in the body frame at the middle one, from above
};

/// The fingerprints of the same robot within `half_path_m` of node `middle` along its path.
SequenceWindow window_around(const RadioMeasurements& radio, std::size_t middle, double half_path_m);

/// Path length between two fingerprints of one robot; infinite between robots.
double path_between_m(const RadioMeasurements& radio, std::size_t a, std::size_t b);

/// Similarity of two fingerprints of the team.
double similarity_of(const RadioMeasurements& radio, std::size_t a, std::size_t b);

}  // namespace radioslam
