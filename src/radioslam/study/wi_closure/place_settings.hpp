// Parameters of place recognition, and of the consistency of its matches, that studies of Wi-Closure compare:
// the defaults, and those of DiSCo-SLAM (table 4.1 of the thesis).
#pragma once

#include "radioslam/consistency/consistency_params.hpp"
#include "radioslam/joint/places/place_recognition.hpp"

namespace radioslam {

enum class PlaceSettings {
  kDefaults,
  kDisco,          ///< DiSCo-SLAM's original ones, which the thesis uses in the hall
  kLoosenedDisco,  ///< those that the thesis loosens for its test on KITTI 08
};

PlaceParams place_params(PlaceSettings settings, double lidar_range_m);
ConsistencyParams consistency_params(PlaceSettings settings);
const char* word_for(PlaceSettings settings);

}  // namespace radioslam
