#include "radioslam/records/resumed_log.hpp"

#include <algorithm>
#include <variant>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {

ResumedLog::ResumedLog(const KnownLog& before, bool odometry_goes_on) : odometry_goes_on_(odometry_goes_on) {
  for (const auto& [number, bytes] : before.records) {
    const auto record = decode_record(bytes);
    if (!record) continue;
    if (const auto* keyframe = std::get_if<KeyframeRecord>(&*record)) {
      keyframes_ = keyframe->number + 1;
      T_start_last_ = T_start_last_.value_or(SE3()) * keyframe->T_before_this;
    } else if (const auto* heard = std::get_if<AccessPointRecord>(&*record)) {
      access_points_ = std::max(access_points_, heard->number + 1);
    }
  }
  if (!odometry_goes_on_ && keyframes_ > 0) ++keyframes_;
}

std::optional<std::string> ResumedLog::continued(const std::string& record) {
  auto decoded = decode_record(record);
  if (!decoded) return std::nullopt;
  const bool has_said = T_start_last_.has_value();
  if (has_said &&
      (std::holds_alternative<FactsRecord>(*decoded) || std::holds_alternative<AnchorRecord>(*decoded)))
    return std::nullopt;
  std::visit(
      [&](auto& of) {
        using Kind = std::decay_t<decltype(of)>;
        if constexpr (std::is_same_v<Kind, KeyframeRecord>) {
          if (of.number == 0 && has_said && odometry_goes_on_) {
            of.T_before_this = T_start_last_->inverse() * of.T_before_this;
            of.covariance.reset();
          }
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

}  // namespace radioslam
