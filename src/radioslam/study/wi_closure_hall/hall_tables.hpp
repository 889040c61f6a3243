// Tables of the hall test: published rows next to the reproduced ones, and the paths of every angle.
#pragma once

#include <vector>

#include "radioslam/study/study_table.hpp"
#include "radioslam/study/wi_closure_hall/wi_closure_hall.hpp"

namespace radioslam {

/// Medians over at least one seed. Rows that depend on the parameters of place recognition begin with their
/// name (word_for).
StudyTable wi_closure_hall_table(const std::vector<WiClosureHall>& halls);

/// Sums over the angles of all halls.
struct AngleCounts {
  std::size_t angles = 0;
  std::size_t with_direct = 0;
  std::size_t direct_found = 0;  ///< accepted, and the direct path is the likeliest
  std::size_t paths = 0;
};
AngleCounts count_angles(const std::vector<WiClosureHall>& halls);

/// A row per angle measurement.
StudyTable hall_angles_table(const std::vector<WiClosureHall>& halls);

}  // namespace radioslam
