// Recorded trials of the WSR data set and the results that its authors published for them.
#pragma once

#include <string>
#include <vector>

#include "radioslam/io/datasets/wsr_results.hpp"
#include "radioslam/io/datasets/wsr_trial.hpp"

namespace radioslam::cli {

struct RecordedTrials {
  std::vector<WsrTrialFiles> trials;
  std::vector<WsrResult> published;  ///< empty if the results are not available
};

/// Refuses (InputError, prefixed by `call`) an empty `dataset`. If `authors` is empty, the results are
/// searched in 2D-Displacement_output_files within the data set's folder or up to two folders above it.
RecordedTrials find_trials(const std::string& call, const std::string& dataset, const std::string& authors);

}  // namespace radioslam::cli
