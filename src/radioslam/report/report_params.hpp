// Limits on what the report page draws. The page states what is left out; its numbers do not depend on the
// limits.
#pragma once

#include "radioslam/base/fields.hpp"

namespace radioslam {

struct ReportParams {
  int max_poses = 200000;
  int max_closures = 20000;  ///< distributed over kinds and statuses in proportion
  int max_matrices = 12;
  int max_candidate_cells = 60000;
  int max_alternative_poses = 20000;
  int max_samples = 8000;
  int max_errors = 60000;
  int max_aoa_measurements = 60;
  int max_profile_values = 180;
  int max_access_points = 1000;
  int max_signal_values = 20000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"max_poses", "", 100, 1e7,
                "largest number of poses drawn per layer of the map, over all robots"},
          self.max_poses);
    visit(Field{"max_closures", "", 100, 1e7, "largest number of closures drawn on the map"},
          self.max_closures);
    visit(Field{"max_matrices", "", 1, 1000,
                "largest number of robot pairs whose kept keyframe pairs are drawn, most pairs first"},
          self.max_matrices);
    visit(Field{"max_candidate_cells", "", 100, 1e7,
                "largest number of bins of the matrices of kept pairs, over all robot pairs"},
          self.max_candidate_cells);
    visit(Field{"max_alternative_poses", "", 100, 1e7,
                "largest number of poses drawn of the other hypotheses, over all of them"},
          self.max_alternative_poses);
    visit(Field{"max_samples", "", 100, 1e7, "largest number of samples drawn of distance over similarity"},
          self.max_samples);
    visit(Field{"max_errors", "", 100, 1e7,
                "largest number of errors drawn over time, for estimate and odometry each"},
          self.max_errors);
    visit(Field{"max_aoa_measurements", "", 2, 1e5,
                "largest number of measured directions drawn with their profiles"},
          self.max_aoa_measurements);
    visit(Field{"max_profile_values", "", 36, 3600, "largest number of values drawn per profile"},
          self.max_profile_values);
    visit(Field{"max_access_points", "", 1, 1e6, "largest number of access points on the map"},
          self.max_access_points);
    visit(Field{"max_signal_values", "", 100, 1e7,
                "largest number of values of signal strength and similarity drawn over time"},
          self.max_signal_values);
  }
};

}  // namespace radioslam
