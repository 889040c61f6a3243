#include "radioslam/study/wi_closure_kitti/wi_closure_kitti.hpp"

#include <functional>

#include "radioslam/study/oracle.hpp"
#include "radioslam/study/wi_closure/published_wi_closure.hpp"

namespace radioslam {
namespace {

/// The mission with its true matches only.
Mission with_true_matches(const Mission& mission, const Truth& truth) {
  Mission result = mission;
  result.matches.clear();
  for (std::size_t k = 0; k < mission.matches.size(); ++k)
    if (truth.true_matches[k].value_or(false)) result.matches.push_back(mission.matches[k]);
  return result;
}

Mission without_matches(const Mission& mission) {
  Mission result = mission;
  result.matches.clear();
  return result;
}

RunParams in_mode(const char* mode) {
  RunParams params;
  params.overlap.mode = mode;
  return params;
}

using Value = std::function<std::optional<double>(const WiClosureKitti&)>;
using OfMode = std::function<std::optional<double>(const KittiMode&)>;

double as_number(std::size_t count) { return static_cast<double>(count); }

/// Rows of the table, medians over the seeds.
class Rows {
 public:
  explicit Rows(const std::vector<WiClosureKitti>& seeds) : seeds_(seeds) {}

  void add(const char* label, std::string thesis, int decimals, const OfMode& value) {
    rows_.push_back({label,
                     {std::move(thesis), number_text(of(&WiClosureKitti::joint, value), decimals),
                      number_text(of(&WiClosureKitti::link, value), decimals)}});
  }
  void add_ratio(const char* label, std::string thesis, int decimals, const OfMode& value) {
    rows_.push_back({label,
                     {std::move(thesis), percent_text(of(&WiClosureKitti::joint, value), decimals),
                      percent_text(of(&WiClosureKitti::link, value), decimals)}});
  }
  /// A row with the same value in both modes.
  void add_common(const char* label, std::string thesis, const Value& value) {
    const std::string text = number_text(median_over(seeds_, value), 2);
    rows_.push_back({label, {std::move(thesis), text, text}});
  }
  std::vector<StudyRow> take() { return std::move(rows_); }

 private:
  std::optional<double> of(KittiMode WiClosureKitti::*mode, const OfMode& value) const {
    return median_over(seeds_, [&](const WiClosureKitti& seed) { return value(seed.*mode); });
  }

