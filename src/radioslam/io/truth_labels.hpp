// What was true of single measurements, as a simulator knows it; for evaluation only.
//
//   radio/direct_paths.csv   t_s,receiver,transmitter,path        path: the direct one's place among the
//                                                                 measurement's paths, from 0; -1: none is
//   match_labels.csv         robot_i,t_i_s,robot_j,t_j_s,label    true or false; of several matches between
//                                                                 the same two stamps each has its row
// Rows that fit no measurement are passed over (the mission's tables may have been thinned out since), and
// measurements without a row have no label.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// Per mission.arrivals. Refuses unknown names and a path that the measurement does not have.
std::vector<std::optional<int>> read_direct_paths(const Text& text, const Mission& mission);
std::string format_direct_paths(const Mission& mission, const std::vector<std::optional<int>>& direct_paths);

/// Per mission.matches. Refuses unknown names and other words than true and false.
std::vector<std::optional<bool>> read_match_labels(const Text& text, const Mission& mission);
std::string format_match_labels(const Mission& mission, const std::vector<std::optional<bool>>& labels);

}  // namespace radioslam
