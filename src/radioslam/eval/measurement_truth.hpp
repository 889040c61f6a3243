// Compares the closures of a run with the truth: whether what was measured agrees with it.
//   match   relative pose within 3 sigma + 0.5 m and 3 sigma + 5 degrees of the true one, sigma being along
//           the direction of the error; by x, y and yaw in the plane. A label of the mission takes
//           precedence.
//   file    relative poses of a factor graph that are not odometry: as matches, with the labels of the file.
//           The k-th closure between two keyframes is the k-th such relative pose of the file.
//   lidar   between robots, by scans: within 0.5 m and 5 degrees of the true relative pose.
//   range   within 3 sigma + 0.5 m of the true distance of the antennas.
//   aoa     by its likeliest path, that of the greatest posterior weight, whatever its other paths are:
//           the accepted path of an accepted angle. Angles measured from CSI as well.
// Closures of other kinds have no measurement in the mission; measurements to anchors are not in
// closures.csv.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Accepted and rejected closures of one kind, and those of either whose measurement is true.
struct ComparedClosures {
  std::size_t accepted = 0, true_accepted = 0, rejected = 0, true_rejected = 0;
  /// Of the accepted angles; they add up to `accepted`, and direct_found is true_accepted.
  std::size_t direct_found = 0, wrong_path = 0, none_direct = 0;
  /// Largest error of an accepted relative pose, where the truth has both its poses.
  std::optional<double> worst_accepted_m = {}, worst_accepted_rad = {};
};
using ClosuresByKind = std::map<ClosureKind, ComparedClosures>;

/// The relative poses of a factor graph that are not odometry, in its order.
struct FileLoops {
  std::vector<PoseMatch> loops;
  std::vector<std::optional<bool>> labels;  ///< per loop, whether it is true; empty if unknown for all
};

/// Per kind of measurement that the run has closures of. Robots of `closures` are indices in the mission,
/// whose measurements they follow in order; `keyframes` are the run's stamps per robot, `measured_aoa` its
/// angles from CSI, `file` the loops of the graph that it was given. Closures that the truth does not cover,
/// and angles of several paths without path weights, are not counted.
ClosuresByKind compare_closures_with_truth(const std::vector<ClosureResult>& closures,
                                           const std::vector<std::vector<Stamp>>& keyframes,
                                           const Mission& mission, const Truth& truth,
                                           const std::vector<MeasuredAoaResult>& measured_aoa = {},
                                           const FileLoops& file = {});

}  // namespace radioslam
