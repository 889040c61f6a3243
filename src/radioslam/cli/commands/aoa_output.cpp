#include "radioslam/cli/commands/aoa_output.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <sstream>
#include <vector>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/radio/aoa/synthetic_array.hpp"

namespace radioslam::cli {
namespace {

/// A peak with its direction in the body frame at the estimate's stamp.
struct FramedPeak {
  AoaDirection body;
  std::optional<AoaDirection> body_mirror;
  const AoaPeak* peak;
};

nlohmann::ordered_json power_json(const CapturePower& power) {
  nlohmann::ordered_json json{{"packets", power.packets}};
  if (power.received_power_dbm) json["received_power_dbm"] = *power.received_power_dbm;
  for (const auto& [modulation, snr_db] : power.effective_snr_db)
    if (std::isfinite(snr_db)) json["effective_snr_db"][modulation] = snr_db;
  return json;
}

std::vector<FramedPeak> in_body_frame(const AoaEstimate& estimate) {
  const Eigen::Matrix3d R_body_frame = estimate.T_frame_body.rotation().conjugate().toRotationMatrix();
  const auto turned = [&](double azimuth_rad, double elevation_rad) {
    const Eigen::Vector3d u = R_body_frame * WaveSource{azimuth_rad, elevation_rad, 0}.direction();
    return AoaDirection{std::atan2(u.y(), u.x()), std::asin(std::clamp(u.z(), -1.0, 1.0))};
  };
  std::vector<FramedPeak> peaks;
  for (const AoaPeak& peak : estimate.peaks) {
    FramedPeak framed{turned(peak.azimuth_rad, peak.elevation_rad), {}, &peak};
    if (peak.mirror) framed.body_mirror = turned(peak.mirror->azimuth_rad, peak.mirror->elevation_rad);
    peaks.push_back(framed);
  }
  return peaks;
}

}  // namespace

nlohmann::ordered_json aoa_json(const AoaEstimate& estimate, const std::optional<ClockOffset>& clock,
                                const CsiChannels& from) {
  nlohmann::ordered_json json{{"t_s", estimate.stamp.seconds()},
                              {"packets", estimate.packets},
                              {"explained", estimate.explained},
                              {"peaks", nlohmann::ordered_json::array()}};
  for (const FramedPeak& framed : in_body_frame(estimate)) {
    nlohmann::ordered_json peak{{"azimuth_rad", framed.body.azimuth_rad},
                                {"azimuth_trajectory_frame_rad", framed.peak->azimuth_rad},
                                {"elevation_rad", framed.body.elevation_rad},
                                {"sigma_rad", framed.peak->sigma_rad},
                                {"elevation_sigma_rad", framed.peak->elevation_sigma_rad},
                                {"power_db", framed.peak->power_db},
                                {"explained", framed.peak->explained}};
    if (framed.peak->curvature_per_m > 0) peak["distance_m"] = 1 / framed.peak->curvature_per_m;
    if (framed.body_mirror) {
      peak["mirror_azimuth_rad"] = framed.body_mirror->azimuth_rad;
      peak["mirror_azimuth_trajectory_frame_rad"] = framed.peak->mirror->azimuth_rad;
      peak["mirror_elevation_rad"] = framed.body_mirror->elevation_rad;
    }
    if (framed.peak->is_cross_term) peak["ghost"] = true;
    json["peaks"].push_back(peak);
  }
  json["captures"]["heard"] = power_json(from.heard);
  if (from.answers) json["captures"]["answers"] = power_json(*from.answers);
  if (clock) json["clock_offset"] = {{"offset_s", clock->offset_s}, {"sigma_s", clock->sigma_s}};
  return json;
}

std::string profile_rows(const AoaEstimate& estimate) {
  std::ostringstream rows;
  rows << "azimuth_trajectory_frame_rad,power\n" << std::setprecision(9);
  const auto n = static_cast<double>(estimate.profile.size());
  for (std::size_t k = 0; k < estimate.profile.size(); ++k)
    rows << -std::numbers::pi + 2 * std::numbers::pi * static_cast<double>(k) / n << ','
         << estimate.profile[k] << '\n';
  return rows.str();
}

void print_aoa(const AoaEstimate& estimate, const std::optional<ClockOffset>& clock) {
  std::cout << estimate.packets << " packets around " << format_stamp(estimate.stamp) << " s\n"
            << "azimuth  in the trajectory's frame  elevation  sigma (deg)  power (dB)\n"
            << std::fixed;
  for (const FramedPeak& framed : in_body_frame(estimate)) {
    std::cout << std::setprecision(1) << std::setw(7) << framed.body.azimuth_rad / kRadiansPerDegree
              << std::setw(28) << framed.peak->azimuth_rad / kRadiansPerDegree << std::setw(11)
              << framed.body.elevation_rad / kRadiansPerDegree << std::setw(13)
              << framed.peak->sigma_rad / kRadiansPerDegree << std::setw(12) << framed.peak->power_db;
    if (framed.body_mirror)
      std::cout << "  or at " << framed.body_mirror->azimuth_rad / kRadiansPerDegree << ", elevation "
                << framed.body_mirror->elevation_rad / kRadiansPerDegree << " (mirror solution)";
    if (framed.peak->is_cross_term) std::cout << "  cross term of two paths";
    std::cout << '\n';
  }
  if (clock)
    std::cout << std::setprecision(3) << "clock offset " << clock->offset_s << " s, sigma " << clock->sigma_s
              << " s: "
              << "added to the capture's stamps\n";
}

}  // namespace radioslam::cli
