#include "radioslam/study/wi_closure_hall/hall_tables.hpp"

#include <functional>
#include <string>
#include <utility>

#include "radioslam/study/wi_closure_hall/published_hall.hpp"

namespace radioslam {
namespace {

using Halls = std::vector<WiClosureHall>;
using OfHall = std::function<std::optional<double>(const WiClosureHall&)>;
using OfHallRun = std::function<std::optional<double>(const HallRun&)>;

std::optional<double> median_over(const Halls& halls, const OfHall& value) {
  std::vector<double> values;
  for (const WiClosureHall& hall : halls)
    if (const auto v = value(hall)) values.push_back(*v);
  return median_of(std::move(values));
}

double to_number(std::size_t count) { return static_cast<double>(count); }

/// The published cells of a row: the baseline's, and that with Wi-Closure.
struct PublishedCells {
  std::string baseline = number_text(std::nullopt, 0), pruned = number_text(std::nullopt, 0);
};

/// Rows that depend on the parameters of place recognition, with one cell per mission and pruning.
class HallRunRows {
 public:
  HallRunRows(const Halls& halls, std::size_t settings, std::vector<StudyRow>& rows)
      : halls_(halls), settings_(settings), rows_(rows) {}

  void add(const std::string& label, PublishedCells published, int decimals, const OfHallRun& value) {
    add_texts(label, std::move(published), [&](HallRun HallRuns::*run) {
      return number_text(
          median_over(halls_, [&](const WiClosureHall& hall) { return value(hall.runs[settings_].*run); }),
          decimals);
    });
  }

  void add_count(const std::string& label, PublishedCells published, std::size_t PlaceCounts::*count) {
    add(label, std::move(published), 0, [count](const HallRun& run) { return to_number(run.places.*count); });
  }

  void add_halls_in_one_frame() {
    add_texts("halls with both robots in one frame", {}, [&](HallRun HallRuns::*run) {
      std::size_t count = 0;
      for (const WiClosureHall& hall : halls_) count += (hall.runs[settings_].*run).in_one_frame ? 1U : 0U;
      return std::to_string(count) + " of " + std::to_string(halls_.size());
    });
  }

 private:
  template <class Text>
  void add_texts(const std::string& label, PublishedCells published, const Text& text) {
    const PlaceSettings settings = kAllPlaceSettings[settings_];
    if (settings == PlaceSettings::kLoosenedDisco) published = {};  // the thesis ran the hall without them
    rows_.push_back({word_for(settings) + (": " + label),
                     {std::move(published.baseline), std::move(published.pruned),
                      text(&HallRuns::without_radio), text(&HallRuns::unpruned), text(&HallRuns::pruned)}});
  }

