// Reproduction of the hardware test of Wi-Closure (Wang et al., table II and section V-B): two robots in a
// hall of identical pillars recognise each other's places by their scans, without radio, with radio, and with
// radio that prunes the pairs of keyframes that are compared.
//
// The hall, its scans and its radio are simulated (sim/scenarios/hall.hpp), without drawn matches. Place
// recognition and the consistency test run with the defaults and with DiSCo-SLAM's parameters (table 4.1 of
// the thesis).
#pragma once

#include <cstdint>

#include "radioslam/base/progress.hpp"
#include "radioslam/sim/scenarios/study_scenarios.hpp"
#include "radioslam/study/wi_closure/place_study.hpp"

namespace radioslam {

/// The results of one seed.
struct WiClosureHall {
  HallParams scenario;
  PlaceStudy places;  ///< with the defaults and both sets of DiSCo-SLAM
};

/// Distance within which 7.3 % of the pairs of places in the hall are, 135 of 1,848 as in the thesis: pi r^2
/// over its area, without the walls' share.
inline constexpr double kThesisRadius_m = 3.6;

/// Runs on one simulated hall, whose scans are held in memory meanwhile (0.4 GB). Cost: some minutes.
/// `radius_m`: distance of true pairs, the second criterion.
WiClosureHall reproduce_wi_closure_hall(const HallParams& scenario, std::uint64_t seed, double radius_m,
                                        const Progress& progress = {});

}  // namespace radioslam
