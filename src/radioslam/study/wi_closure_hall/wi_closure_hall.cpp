#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

namespace radioslam {

HallParams scanned_hall() {
  constexpr int kBeams = 16;
  HallParams scenario;
  scenario.onboard.lidar.lidar_beams = kBeams;
  scenario.matches.matches_true = scenario.matches.matches_false = 0;
  return scenario;
}

WiClosureHall reproduce_wi_closure_hall(const HallParams& scenario, std::uint64_t seed,
                                        const Progress& progress) {
  return {scenario,
          study_places(simulate_hall(scenario, seed), seed,
                       {PlaceSettings::kDefaults, PlaceSettings::kDisco, PlaceSettings::kLoosenedDisco}, {},
                       progress)};
}

}  // namespace radioslam
