// Reads and writes true labels of single measurements, written by the simulator; for evaluation only.
//
//   radio/direct_paths.csv   t_s,receiver,transmitter,path        path: index of the direct path among the
//                                                                 measurement's paths, from 0; -1: none
//   match_labels.csv         robot_i,t_i_s,robot_j,t_j_s,label    true or false; several matches between
//                                                                 the same two stamps have one row each
// Rows without a measurement are skipped (the mission's tables may have been reduced since), and measurements
// without a row have no label.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/text/text.hpp"
#include "radioslam/mission/mission.hpp"

namespace radioslam {

/// One label per mission.aoa_measurements. Refuses unknown names and paths that the measurement does not
/// have.
std::vector<std::optional<int>> read_direct_paths(const Text& text, const Mission& mission);
std::string format_direct_paths(const Mission& mission, const std::vector<std::optional<int>>& direct_paths);

/// One label per mission.matches. Refuses unknown names and words other than true and false.
std::vector<std::optional<bool>> read_match_labels(const Text& text, const Mission& mission);
std::string format_match_labels(const Mission& mission, const std::vector<std::optional<bool>>& labels);

}  // namespace radioslam
