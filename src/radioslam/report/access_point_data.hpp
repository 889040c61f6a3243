// Page data of access points, and of signals and similarity over time.
#pragma once

#include "radioslam/geometry/se3.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// {"placed", "points": [{"bssid", "frequency_mhz", "known", "x", "y", "major_m", "minor_m", "turn_rad",
///   "p0_dbm", "exponent", "sigma_db", "readings", "rival": [x, y], "heard": [[x, y, dBm], ...]}]}, in the
///   page's
///   frame. The ellipse is that of one sigma, with its long axis `turn_rad` from x; "rival" is the
///   alternative position,
///   "heard" some readings. Of more than params.max_access_points, those with the most readings are drawn.
PageData access_point_data(const RunResult& result, const SE3& T_page_estimate, const ReportParams& params);

/// {"signals": [{"robot", "bssid", "t", "rss_dbm"}], "similarity": [{"robot", "of_t", "t", "similarity"}]},
/// columns thinned to params.max_signal_values in total; times are relative to `start`.
PageData signal_data(const RunResult& result, Stamp start, const ReportParams& params);

}  // namespace radioslam