  const Halls& halls_;
  std::size_t settings_;
  std::vector<StudyRow>& rows_;
};

/// The search for pairs, before any scan is compared.
void add_search_rows(const Halls& halls, std::vector<StudyRow>& rows) {
  using namespace published_wi_closure_hall;
  const std::string nothing = number_text(std::nullopt, 0), pairs = number_text(kPairs, 0);
  const auto of_search = [&](std::size_t PairCounts::*count) {
    return number_text(
        median_over(halls,
                    [&](const WiClosureHall& hall) { return to_number(hall.search.candidates.*count); }),
        0);
  };
  const auto share = [&](std::optional<double> (*of)(const PairCounts&)) {
    return percent_text(median_over(halls, [&](const auto& hall) { return of(hall.search.candidates); }), 1);
  };
  const std::string all = of_search(&PairCounts::pairs), true_ones = of_search(&PairCounts::true_pairs);
  rows.push_back({"pairs of keyframes", {pairs, pairs, all, all, all}});
  rows.push_back({"true pairs, with 18 % of their views in common",
                  {nothing, nothing, true_ones, true_ones, true_ones}});
  rows.push_back({"kept", {nothing, number_text(kKept, 0), nothing, nothing, of_search(&PairCounts::kept)}});
  rows.push_back({"true kept",
                  {nothing, number_text(kTrueKept, 0), nothing, nothing, of_search(&PairCounts::true_kept)}});
  rows.push_back({"recall", {nothing, percent_text(kRecall, 0) + " [1]", nothing, nothing, share(recall)}});
  rows.push_back(
      {"false pairs rejected",
       {nothing, percent_text(kFalseRejected, 1) + " [1]", nothing, nothing, share(rejected_false)}});
}

void add_place_rows(HallRunRows& rows) {
  using namespace published_wi_closure_hall;
  const std::string all = number_text(kPairs, 0);
  rows.add_count("pairs of keyframes with scans", {all, all}, &PlaceCounts::pairs);
  rows.add_count("allowed [2]", {all, number_text(kKept, 0)}, &PlaceCounts::allowed);
  rows.add_count("descriptors compared", {}, &PlaceCounts::compared);
  rows.add_count("registrations", {}, &PlaceCounts::registrations);
  rows.add_count("verified", {}, &PlaceCounts::verified);
  rows.add("closures accepted", {}, 0, [](const HallRun& run) { return to_number(run.closures.accepted); });
  rows.add("true accepted", {}, 0, [](const HallRun& run) { return to_number(run.closures.true_accepted); });
}

void add_outcome_rows(HallRunRows& rows) {
  using namespace published_wi_closure_hall;
  rows.add_halls_in_one_frame();
  rows.add("ATE, m", {number_text(kBaselineAte_m, 1), number_text(kAte_m, 1)}, 2,
           [](const HallRun& run) { return run.ate_m; });
  rows.add("odometry of the scans, s", {}, 1, [](const HallRun& run) { return run.scans_s; });
  rows.add("pruning, s", {number_text(std::nullopt, 0), number_text(kSearch_s, 1)}, 3,
           [](const HallRun& run) { return run.overlap_s; });
  rows.add("place recognition, s", {}, 2, [](const HallRun& run) { return run.places_s; });
  rows.add("whole run, s", {number_text(kBaseline_s, 0), number_text(kWithSearch_s, 0)}, 1,
           [](const HallRun& run) { return run.total_s; });
}

std::string halls_lead(const Halls& halls) {
  const HallParams& hall = halls.front().scenario;
  const std::string which = halls.size() == 1
                                ? "Seed " + std::to_string(halls.front().seed)
                                : "Medians of " + std::to_string(halls.size()) + " seeds from " +
                                      std::to_string(halls.front().seed) + " on";
  return which + ". A simulated hall of " + number_text(hall.hall_x_m, 0) + " x " +
         number_text(hall.hall_y_m, 0) + " m with identical pillars; " + std::to_string(hall.robots) +
         " robots drive " + number_text(hall.path_length_m, 0) + " m each, with a LiDAR of " +
         std::to_string(hall.onboard.lidar.lidar_beams) + " beams and " + number_text(hall.lidar_range_m, 0) +
         " m, " + std::to_string(hall.radio.links) + " ranges and as many angles, each with false paths.";
}

std::vector<std::string> notes_on_published() {
  return {
      "[1] 119 pairs kept of 1,848, 115 of them true, are 93.6 % rejected. 15 % of the true ones missed "
      "would make 135 true pairs, and 99.8 % of the false ones rejected; table II of the thesis states 78.7 "
      "%. 1,848 = 42 x 44 is most likely the number of pairs of keyframes; the thesis calls them loop "
      "closures.",
      "Which pairs are true in the hall is not published. Here: views have 18 % of their area in common, as "
      "two scanners of 30 m within 35 m do, the rule of the thesis's test on KITTI 08.",
      "The thesis's ATE ('average trajectory error') is not defined. Here it is the RMSE after one rigid "
      "alignment of the team, of the halls with both robots in one frame. Its times are those of the whole "
      "LiDAR pipeline on another computer.",
      "The thesis's hall, drives, keyframes and recordings are not published: compare what pruning changes, "
      "not the figures themselves."};
}

std::vector<std::string> notes_on_places() {
  return {
      "[2] Of one robot, a keyframe every 2 m (places.stride_m) is compared with those of the other that "
      "pruning leaves; a pair counts once per round (places.rounds; with DiSCo-SLAM's parameters there is "
      "one). Without radio nothing aligns the robots at first, and all pairs are compared by descriptor.",
      "No radio: the same recordings without ranges and angles. No pruning: `run --no-prune`, which also "
      "trusts the closures without weighing them against the radio.",
      "A closure is true within 0.3 m and 3 degrees of the true relative pose.",
      "DiSCo-SLAM: its parameters in the hall (table 4.1): 64 rings, 60 sectors, the range of the LiDAR, 50 "
      "nearest ring keys, descriptors within 0.2, one candidate. Loosened: as the thesis did for KITTI 08, "
      "within 1, ten candidates.",
      "With pruning, pairs are proposed by predicted poses first: the distance of the descriptors then has "
      "no limit, keys are not searched, and one candidate means one team alignment.",
      "Without counterpart are DiSCo-SLAM's icp_threshold 5, a mean squared distance of 5 m^2 after "
      "registration, and its consistent set (PCM) from five matches on, whose threshold of 100, loosened: "
      "20, is on a norm that adds metres to radians. Registrations and consistency are tested here as "
      "everywhere in `run`."};
}

std::string path_number(std::optional<std::size_t> path) {
  return path ? std::to_string(*path + 1) : number_text(std::nullopt, 0);
}

std::string direct_text(const AnglePaths& angle) {
  if (!angle.direct_path) return number_text(std::nullopt, 0);
  return angle.has_direct() ? std::to_string(*angle.direct_path + 1) : "none";
}

std::string outcome_text(const AnglePaths& angle) {
  if (angle.finds_direct()) return "direct";
  if (angle.accepted) return angle.has_direct() ? "another path" : "a false path";
  return angle.has_direct() ? "rejected" : "rejected rightly";
}

StudyRow angle_row(const WiClosureHall& hall, std::size_t k) {
  constexpr int kWeightDecimals = 2;
  const AnglePaths& angle = hall.angles[k];
  const auto likeliest = angle.likeliest();
  const auto weight = likeliest ? std::optional(angle.weights[*likeliest]) : std::nullopt;
  return {"seed " + std::to_string(hall.seed) + ", angle " + std::to_string(k + 1),
          {std::to_string(angle.paths), direct_text(angle), path_number(likeliest),
           number_text(weight, kWeightDecimals), outcome_text(angle)}};
}

}  // namespace

StudyTable wi_closure_hall_table(const std::vector<WiClosureHall>& halls) {
  std::vector<StudyRow> rows;
  add_search_rows(halls, rows);
  for (std::size_t k = 0; k < kAllPlaceSettings.size(); ++k) {
    HallRunRows of_settings(halls, k, rows);
    add_place_rows(of_settings);
    add_outcome_rows(of_settings);
  }
  std::vector<std::string> notes = notes_on_published();
  for (std::string& note : notes_on_places()) notes.push_back(std::move(note));
  return {"Wi-Closure in a hall of identical pillars",
          halls_lead(halls),
          {"thesis: baseline", "Wi-Closure", "no radio", "no pruning", "pruning"},
          std::move(rows),
          std::move(notes)};
}

AngleCounts count_angles(const std::vector<WiClosureHall>& halls) {
  AngleCounts counts;
  for (const WiClosureHall& hall : halls)
    for (const AnglePaths& angle : hall.angles) {
      ++counts.angles;
      counts.with_direct += angle.has_direct() ? 1U : 0U;
      counts.direct_found += angle.finds_direct() ? 1U : 0U;
      counts.paths += angle.paths;
    }
  return counts;
}

StudyTable hall_angles_table(const std::vector<WiClosureHall>& halls) {
  using namespace published_wi_closure_hall;
  const AngleCounts counts = count_angles(halls);
  StudyTable table{"Paths of the angles",
                   std::to_string(counts.direct_found) + " direct of " + std::to_string(counts.with_direct) +
                       " measurements with one, " + std::to_string(counts.paths) + " paths in " +
                       std::to_string(counts.angles) + " measurements in all; the thesis: " +
                       std::to_string(kDirectPaths) + " direct of " + std::to_string(kFalsePaths) +
                       " multipaths, in " + std::to_string(kAngles) + " measurements.",
                   {"paths", "direct path", "likeliest path", "its weight", "outcome"},
                   {},
                   {"Of the pruned runs with the defaults. Paths are numbered from the strongest; the weight "
                    "is the posterior that the path is direct. An angle is rejected if no path is likely "
                    "direct."}};
  for (const WiClosureHall& hall : halls)
    for (std::size_t k = 0; k < hall.angles.size(); ++k) table.rows.push_back(angle_row(hall, k));
  return table;
}

}  // namespace radioslam
