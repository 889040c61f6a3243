// The directions that were measured out of channel state information, each with the profile it came from.
#pragma once

#include <vector>

#include "radioslam/report/page_data.hpp"

namespace radioslam {

/// Times count from `start`; `truth` may be null.
/// {"measured", "drawn": [{"receiver", "transmitter", "t", "peaks": [{"azimuth_rad", "sigma_rad", "power_db",
///   "ghost"}], "profile": [...], "estimated_azimuth_rad", "true_azimuth_rad"}]}, by receiver, transmitter
/// and time. Of more measurements than params.maximum_arrivals evenly chosen ones are drawn. Azimuths are in
/// the receiver's body frame; profile value k stands at -pi + k 2 pi / size. The last two are absent where
/// they are not known; the true one is where both ends' true poses cover the measurement's time.
PageData arrival_data(const RunResult& result, Stamp start, const Truth* truth, const ReportParams& params);

/// A closed course of values in at most `limit`, spaced evenly from the same first place: each is the largest
/// of those nearest to it, so that no peak is lost.
std::vector<float> thinned_profile(const std::vector<float>& profile, std::size_t limit);

}  // namespace radioslam
