#include "radioslam/records/resumed_log.hpp"

#include <algorithm>
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
      last_ = {keyframe->stamp, (last_ ? last_->pose : SE3()) * keyframe->T_before_this};
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

/// The new front end's first keyframe with the log's last one.
void ResumedLog::connect(KeyframeRecord& first) {
  if (odometry_goes_on_) {
    first.T_before_this = last_->pose.inverse() * first.T_before_this;
    first.covariance.reset();
  } else if (!connect_by_odometry(first)) {
    ++keyframes_;
  }
}

bool ResumedLog::connect_by_odometry(KeyframeRecord& first) const {
  if (!odometry_) return false;
  const auto before = odometry_->before.find(last_->stamp), after = odometry_->after.find(first.stamp);
  if (before == odometry_->before.end() || after == odometry_->after.end()) return false;
  OdometryEdge<SE3> edge;
  append_sample(edge, {last_->stamp, before->second}, {first.stamp, after->second}, odometry_->noise);
  first.T_before_this = edge.T_i_j;
  first.covariance = with_drift(edge, odometry_->noise).covariance;
  return true;
}

}  // namespace radioslam
