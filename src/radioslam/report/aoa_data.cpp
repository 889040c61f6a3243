#include "radioslam/report/aoa_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace radioslam {
namespace {

constexpr int kAngleDecimals = 3, kPowerDecimals = 1, kProfileDecimals = 3;

std::vector<std::size_t> by_link_and_time(const std::vector<MeasuredAoaResult>& aoa_measurements) {
  std::vector<std::size_t> order(aoa_measurements.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto key = [&](std::size_t k) {
    const auto& aoa = aoa_measurements[k];
    return std::tie(aoa.receiver, aoa.transmitter, aoa.stamp);
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  return order;
}

/// A robot's true pose at a time, if it is known, including its heading if `needs_heading`.
std::optional<SE3> true_pose(const Truth& truth, const std::string& id, Stamp stamp, bool needs_heading) {
  for (const auto& robot : truth.robots)
    if (robot.id == id && (robot.has_orientation || !needs_heading)) return robot.poses.at(stamp);
  return std::nullopt;
}

std::optional<double> true_azimuth_rad(const MeasuredAoaResult& aoa, const Truth& truth) {
  const auto T_common_receiver = true_pose(truth, aoa.receiver, aoa.stamp, true);
  const auto T_common_transmitter = true_pose(truth, aoa.transmitter, aoa.stamp, false);
  if (!T_common_receiver || !T_common_transmitter) return std::nullopt;
  const Eigen::Vector3d seen = T_common_receiver->inverse() * T_common_transmitter->translation();
  return std::atan2(seen.y(), seen.x());
}

PageData peak_data(const std::vector<AoaPeakResult>& peaks) {
  PageData data = PageData::array();
  for (const auto& peak : peaks)
    data.push_back({{"azimuth_rad", rounded(peak.azimuth_rad, kAngleDecimals)},
                    {"sigma_rad", rounded(peak.sigma_rad, kAngleDecimals)},
                    {"power_db", rounded(peak.power_db, kPowerDecimals)},
                    {"ghost", peak.is_cross_term}});
  return data;
}

PageData profile_data(const std::vector<float>& profile, const ReportParams& params) {
  PageData data = PageData::array();
  const auto limit = static_cast<std::size_t>(std::max(params.max_profile_values, 1));
  for (const float power : thinned_profile(profile, limit))
    data.push_back(rounded(static_cast<double>(power), kProfileDecimals));
  return data;
}

PageData measurement_data(const MeasuredAoaResult& aoa, Stamp start, const Truth* truth,
                          const ReportParams& params) {
  PageData data{{"receiver", aoa.receiver},
                {"transmitter", aoa.transmitter},
                {"t", rounded_seconds(seconds_between(start, aoa.stamp))},
                {"peaks", peak_data(aoa.peaks)},
                {"profile", profile_data(aoa.profile, params)}};
  if (aoa.estimated_azimuth_rad)
    data["estimated_azimuth_rad"] = rounded(*aoa.estimated_azimuth_rad, kAngleDecimals);
  if (truth == nullptr) return data;
  if (const auto azimuth_rad = true_azimuth_rad(aoa, *truth))
    data["true_azimuth_rad"] = rounded(*azimuth_rad, kAngleDecimals);
  return data;
}

}  // namespace

std::vector<float> thinned_profile(const std::vector<float>& profile, std::size_t limit) {
  const std::size_t size = profile.size();
  if (size <= limit) return profile;
  std::vector<float> thinned(limit, -std::numeric_limits<float>::infinity());
  for (std::size_t k = 0; k < size; ++k) {
    const std::size_t nearest = (2 * k * limit + size) / (2 * size) % limit;
    thinned[nearest] = std::max(thinned[nearest], profile[k]);
  }
  return thinned;
}

PageData aoa_data(const RunResult& result, Stamp start, const Truth* truth, const ReportParams& params) {
  const auto order = by_link_and_time(result.aoa_measurements);
  const auto limit = static_cast<std::size_t>(std::max(params.max_aoa_measurements, 2));
  PageData drawn = PageData::array();
  for (const std::size_t place : evenly_spaced(order.size(), limit))
    drawn.push_back(measurement_data(result.aoa_measurements[order[place]], start, truth, params));
  return {{"measured", result.aoa_measurements.size()}, {"drawn", std::move(drawn)}};
}

}  // namespace radioslam
