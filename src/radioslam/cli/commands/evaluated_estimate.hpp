// What `evaluate` compares: the estimate, in the folder of a run or in a pose graph, and a truth that is
// given robot by robot.
#pragma once

#include <string>
#include <vector>

#include "radioslam/cli/commands/mission_input.hpp"
#include "radioslam/io/run/run_folder.hpp"

namespace radioslam::cli {

struct EvaluatedEstimate {
  RunFolder run;
  int dimension = 3;
  std::vector<std::string> notes;
};

/// Reads the folder of a run, or the VERTEX lines of a g2o file: those that `optimize` writes, or any whose
/// ids are keys. Robots are the letters of the ids, and a pose's stamp is its index in seconds. Refuses what
/// read_run and read_g2o refuse, and a graph without VERTEX lines.
EvaluatedEstimate read_estimate(const std::string& path);

/// Replaces or adds the truth of robots: `truths` has entries ROBOT=FILE, a TUM file each. A mission that is
/// not given is made of the estimate's robots. Refuses entries without a robot of the estimate.
void use_given_truth(const std::vector<std::string>& truths, const EvaluatedEstimate& estimate,
                     MissionInput& input);

}  // namespace radioslam::cli
