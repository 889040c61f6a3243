// radioslam import indoor-location, wifine, wifi-rtt, dpgo: converts public data sets to missions.
#pragma once

#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {

void import_phone_logs(const ImportOptions& options);

void import_wifine_trajectories(const ImportOptions& options);

void import_rtt_walk(const ImportOptions& options);

/// Writes a g2o file if the output ends in .g2o, else a mission.
void import_dpgo_tables(const ImportOptions& options);

}  // namespace radioslam::cli
