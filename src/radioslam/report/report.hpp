// A run as one self-contained HTML page: data, style, script and d3 in one file that opens without a network.
// The data stand in the page as one JSON element (see page_data.hpp); the same input gives the same bytes.
// Ids, names and reasons are foreign text and reach the page as data only, never as markup.
#pragma once

#include <optional>
#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/eval/metrics.hpp"
#include "radioslam/mission/truth.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// How much a page may draw; what is left out is said on the page, and never changes a number on it.
struct ReportParams {
  int maximum_poses = 200000;             ///< of each of estimate, odometry and truth, over all robots
  int maximum_closures = 20000;           ///< every kind and status keeps its share
  int maximum_matrices = 12;              ///< pairs of robots whose kept pairs are drawn, the fullest ones
  int maximum_candidate_cells = 60000;    ///< bins of the matrices of pairs, over all pairs of robots
  int maximum_alternative_poses = 20000;  ///< over all hypotheses but the likeliest
  int maximum_samples = 8000;             ///< of similarity against distance
  int maximum_errors = 60000;             ///< of each of estimate and odometry, over all robots
  int maximum_arrivals = 60;              ///< measured directions with their profiles, over all links
  int maximum_profile_values = 180;       ///< of one profile, all around
  int maximum_access_points = 1000;       ///< on the map
  int maximum_signal_values = 20000;      ///< of signal strength and similarity over time, over all robots

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"maximum_poses", "", 100, 1e7, "poses drawn per layer of the map"}, self.maximum_poses);
    visit(Field{"maximum_closures", "", 100, 1e7, "closures drawn on the map"}, self.maximum_closures);
    visit(Field{"maximum_matrices", "", 1, 1000, "pairs of robots whose kept pairs are drawn"},
          self.maximum_matrices);
    visit(Field{"maximum_candidate_cells", "", 100, 1e7, "bins of the matrices of pairs that were kept"},
          self.maximum_candidate_cells);
    visit(Field{"maximum_alternative_poses", "", 100, 1e7, "poses drawn of the other hypotheses"},
          self.maximum_alternative_poses);
    visit(Field{"maximum_samples", "", 100, 1e7, "samples drawn of similarity against distance"},
          self.maximum_samples);
    visit(Field{"maximum_errors", "", 100, 1e7, "errors drawn over time"}, self.maximum_errors);
    visit(Field{"maximum_arrivals", "", 2, 1e5, "measured directions drawn with their profiles"},
          self.maximum_arrivals);
    visit(Field{"maximum_profile_values", "", 36, 3600, "values drawn of one such profile"},
          self.maximum_profile_values);
    visit(Field{"maximum_access_points", "", 1, 1e6, "access points on the map"}, self.maximum_access_points);
    visit(Field{"maximum_signal_values", "", 100, 1e7, "values drawn of signal strength over time"},
          self.maximum_signal_values);
  }
};

/// The page. `truth` may be null; with `truth` and `metrics` the map is drawn in the truth's frame (through
/// metrics->T_truth_estimate) and dead reckoning is judged beside the estimate, after an alignment of its
/// own.
std::string render_report(const RunResult& result, const Truth* truth = nullptr,
                          const std::optional<TeamMetrics>& metrics = std::nullopt,
                          const ReportParams& params = {});

}  // namespace radioslam
