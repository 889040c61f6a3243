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
    visit(Field{"min_range_m", "m", 0, 100,
                "smallest range of a point; nearer ones are taken for the robot itself"}
              .basic(),
          self.min_range_m);
    visit(Field{"max_range_m", "m", 0.1, 1000, "largest range of a point; farther ones are ignored"}.basic(),
          self.max_range_m);
    visit(Field{"max_time_s", "s", 1e-3, 1e6,
                "largest time between a point and its scan's stamp; points beyond it are ignored"},
          self.max_time_s);
  }
};

}  // namespace radioslam
