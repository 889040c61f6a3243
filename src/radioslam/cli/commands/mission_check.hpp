// Findings about a mission's folder, of its files as well as of their contents.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/mission/finding.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam::cli {

/// All findings. What a reader refuses is a finding; then nothing else can be checked. Throws InputError only
/// if there is no mission.yaml in the folder.
std::vector<Finding> examine_mission(const std::filesystem::path& folder);

/// The warnings about a mission that was read. Throws InputError, with all errors' number, if it has errors.
std::vector<Finding> warnings_about(const Mission& mission, const Truth& truth, const std::string& folder);

/// Whether one of them is a ground truth that is the mirror image of the odometry.
bool has_mirrored_truth(const std::vector<Finding>& findings);

}  // namespace radioslam::cli
