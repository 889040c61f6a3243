#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

namespace radioslam {

WiClosureHall reproduce_wi_closure_hall(const HallParams& scenario, std::uint64_t seed, double radius_m,
                                        const Progress& progress) {
  return {scenario,
          study_places(simulate_hall(scenario, seed), seed,
                       {PlaceSettings::kDefaults, PlaceSettings::kDisco, PlaceSettings::kLoosenedDisco}, {},
                       radius_m, progress)};
}

}  // namespace radioslam
