#include "radioslam/study/wi_closure_hall/hall_tables.hpp"

#include <string>
#include <utility>

#include "radioslam/study/wi_closure/place_table.hpp"
#include "radioslam/study/wi_closure_hall/published_hall.hpp"

namespace radioslam {
namespace {

PublishedPlaces published_places() {
  using namespace published_wi_closure_hall;
  PublishedPlaces published;
  published.pairs = number_text(kPairs, 0);
  published.kept = number_text(kKept, 0);
  published.true_kept = number_text(kTrueKept, 0);
  published.recall = percent_text(kRecall, 0) + " [1]";
  published.false_rejected = percent_text(kFalseRejected, 1) + " [1]";
  published.search_s = number_text(kSearch_s, 1);
  published.ate_m = {number_text(kBaselineAte_m, 1), number_text(kAte_m, 1)};
  published.total_s = {number_text(kBaseline_s, 0), number_text(kWithSearch_s, 0)};
  published.without = PlaceSettings::kLoosenedDisco;
  return published;
}

std::string scene_text(const HallParams& hall) {
  return "A simulated hall of " + number_text(hall.hall_x_m, 0) + " x " + number_text(hall.hall_y_m, 0) +
         " m with identical pillars; " + std::to_string(hall.robots) + " robots drive " +
         number_text(hall.path_length_m, 0) + " m each, with a LiDAR of " +
         std::to_string(hall.onboard.lidar.lidar_beams) + " beams and " + number_text(hall.lidar_range_m, 0) +
         " m, " + std::to_string(hall.radio.links) + " ranges and as many angles, each with false paths.";
}

std::vector<std::string> notes_on_published() {
  return {
      "[1] 119 pairs kept of 1,848, 115 of them true, are 93.6 % rejected. 15 % of the true ones missed "
      "would make 135 true pairs, and 99.8 % of the false ones rejected; table II of the thesis states 78.7 "
      "%. 1,848 = 42 x 44 is most likely the number of pairs of keyframes; the thesis calls them loop "
      "closures.",
      "Which pairs are true in the hall is not published. Here, by two criteria: views have 18 % of their "
      "area "
      "in common, as two scanners of 30 m within 35 m do, the rule of the thesis's test on KITTI 08; and "
      "places "
      "within the distance (--radius) at which 7.3 % of the pairs are true, 135 of 1,848 as in the thesis, "
      "where "
      "pairs are kept that most probably are so near.",
      "The thesis's ATE ('average trajectory error') is not defined. Here it is the RMSE after one rigid "
      "alignment of the team, of the missions with all robots in one frame. Its times are those of the whole "
      "LiDAR pipeline on another computer.",
      "The thesis's hall, drives, keyframes and recordings are not published: compare what pruning changes, "
      "not the figures themselves."};
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
  const AnglePaths& angle = hall.places.angles[k];
  const auto likeliest = angle.likeliest();
  const auto weight = likeliest ? std::optional(angle.weights[*likeliest]) : std::nullopt;
  return {"seed " + std::to_string(hall.places.seed) + ", angle " + std::to_string(k + 1),
          {std::to_string(angle.paths), direct_text(angle), path_number(likeliest),
           number_text(weight, kWeightDecimals), outcome_text(angle)}};
}

}  // namespace

StudyTable wi_closure_hall_table(const std::vector<WiClosureHall>& halls) {
  std::vector<PlaceStudy> seeds;
  for (const WiClosureHall& hall : halls) seeds.push_back(hall.places);
  return place_table(seeds, {"Wi-Closure in a hall of identical pillars", scene_text(halls.front().scenario),
                             "odometry of the scans, s", published_places(), notes_on_published()});
}

AngleCounts count_angles(const std::vector<WiClosureHall>& halls) {
  AngleCounts counts;
  for (const WiClosureHall& hall : halls)
    for (const AnglePaths& angle : hall.places.angles) {
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
    for (std::size_t k = 0; k < hall.places.angles.size(); ++k) table.rows.push_back(angle_row(hall, k));
  return table;
}

}  // namespace radioslam
