// Place recognition between the robots of a simulated mission in three ways: without radio, with radio but
// all pairs of keyframes compared, and with radio that prunes them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"
#include "radioslam/study/evaluated_run.hpp"
#include "radioslam/study/wi_closure/angle_paths.hpp"
#include "radioslam/study/wi_closure/place_settings.hpp"
#include "radioslam/study/wi_closure/place_truth.hpp"

namespace radioslam {

/// A robot's true and estimated positions, in metres, in the frame of the truth.
struct RobotPath {
  std::string robot;
  std::vector<Eigen::Vector2d> truth, estimate;
};

/// Figures of one run.
struct PlaceRun {
  PlaceCounts places;
  PlaceClosures closures;
  bool in_one_frame = false;     ///< all robots
  std::optional<double> ate_m;   ///< RMSE of the team; nothing if it is not in one frame
  std::vector<RobotPath> paths;  ///< aligned as a team, or each by itself where they are in several frames
  double scans_s = 0;            ///< the stage of each robot's own scans
  double overlap_s = 0;          ///< pruning, with its covariances, and the search for pairs to list
  double places_s = 0;           ///< descriptors and registrations
  double total_s = 0;

  /// Of all other stages.
  double rest_s() const { return total_s - scans_s - overlap_s - places_s; }
};

struct PlaceRuns {
  PlaceSettings settings = PlaceSettings::kDefaults;
  PlaceRun without_radio;  ///< neither ranges nor angles
  PlaceRun unpruned, pruned;
};

/// The results of one seed.
struct PlaceStudy {
  std::uint64_t seed = 1;
  EvaluatedRun search;  ///< the overlap search alone, with the smallest shared view of place recognition
  /// The same for pairs within this distance, those that most probably are.
  double radius_m = 0;
  std::optional<EvaluatedRun> within_radius = {};
  std::vector<PlaceRuns> runs;     ///< one for each of the settings
  std::vector<AnglePaths> angles;  ///< of the pruned run with the first settings
};

/// Runs with `params`, but place recognition and consistency by each of `settings`, at least one. All scans
/// are cast before the runs and held in memory, so that no run's seconds contain the simulator's. `radius_m`:
/// another criterion of true pairs; 0: none.
PlaceStudy study_places(Simulation simulation, std::uint64_t seed, const std::vector<PlaceSettings>& settings,
                        const RunParams& params, double radius_m = 0, const Progress& progress = {});

}  // namespace radioslam
