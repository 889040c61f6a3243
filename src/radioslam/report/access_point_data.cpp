#include "radioslam/report/access_point_data.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr int kPointDecimals = 2, kTurnDecimals = 3, kDecibelDecimals = 1;

const char* word_for(AccessPointStatus status) {
  switch (status) {
    case AccessPointStatus::kFound:
      return "found";
    case AccessPointStatus::kAmbiguous:
      return "ambiguous";
    case AccessPointStatus::kPoorlyConstrained:
      return "loose";
  }
  return "loose";
}

Eigen::Vector2d on_page_m(const SE3& T_page_estimate, const Eigen::Vector2d& position_m) {
  return (T_page_estimate * Eigen::Vector3d(position_m.x(), position_m.y(), 0)).head<2>();
}

PageData pair_data(const Eigen::Vector2d& position_m) {
  return {rounded(position_m.x(), kPointDecimals), rounded(position_m.y(), kPointDecimals)};
}

PageData readings_data(const AccessPointResult& point, const SE3& T_page_estimate, std::size_t limit) {
  PageData heard = PageData::array();
  for (const std::size_t k : evenly_spaced(point.heard.size(), limit)) {
    const Eigen::Vector3d& reading = point.heard[k];
    PageData row = pair_data(on_page_m(T_page_estimate, reading.head<2>()));
    row.push_back(rounded(reading.z(), kDecibelDecimals));
    heard.push_back(std::move(row));
  }
  return heard;
}

PageData point_data(const AccessPointResult& point, const SE3& T_page_estimate, std::size_t readings) {
  const auto axes = symmetric_eigen<Eigen::Matrix2d>(point.covariance.topLeftCorner<2, 2>());
  const Eigen::Vector2d sigma = axes.values.cwiseMax(0).cwiseSqrt();
  const Eigen::Vector2d along = axes.vectors.col(1);
  const Eigen::Vector2d at = on_page_m(T_page_estimate, point.position_m);
  PageData data{
      {"bssid", point.bssid},
      {"frequency_mhz", rounded(point.frequency_mhz, 0)},
      {"known", word_for(point.status)},
      {"x", rounded(at.x(), kPointDecimals)},
      {"y", rounded(at.y(), kPointDecimals)},
      {"major_m", rounded(sigma[1], kPointDecimals)},
      {"minor_m", rounded(sigma[0], kPointDecimals)},
      {"turn_rad", rounded(std::atan2(along.y(), along.x()) + T_page_estimate.yaw(), kTurnDecimals)},
      {"p0_dbm", rounded(point.power_at_1m_dbm, kDecibelDecimals)},
      {"exponent", rounded(point.exponent, kPointDecimals)},
      {"sigma_db", rounded(point.sigma_db, kDecibelDecimals)},
      {"readings", point.readings}};
  if (point.alternative_m) data["rival"] = pair_data(on_page_m(T_page_estimate, *point.alternative_m));
  data["heard"] = readings_data(point, T_page_estimate, readings);
  return data;
}

/// Indices of the access points with the most readings, in the result's order.
std::vector<std::size_t> drawn_points(const std::vector<AccessPointResult>& points, std::size_t limit) {
  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].readings > points[b].readings; });
  order.resize(std::min(order.size(), limit));
  std::sort(order.begin(), order.end());
  return order;
}

/// Adds stamps and values, thinned to the same indices.
void add_columns(PageData& data, const char* name, const std::vector<Stamp>& stamps,
                 const std::vector<float>& values, Stamp start, std::size_t limit, int decimals) {
  PageData t = PageData::array(), column = PageData::array();
  for (const std::size_t k : evenly_spaced(stamps.size(), limit)) {
    t.push_back(rounded(seconds_between(start, stamps[k]), 1));
    column.push_back(rounded(static_cast<double>(values[k]), decimals));
  }
  data["t"] = std::move(t);
  data[name] = std::move(column);
}

}  // namespace

PageData access_point_data(const RunResult& result, const SE3& T_page_estimate, const ReportParams& params) {
  constexpr std::size_t kLeastReadings = 12;  // for the circles
  const auto drawn = drawn_points(result.access_points, static_cast<std::size_t>(params.max_access_points));
  std::size_t total = 0;
  for (const std::size_t k : drawn) total += result.access_points[k].heard.size();
  PageData points = PageData::array();
  for (const std::size_t k : drawn) {
    const AccessPointResult& point = result.access_points[k];
    points.push_back(
        point_data(point, T_page_estimate,
                   part_of_budget(point.heard.size(), total,
                                  static_cast<std::size_t>(params.max_signal_values), kLeastReadings)));
  }
  return {{"placed", result.access_points.size()}, {"points", std::move(points)}};
}

PageData signal_data(const RunResult& result, Stamp start, const ReportParams& params) {
  const auto budget = static_cast<std::size_t>(params.max_signal_values);
  std::size_t total = 0;
  for (const auto& signal : result.signals) total += signal.stamps.size();
  for (const auto& over : result.similarity_over_time) total += over.stamps.size();
  PageData signals = PageData::array(), similarity = PageData::array();
  for (const auto& signal : result.signals) {
    PageData data{{"robot", signal.robot}, {"bssid", signal.bssid}};
    add_columns(data, "rss_dbm", signal.stamps, signal.rss_dbm, start,
                part_of_budget(signal.stamps.size(), total, budget), kDecibelDecimals);
    signals.push_back(std::move(data));
  }
  for (const auto& over : result.similarity_over_time) {
    PageData data{{"robot", over.robot}, {"of_t", rounded(seconds_between(start, over.of), 1)}};
    add_columns(data, "similarity", over.stamps, over.similarity, start,
                part_of_budget(over.stamps.size(), total, budget), kTurnDecimals);
    similarity.push_back(std::move(data));
  }
  return {{"signals", std::move(signals)}, {"similarity", std::move(similarity)}};
}

}  // namespace radioslam
