// radioslam import carmen, kitti: what robots with laser scanners recorded becomes a mission.
#pragma once

#include "radioslam/cli/import_options.hpp"

namespace radioslam::cli {

void import_carmen_log(const ImportOptions& options);

void import_kitti_drive(const ImportOptions& options);

}  // namespace radioslam::cli
