// Trials that were recorded, and what others got out of them.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/wsr_results.hpp"
#include "radioslam/io/wsr_trial.hpp"

namespace radioslam::cli {

struct RecordedTrials {
  std::vector<WsrTrialFiles> trials;
  std::vector<WsrResult> published;  ///< none where they are not there
};

/// `call` stands before a refusal: no data set. Without `authors`, 2D-Displacement_output_files is looked for
/// in the data set's folder and beside it, up to two folders above.
RecordedTrials find_trials(const std::string& call, const std::string& dataset, const std::string& authors);

}  // namespace radioslam::cli
