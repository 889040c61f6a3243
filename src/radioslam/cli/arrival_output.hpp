// Directions of arrival as `radioslam aoa` puts them out: a table to read, a JSON object, and the profile
// over azimuth as CSV.
//
// Directions are of the body at the estimate's stamp, u_body = R_frame_body^-1 u, with the azimuth in the
// trajectory's frame beside them. Degrees in the table, radians elsewhere.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "radioslam/cli/heard_channels.hpp"
#include "radioslam/radio/arrival_estimate.hpp"
#include "radioslam/radio/clock_offset.hpp"

namespace radioslam::cli {

nlohmann::ordered_json arrival_json(const ArrivalEstimate& estimate, const std::optional<ClockOffset>& clock,
                                    const HeardChannels& from);

/// azimuth_trajectory_frame_rad,power
std::string profile_rows(const ArrivalEstimate& estimate);

/// The table, on standard output.
void print_arrival(const ArrivalEstimate& estimate, const std::optional<ClockOffset>& clock);

}  // namespace radioslam::cli
