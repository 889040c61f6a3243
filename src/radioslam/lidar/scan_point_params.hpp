// Which points of a scan are used: limits of their range and of their time.
#pragma once

#include "radioslam/base/fields.hpp"

namespace radioslam {

struct ScanPointParams {
  double min_range_m = 0.3;
  double max_range_m = 100;
  double max_time_s = 60;  ///< slow scanners sweep for seconds

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(min_range_m, "m", 0, 100,
                          "smallest range of a point; nearer ones are taken for the robot itself");
    RADIOSLAM_BASIC_FIELD(max_range_m, "m", 0.1, 1000, "largest range of a point; farther ones are ignored");
    RADIOSLAM_FIELD(max_time_s, "s", 1e-3, 1e6,
                    "largest time between a point and its scan's stamp; points beyond it are ignored");
  }
};

}  // namespace radioslam
