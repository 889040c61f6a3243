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
    RADIOSLAM_FIELD(max_poses, "", 100, 1e7,
                    "largest number of poses drawn per layer of the map, over all robots");
    RADIOSLAM_FIELD(max_closures, "", 100, 1e7, "largest number of closures drawn on the map");
    RADIOSLAM_FIELD(max_matrices, "", 1, 1000,
                    "largest number of robot pairs whose kept keyframe pairs are drawn, most pairs first");
    RADIOSLAM_FIELD(max_candidate_cells, "", 100, 1e7,
                    "largest number of bins of the matrices of kept pairs, over all robot pairs");
    RADIOSLAM_FIELD(max_alternative_poses, "", 100, 1e7,
                    "largest number of poses drawn of the other hypotheses, over all of them");
    RADIOSLAM_FIELD(max_samples, "", 100, 1e7, "largest number of samples drawn of distance over similarity");
    RADIOSLAM_FIELD(max_errors, "", 100, 1e7,
                    "largest number of errors drawn over time, for estimate and odometry each");
    RADIOSLAM_FIELD(max_aoa_measurements, "", 2, 1e5,
                    "largest number of measured directions drawn with their profiles");
    RADIOSLAM_FIELD(max_profile_values, "", 36, 3600, "largest number of values drawn per profile");
    RADIOSLAM_FIELD(max_access_points, "", 1, 1e6, "largest number of access points on the map");
    RADIOSLAM_FIELD(
        max_signal_values, "", 100, 1e7,
        "largest number of values of signal strength drawn on the map, and of signal strength and "
        "similarity drawn over time");
  }
};

}  // namespace radioslam
