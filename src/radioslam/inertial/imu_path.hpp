// A robot's path between poses that are known, by its IMU.
//
//   rotation   the gyroscope's from one pose to the next; what it misses at the next is spread evenly in time
//   position   the specific force integrated twice, from the velocity with which it ends at the next pose
//
// A bias b of the accelerometer would bend the path by b T^2 / 8, and let the velocity jump by -b T at every
// pose. From the jumps' median it is known: b = median of -R^T (v_after - v_before) / T, in the body frame.
// No rows where samples are missing. Cost: linear in the samples.
#pragma once

#include <vector>

#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {

/// `poses`, whose z is up, with a row more at every sample between any two of them within `first` to `last`.
Trajectory<SE3> with_imu_path(const Trajectory<SE3>& poses, Stamp first, Stamp last,
                              const std::vector<ImuSample>& samples, const ImuNoiseParams& params);

}  // namespace radioslam
