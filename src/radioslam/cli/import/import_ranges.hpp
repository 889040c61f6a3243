// radioslam import iw-ftm: converts WiFi round-trip times to a ranges.csv.
#pragma once

#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {

void import_ftm_ranges(const ImportOptions& options);

}  // namespace radioslam::cli
