// Reproduction of the hardware test of Wi-Closure (Wang et al., table II and section V-B): two robots in a
// hall of identical pillars recognise each other's places by their scans, without radio, with radio, and with
// radio that prunes the pairs of keyframes that are compared.
//
// The hall, its scans and its radio are simulated (sim/scenarios/hall.hpp), without drawn matches. Place
// recognition runs with the defaults and with DiSCo-SLAM's parameters (table 4.1 of the thesis).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/joint/places/place_recognition.hpp"
#include "radioslam/sim/scenarios/hall.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/wi_closure_hall/hall_truth.hpp"

namespace radioslam {

/// The test's hall: scanned by 16 beams, no matches.
HallParams scanned_hall();

/// Parameters of place recognition.
enum class PlaceSettings {
  kDefaults,
  kDisco,          ///< DiSCo-SLAM's original ones, which the thesis uses in the hall
  kLoosenedDisco,  ///< those that the thesis loosens for its test on KITTI 08
};
inline constexpr std::array<PlaceSettings, 3> kAllPlaceSettings{
    PlaceSettings::kDefaults, PlaceSettings::kDisco, PlaceSettings::kLoosenedDisco};

PlaceParams place_params(PlaceSettings settings, double lidar_range_m);
const char* word_for(PlaceSettings settings);

/// Figures of one run.
struct HallRun {
  PlaceCounts places;
  PlaceClosures closures;
  bool in_one_frame = false;    ///< all robots
  std::optional<double> ate_m;  ///< RMSE of the team; nothing if it is not in one frame
  double scans_s = 0;           ///< odometry and loops of each robot
  double overlap_s = 0;         ///< pruning, with its covariances, and the search for pairs to list
  double places_s = 0;          ///< descriptors and registrations
  double total_s = 0;
};

struct HallRuns {
  HallRun without_radio;  ///< neither ranges nor angles
  HallRun unpruned, pruned;
};

/// The results of one seed.
struct WiClosureHall {
  std::uint64_t seed = 1;
  HallParams scenario;
  EvaluatedRun search;  ///< the overlap search alone, with the smallest shared view of place recognition
  std::array<HallRuns, kAllPlaceSettings.size()> runs;  ///< in the order of kAllPlaceSettings
  std::vector<AnglePaths> angles;                       ///< of the pruned run with the defaults
};

/// Runs on one simulated hall, whose scans are held in memory meanwhile (0.4 GB). Cost: some minutes.
WiClosureHall reproduce_wi_closure_hall(const HallParams& scenario, std::uint64_t seed,
                                        const Progress& progress = {});

}  // namespace radioslam
