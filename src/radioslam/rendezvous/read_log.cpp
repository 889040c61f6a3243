#include "radioslam/rendezvous/read_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace radioslam {
namespace {

constexpr double kSmallestSigma = 1e-6, kLargestSigma = 1e6;  ///< m and rad
constexpr std::size_t kMostPaths = 64;                        ///< of a record
constexpr std::int64_t kRounding_ns = 1000;                   ///< of stamps that were seconds since 1970
constexpr Eigen::Index kPlane[] = {0, 1, 5};                  ///< of [translation; rotation] in space

SE3::Jacobian in_space(const SE2::Jacobian& covariance) {
  SE3::Jacobian whole = isotropic(1, 1);
  for (int i = 0; i < SE2::kDof; ++i)
    for (int j = 0; j < SE2::kDof; ++j) whole(kPlane[i], kPlane[j]) = covariance(i, j);
  return whole;
}

SE2::Jacobian in_plane(const SE3::Jacobian& covariance) {
  SE2::Jacobian part = kSmallestSigma * kSmallestSigma * SE2::Jacobian::Identity();
  for (int i = 0; i < SE2::kDof; ++i)
    for (int j = 0; j < SE2::kDof; ++j) part(i, j) += covariance(kPlane[i], kPlane[j]);
  return part;
}

}  // namespace

SE2::Jacobian planar_covariance(double sigma_m, double sigma_rad) {
  const double m = std::clamp(sigma_m, kSmallestSigma, kLargestSigma);
  const double rad = std::clamp(sigma_rad, kSmallestSigma, kLargestSigma);
  return SE2::Tangent(m * m, m * m, rad * rad).asDiagonal();
}

KeyframeRecord keyframe_of(std::uint32_t number, Stamp stamp, const SE2& step, double sigma_m,
                           double sigma_rad) {
  return {number, stamp, lift(step), in_space(planar_covariance(sigma_m, sigma_rad))};
}

ClosureRecord closure_of(std::uint32_t keyframe, const Sighting& seen) {
  return {{keyframe, seen.stamp, {}}, seen.robot,   seen.stamp,  lift(seen.T_i_j),
          in_space(seen.covariance),  std::nullopt, std::nullopt};
}

AnglesRecord angles_of(std::uint32_t keyframe, Stamp stamp, const std::string& from,
                       const std::vector<ArrivalPath>& paths) {
  AnglesRecord record{{keyframe, stamp, {}}, {false, from, {}, Eigen::Vector3d::Zero()}, {}};
  for (std::size_t k = 0; k < std::min(paths.size(), kMostPaths); ++k)
    record.paths.push_back({wrap_angle(paths[k].azimuth_rad), std::nullopt,
                            std::clamp(paths[k].sigma_rad, kSmallestSigma, kLargestSigma),
                            paths[k].power_db});
  return record;
}

void ReadLog::take(const Record& record) {
  ++records_;
  if (const auto* facts = std::get_if<FactsRecord>(&record)) {
    if (facts->initial_pose && stamps_.empty()) start_ = flatten(*facts->initial_pose);
  } else if (const auto* keyframe = std::get_if<KeyframeRecord>(&record)) {
    take(*keyframe);
  } else if (const auto* closure = std::get_if<ClosureRecord>(&record)) {
    take(*closure);
  } else if (const auto* angles = std::get_if<AnglesRecord>(&record)) {
    take(*angles);
  }
}

void ReadLog::take(const KeyframeRecord& keyframe) {
  if (keyframe.number != stamps_.size() || (!stamps_.empty() && keyframe.stamp < stamps_.back())) return;
  steps_.emplace_back();
  if (!stamps_.empty())
    steps_.back() = {flatten(keyframe.T_before_this),
                     in_plane(keyframe.covariance.value_or(SE3::Jacobian::Identity()))};
  stamps_.push_back(keyframe.stamp);
  is_whole_until(keyframe.stamp);
}

void ReadLog::take(const ClosureRecord& closure) {
  if (closure.inlier_ratio || closure.at.keyframe >= stamps_.size()) return;
  sightings_.push_back({closure.at.keyframe, closure.other, closure.stamp_other,
                        flatten(closure.at.T_keyframe_body * closure.T_i_j), in_plane(closure.covariance)});
  is_whole_until(closure.at.stamp);
}

void ReadLog::take(const AnglesRecord& angles) {
  if (angles.transmitter.is_anchor || angles.at.keyframe >= stamps_.size()) return;
  Heard heard{angles.at.stamp, {}};
  for (const AoaPath& path : angles.paths)
    heard.paths.push_back({path.azimuth_rad, path.sigma_rad, path.power_db});
  heard_[{angles.transmitter.name, angles.at.keyframe}].push_back(std::move(heard));
}

std::optional<std::uint32_t> ReadLog::keyframe_at(Stamp stamp) const {
  const auto after = std::upper_bound(stamps_.begin(), stamps_.end(), stamp);
  if (after == stamps_.begin() || stamp.ns > until_.ns + kRounding_ns) return std::nullopt;
  return static_cast<std::uint32_t>(after - stamps_.begin() - 1);
}

std::vector<std::vector<ArrivalPath>> ReadLog::arrivals(const std::string& robot, std::uint32_t keyframe,
                                                        Stamp stamp) const {
  std::vector<std::vector<ArrivalPath>> list;
  const auto heard = heard_.find({robot, keyframe});
  if (heard == heard_.end()) return list;
  const auto distance = [&](const Heard& each) { return std::abs(seconds_between(stamp, each.stamp)); };
  double nearest_s = std::numeric_limits<double>::infinity();
  for (const Heard& each : heard->second) nearest_s = std::min(nearest_s, distance(each));
  for (const Heard& each : heard->second)
    if (distance(each) <= nearest_s) list.push_back(each.paths);
  return list;
}

}  // namespace radioslam
