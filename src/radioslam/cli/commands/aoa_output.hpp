// Output of `radioslam aoa`: a text table, a JSON object, and the profile over azimuth as CSV.
//
// Directions are in the body frame at the estimate's stamp, u_body = R_frame_body^-1 u; the azimuth in the
// trajectory's frame is given as well. Angles are in degrees in the table and in radians elsewhere.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "radioslam/cli/commands/csi_channels.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/captures/clock_offset.hpp"

namespace radioslam::cli {

nlohmann::ordered_json aoa_json(const AoaEstimate& estimate, const std::optional<ClockOffset>& clock,
                                const CsiChannels& from);

/// Rows of the profile: azimuth_trajectory_frame_rad,power.
std::string profile_rows(const AoaEstimate& estimate);

/// Prints the table on standard output.
void print_aoa(const AoaEstimate& estimate, const std::optional<ClockOffset>& clock);

}  // namespace radioslam::cli
