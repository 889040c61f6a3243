// Access points, and how they and the fingerprints sounded over time.
#pragma once

#include "radioslam/geometry/se3.hpp"
#include "radioslam/report/page_data.hpp"

namespace radioslam {

/// {"placed", "points": [{"bssid", "frequency_mhz", "known", "x", "y", "major_m", "minor_m", "turn_rad",
///   "p0_dbm", "exponent", "sigma_db", "readings", "rival": [x, y], "heard": [[x, y, dBm], ...]}]}: in the
/// page's frame, one sigma's ellipse with its long axis `turn_rad` from x. Of more than
/// params.maximum_access_points those with the most readings are drawn.
PageData access_point_data(const RunResult& result, const SE3& T_page_estimate, const ReportParams& params);

/// {"signals": [{"robot", "bssid", "t", "rss_dbm"}], "similarity": [{"robot", "of_t", "t", "similarity"}]},
/// columns thinned to params.maximum_signal_values in all; times count from `start`.
PageData signal_data(const RunResult& result, Stamp start, const ReportParams& params);

}  // namespace radioslam
