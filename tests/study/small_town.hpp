// A town small enough for a test.
#pragma once

#include "radioslam/sim/scenarios/city.hpp"

namespace radioslam {

inline CityParams small_town() {
  CityParams town;
  town.path_length_m = 300;
  town.streets.blocks_x = town.streets.blocks_y = 2;
  town.min_contact_s = 5;
  town.radio.links = 12;
  return town;
}

}  // namespace radioslam