  const std::vector<WiClosureKitti>& seeds_;
  std::vector<StudyRow> rows_;
};

void add_pairs(Rows& rows) {
  using namespace published_wi_closure;
  const auto counted = [](std::size_t PairCounts::*member) {
    return [member](const KittiMode& mode) { return as_number(mode.search.candidates.*member); };
  };
  rows.add("pairs of keyframes", number_text(kPairs, 0), 0, counted(&PairCounts::pairs));
  rows.add("true pairs, within 35 m", number_text(kTruePairs, 0), 0, counted(&PairCounts::true_pairs));
  rows.add("kept", number_text(kKept, 0), 0, counted(&PairCounts::kept));
  rows.add("true kept", number_text(kTrueKept, 0), 0, counted(&PairCounts::true_kept));
  rows.add("true missed", number_text(kTruePairs - kTrueKept, 0) + " [1]", 0, [](const KittiMode& mode) {
    return as_number(mode.search.candidates.true_pairs - mode.search.candidates.true_kept);
  });
  rows.add_ratio("recall", percent_text(kRecall, 1) + " [1]", 2,
                 [](const KittiMode& mode) { return recall(mode.search.candidates); });
  rows.add_ratio("false pairs rejected", percent_text(kFalseRejected, 2), 2,
                 [](const KittiMode& mode) { return rejected_false(mode.search.candidates); });
  rows.add("distances evaluated", number_text(std::nullopt, 0), 0,
           [](const KittiMode& mode) { return mode.search.distances_evaluated; });
}

void add_seconds(Rows& rows) {
  using namespace published_wi_closure;
  rows.add("search, s", number_text(kSearch_s, 0), 3,
           [](const KittiMode& mode) { return mode.search.search_s; });
  rows.add("whole run, s", kWithSearchText + std::string(" [2]"), 2,
           [](const KittiMode& mode) { return mode.aliased.total_s; });
}

void add_errors(Rows& rows) {
  using namespace published_wi_closure;
  rows.add_common("ATE of the matches without radio, m", number_text(kBaselineAte_m, 1) + " [3]",
                  [](const WiClosureKitti& seed) { return seed.without_radio.ate_m; });
  rows.add_common("ATE with radio, without pruning, by least squares, m", number_text(std::nullopt, 0),
                  [](const WiClosureKitti& seed) { return seed.least_squares.ate_m; });
  rows.add_common("ATE with radio, without pruning, m", number_text(std::nullopt, 0),
                  [](const WiClosureKitti& seed) { return seed.unpruned.ate_m; });
  rows.add("ATE with pruning, m", kAteText + std::string(" [4]"), 2,
           [](const KittiMode& mode) { return mode.aliased.ate_m; });
  rows.add_common("ATE with the true matches alone, m", number_text(std::nullopt, 0),
                  [](const WiClosureKitti& seed) { return seed.true_matches.ate_m; });
  rows.add("ATE without matches, m", number_text(std::nullopt, 0), 2,
           [](const KittiMode& mode) { return mode.search.ate_m; });
  rows.add_common("ATE of the oracle without matches, m", number_text(std::nullopt, 0),
                  [](const WiClosureKitti& seed) { return seed.ate_oracle_m; });
}

std::string seeds_lead(const std::vector<WiClosureKitti>& seeds) {
  const KittiParams& drive = seeds.front().scenario;
  return seeds_text(seeds.front().seed, seeds.size()) + ". " + drive_text(drive) + ", " +
         std::to_string(drive.matches.matches_true) + " true and " +
         std::to_string(drive.matches.matches_false) + " aliased matches.";
}

std::vector<std::string> seeds_notes() {
  using namespace published_wi_closure;
  return {
      "[1] " + std::string(kMissedNote),
      ("[2] " + std::string(kTimesNote) +
       " The thesis's times include the whole LiDAR pipeline; the reproduced ones do not, since matches are "
       "given."),
      ("[3] The thesis's baseline is DiSCo-SLAM with loosened thresholds, which has no radio. The reproduced "
       "matches are drawn; without radio the largest group of consistent matches places the robots."),
      ("Without pruning, the largest consistent set, a robust loss and the radio links oppose the false "
       "matches; in the row of least squares, the radio links alone."),
      "[4] " + std::string(kAteNote),
      kDriveNote,
      ("In three dimensions, mode link takes the relative poses at the links from the joint estimate, since "
       "a range and two angles determine a full pose in the plane only."),
      "The oracle is the maximum likelihood estimate with known direct paths, started from the truth."};
}

}  // namespace

std::string drive_text(const KittiParams& drive) {
  return "A drive cut at " + percent_text(drive.cut, 0) + ", " + std::to_string(drive.radio.links) +
         " links of " + number_text(drive.radio.sigma_range_m, 1) + " m and " +
         number_text(drive.radio.sigma_angle_deg, 0) + " degrees with false paths";
}

WiClosureKitti reproduce_wi_closure_kitti(const RecordedDrive& drive, const KittiParams& scenario,
                                          std::uint64_t seed, const Progress& progress) {
  const Simulation simulation = simulate_kitti(scenario, drive, seed);
  const Mission& mission = simulation.mission;
  const Truth& truth = simulation.truth;
  const Mission bare = without_matches(mission);

  constexpr int kEstimates = 9;
  int done = 0;
  const auto next = [&](const Mission& recorded, const RunParams& params, const RunOptions& options) {
    report_progress(progress, "estimates", static_cast<double>(done++) / kEstimates);
    return run_and_evaluate(recorded, truth, params, options);
  };
  RunOptions search, unpruned;
  search.overlap_only = true;
  unpruned.pruning = Pruning::kOff;

  const RunParams joint = in_mode("joint"), link = in_mode("link");
  RunParams least_squares = joint;
  least_squares.matches.robust = false;

  WiClosureKitti result;
  result.seed = seed;
  result.scenario = scenario;
  result.joint = {next(bare, joint, search), next(mission, joint, {})};
  result.link = {next(bare, link, search), next(mission, link, {})};
  result.without_radio = next(without_radio(mission), joint, {});
  result.unpruned = next(mission, joint, unpruned);
  result.least_squares = next(mission, least_squares, unpruned);
  result.true_matches = next(with_true_matches(mission, truth), joint, {});
  report_progress(progress, "estimates", static_cast<double>(done) / kEstimates);
  if (const auto oracle = oracle_estimate(mission, truth, {}, result.joint.search.estimate))
    result.ate_oracle_m = ate_rmse_m(*oracle, truth, mission.dimension);
  return result;
}

StudyTable wi_closure_kitti_table(const std::vector<WiClosureKitti>& seeds) {
  Rows rows(seeds);
  add_pairs(rows);
  add_seconds(rows);
  add_errors(rows);
  return {"Wi-Closure on a recorded drive (KITTI 08)",
          seeds_lead(seeds),
          {"thesis", "joint", "link"},
          rows.take(),
          seeds_notes()};
}

}  // namespace radioslam
