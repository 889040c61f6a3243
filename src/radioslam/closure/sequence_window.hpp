// A stretch of one robot's way around a fingerprint: where each fingerprint of it was, by odometry, in the
// body frame at the middle one. Over tens of metres odometry errs by decimetres, which is left out here.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "radioslam/radio/measurements.hpp"

namespace radioslam {

struct SequenceWindow {
  std::vector<std::size_t> nodes;  ///< RadioMeasurements::nodes, in time order
  Eigen::Matrix2Xd place_m;        ///< a column per node, in the body frame at the middle one, from above
};

/// The fingerprints of the same robot within `half_way_m` of node `middle` along the way.
SequenceWindow window_around(const RadioMeasurements& radio, std::size_t middle, double half_way_m);

/// Distance walked between two fingerprints of one robot; infinite between robots.
double way_between_m(const RadioMeasurements& radio, std::size_t a, std::size_t b);

/// Similarity of two fingerprints of the team.
double similarity_of(const RadioMeasurements& radio, std::size_t a, std::size_t b);

}  // namespace radioslam
