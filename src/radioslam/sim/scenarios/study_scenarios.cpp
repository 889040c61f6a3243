#include "radioslam/sim/scenarios/study_scenarios.hpp"

namespace radioslam {

KittiParams wi_closure_drive() {
  KittiParams scenario;
  scenario.matches.matches_true = 40;
  scenario.matches.matches_false = 120;
  return scenario;
}

KittiParams scanned_drive() {
  constexpr int kBeams = 16, kAzimuths = 600;
  constexpr double kRange_m = 30;
  KittiParams scenario;
  scenario.dimension = 2;
  scenario.lidar.lidar_beams = kBeams;
  scenario.lidar.lidar_azimuth_steps = kAzimuths;
  scenario.lidar_range_m = kRange_m;
  scenario.matches.matches_true = scenario.matches.matches_false = 0;
  return scenario;
}

HallParams scanned_hall() {
  constexpr int kBeams = 16;
  HallParams scenario;
  scenario.onboard.lidar.lidar_beams = kBeams;
  scenario.matches.matches_true = scenario.matches.matches_false = 0;
  return scenario;
}

CityParams robustness_town() {
  CityParams town;
  town.path_length_m = 800;
  town.streets.blocks_x = town.streets.blocks_y = 4;
  return town;
}

}  // namespace radioslam
