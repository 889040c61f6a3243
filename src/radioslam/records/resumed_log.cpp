#include "radioslam/records/resumed_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {

std::string encode_recorded(const RecordedAtKeyframes::value_type& recorded) {
  KeyframeRecord as_keyframe;
  as_keyframe.stamp = recorded.first;
  as_keyframe.T_before_this = recorded.second;
  return encode(as_keyframe);
}

RecordedAtKeyframes decode_recorded(const std::string& bytes) {
  const auto record = decode_record(bytes);
  const auto* keyframe = record ? std::get_if<KeyframeRecord>(&*record) : nullptr;
  if (!keyframe) return {};
  return {{keyframe->stamp, keyframe->T_before_this}};
}

ResumedLog::ResumedLog(const KnownLog& before, bool odometry_goes_on) : odometry_goes_on_(odometry_goes_on) {
  for (const auto& [number, bytes] : before.records) {
    const auto record = decode_record(bytes);
    if (!record) continue;
    if (const auto* keyframe = std::get_if<KeyframeRecord>(&*record)) {
      keyframes_ = keyframe->number + 1;
      if (last_) add_usual(*keyframe);
      last_ = {keyframe->stamp, (last_ ? last_->pose : SE3()) * keyframe->T_before_this};
    } else if (const auto* facts = std::get_if<FactsRecord>(&*record)) {
      noise_ = facts->noise;
    } else if (const auto* heard = std::get_if<AccessPointRecord>(&*record)) {
      access_points_ = std::max(access_points_, heard->number + 1);
    }
  }
}

ResumedLog::ResumedLog(const KnownLog& before, OdometryBesideScans odometry) : ResumedLog(before, false) {
  odometry_.emplace(std::move(odometry));
  odometry_->noise.steps.clear();  // none was measured while the program did not run
}

std::optional<std::string> ResumedLog::continued(const std::string& record) {
  auto decoded = decode_record(record);
  if (!decoded) return std::nullopt;
  if (last_ &&
      (std::holds_alternative<FactsRecord>(*decoded) || std::holds_alternative<AnchorRecord>(*decoded)))
    return std::nullopt;
  std::visit(
      [&](auto& of) {
        using Kind = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Kind, KeyframeRecord>) {
          if (of.number == 0 && last_) connect(of);
          of.number += keyframes_;
        } else if constexpr (std::is_same_v<Kind, AccessPointRecord>) {
          of.number += access_points_;
        } else if constexpr (std::is_same_v<Kind, FingerprintRecord>) {
          for (HeardAccessPoint& reading : of.readings) reading.number += access_points_;
        } else if constexpr (std::is_same_v<Kind, AmendmentRecord>) {
          of.first += keyframes_;
        } else if constexpr (requires { of.keyframe; }) {
          of.keyframe += keyframes_;
        }
        if constexpr (requires { of.at; }) of.at.keyframe += keyframes_;
      },
      *decoded);
  return encode(*decoded);
}

void ResumedLog::add_usual(const KeyframeRecord& keyframe) {
  const SE3::Tangent step = keyframe.T_before_this.log();
  travelled_m_ += step.head<3>().norm();
  turned_rad_ += step.tail<3>().norm();
  followed_s_ += seconds_between(last_->stamp, keyframe.stamp);
}

/// The new front end's first keyframe with the log's last one.
void ResumedLog::connect(KeyframeRecord& first) {
  if (odometry_goes_on_) {
    const auto edge = crossing(last_->pose.inverse() * first.T_before_this, first.stamp, noise_);
    first.T_before_this = edge.T_i_j;
    first.covariance = edge.covariance;  // the constant drift is estimated
    return;
  }
  if (odometry_) {
    const auto before = odometry_->before.find(last_->stamp);
    const auto after = odometry_->after.find(first.stamp);
    if (before != odometry_->before.end() && after != odometry_->after.end()) {
      const auto edge = crossing(before->second.inverse() * after->second, first.stamp, odometry_->noise);
      first.T_before_this = edge.T_i_j;
      first.covariance = with_drift(edge, odometry_->noise).covariance;
      return;
    }
  }
  ++keyframes_;
}

/// Its ends are known. In between the robot has gone on as it usually does, or straight if that is farther.
OdometryEdge<SE3> ResumedLog::crossing(const SE3& motion, Stamp end, OdometryNoise noise) const {
  constexpr double kPiece_m = 1, kMostPieces = 1000;
  const SE3::Tangent whole = motion.log();
  const double dt_s = seconds_between(last_->stamp, end), usual = followed_s_ > 0 ? dt_s / followed_s_ : 0;
  const double straight_m = std::max(motion.translation().norm(), 1e-3);
  const double way = std::max(1.0, usual * travelled_m_ / straight_m);
  const double unseen_rad = std::max(0.0, usual * turned_rad_ - whole.tail<3>().norm());
  noise.sigma_xy_per_sqrt_m *= std::sqrt(way);
  noise.sigma_z_per_sqrt_m *= std::sqrt(way);
  noise.sigma_yaw_per_sqrt_m_rad = std::sqrt(std::pow(noise.sigma_yaw_per_sqrt_m_rad, 2) * way +
                                             std::pow(noise.sigma_yaw_per_rad, 2) * unseen_rad / straight_m);
  const auto pieces = static_cast<int>(std::clamp(std::ceil(straight_m / kPiece_m), 1.0, kMostPieces));
  OdometryEdge<SE3> edge;
  for (int k = 0; k < pieces; ++k) {
    const auto at = [&](int n) { return SE3::exp(whole * (static_cast<double>(n) / pieces)); };
    append_sample(edge, {last_->stamp, at(k)}, {end, at(k + 1)}, noise);
  }
  return edge;
}

}  // namespace radioslam
