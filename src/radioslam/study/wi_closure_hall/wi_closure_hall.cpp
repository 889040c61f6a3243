#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

namespace radioslam {

WiClosureHall reproduce_wi_closure_hall(const HallParams& scenario, std::uint64_t seed,
                                        const Progress& progress) {
  return {scenario,
          study_places(simulate_hall(scenario, seed), seed,
                       {PlaceSettings::kDefaults, PlaceSettings::kDisco, PlaceSettings::kLoosenedDisco}, {},
                       progress)};
}

}  // namespace radioslam
