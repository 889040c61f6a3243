// Whether the likeliest path of an angle measurement is the direct one.
//
// By the simulator's label where there is one, else by geometry: a path is direct if it is within 3 sigma + 5
// degrees of the true direction of the transmitter; by azimuth only if it has no elevation.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

enum class AngleTruth {
  kDirectFound,  ///< the likeliest path is direct
  kWrongPath,    ///< another one is
  kNoneDirect,   ///< none is
};

/// Index of the greatest weight, the first of equal ones. Nothing unless every path has a weight; a single
/// path needs none.
std::optional<std::size_t> likeliest_path(const std::vector<double>& weights, std::size_t paths);

/// `direct_path`: the label, as in Truth::direct_paths.
AngleTruth judge_path(std::size_t path, int direct_path);

/// `direction`: of the transmitter, in the receiver's body frame; of any length.
AngleTruth judge_path(std::size_t path, const std::vector<AoaPath>& paths, const Eigen::Vector3d& direction);

}  // namespace radioslam
