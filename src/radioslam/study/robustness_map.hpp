// Where the alignment breaks: the team's error against the oracle's, and the recall of the overlap search,
// over the noise of angles, the number of links and the number of false paths per angle measurement.
// Wi-Closure names the map as future work.
//
// Each cell is a few simulated towns (sim/city.hpp); a cell's seeds are those of every other cell, so that
// neighbours differ by what their axes say and not by the towns. A run has failed when its error exceeds
// both kFailedRatio times the oracle's and the oracle's plus kFailedExcess_m; it was confidently wrong when
// it failed, gave its team at least kConfidentWeight, and no alternative was right either.
// Cost: a simulation, a run and an oracle per cell and seed; 0.3 to 1 s each.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/sim/city.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

inline constexpr double kFailedRatio = 2;
inline constexpr double kFailedExcess_m = 1;
inline constexpr double kConfidentWeight = 0.9;

/// The axes of the map.
struct RobustnessGrid {
  std::vector<double> sigma_angle_deg{2, 5, 10, 20, 40};
  std::vector<int> links{3, 5, 10, 20, 40};
  std::vector<int> false_paths{0, 2, 5, 10};
};

/// A town small enough for a map of hundreds of them; the LiDAR's range is that of `city`.
CityParams robustness_town();

/// One simulated town, judged.
struct RobustnessSample {
  std::optional<double> ate_m, best_ate_m, ate_oracle_m;
  std::optional<double> recall, false_rejected;
  double weight = 1;

  std::optional<double> ratio() const;  ///< of the likeliest team's error to the oracle's
  bool failed() const;
  bool confidently_wrong() const;
};

struct RobustnessCell {
  double sigma_angle_deg = 0;
  int links = 0, false_paths = 0;
  std::vector<RobustnessSample> samples;  ///< by seed
};

struct RobustnessMap {
  RobustnessGrid grid;
  std::uint64_t first_seed = 1;
  int seeds = 0;
  std::vector<RobustnessCell> cells;  ///< false paths, then links, then noise, the last one fastest
};

/// The same for any number of threads. `progress` is called from one thread at a time.
RobustnessMap map_robustness(const RobustnessGrid& grid, const CityParams& town, std::uint64_t first_seed,
                             int seeds, const Progress& progress = {});

/// A row per cell: medians and the worst, and the shares that failed.
StudyTable robustness_table(const RobustnessMap& map);

}  // namespace radioslam
