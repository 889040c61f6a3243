// Holds the radio links and position fixes of a team against its dead reckoning: what does not fit is
// explained by the likeliest correction, by a wrong start, or by a stated noise that is not the measured one.
#pragma once

#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

std::vector<Finding> check_links(const Mission& mission);

}  // namespace radioslam
