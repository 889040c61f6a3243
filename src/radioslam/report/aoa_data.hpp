// Page data of the angles of arrival measured from CSI, each with its profile.
#pragma once

#include <vector>

#include "radioslam/mission/truth.hpp"
#include "radioslam/report/report_params.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Times are relative to `start`; `truth` may be null. {"measured", "drawn": [{"receiver", "transmitter",
/// "t", "peaks": [{"azimuth_rad", "sigma_rad", "power_db",
///   "ghost"}], "profile": [...], "estimated_azimuth_rad", "true_azimuth_rad"}]}, by receiver, transmitter
///   and time.
/// Of more measurements than params.max_aoa_measurements, evenly spaced ones are drawn. Azimuths are in the
/// receiver's body frame; profile value k is the power at -pi + k 2 pi / size; "ghost" marks cross terms.
/// Estimated and true azimuths are absent if unknown; the true one needs true poses of both ends at the
/// measurement's time.
PageData aoa_data(const RunResult& result, Stamp start, const Truth* truth, const ReportParams& params);

/// A circular profile thinned to at most `limit` evenly spaced values with the same first position: each is
/// the maximum of the values nearest to it, so that no peak is lost.
std::vector<float> thinned_profile(const std::vector<float>& profile, std::size_t limit);

}  // namespace radioslam
