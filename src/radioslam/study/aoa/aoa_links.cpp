#include "radioslam/study/aoa/aoa_links.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/se2.hpp"

namespace radioslam {
namespace {

/// Tolerance for the authors' start positions, which are motion capture positions with six decimals.
constexpr double kSamePosition_m = 5e-6;
/// Lever arm of the antenna from the base's centre, to which wheel odometry refers.
const Eigen::Vector3d kAntennaFromBase_m(0, 0.16, 0);

const char* reason_text(AoaFailure reason) {
  switch (reason) {
    case AoaFailure::kNoMotion:
      return "no motion";
    case AoaFailure::kTooFewPackets:
      return "too few packets";
    case AoaFailure::kNoOdometry:
      return "no odometry at the packets' times";
    case AoaFailure::kTooWide:
      return "a way that is too wide";
    case AoaFailure::kZeroChannel:
      return "a channel of zeros";
  }
  return "";
}

const char* reason_text(TwoWayFailure reason) {
  switch (reason) {
    case TwoWayFailure::kTooFewExchanges:
      return "too few packets";
    case TwoWayFailure::kOtherSubcarriers:
      return "other subcarriers at the other end";
    case TwoWayFailure::kIncoherent:
      return "phases that do not agree";
  }
  return "";
}

/// A trajectory of a trial, and the lever arm of the antenna on the moving body.
struct Motion {
  WsrMotion kind;
  const Trajectory<SE3>* trajectory;
  Eigen::Vector3d antenna_m;
};

std::vector<Motion> motions_of(const WsrTrial& trial) {
  std::vector<Motion> motions{{WsrMotion::kMotionCapture, &trial.motion_capture, Eigen::Vector3d::Zero()}};
  if (trial.tracking_camera)
    motions.push_back({WsrMotion::kTrackingCamera, &*trial.tracking_camera, Eigen::Vector3d::Zero()});
  if (trial.wheel_odometry)
    motions.push_back({WsrMotion::kWheelOdometry, &*trial.wheel_odometry, kAntennaFromBase_m});
  return motions;
}

Eigen::Vector3d mean_position_m(const Trajectory<SE3>& trajectory) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [stamp, pose] : trajectory) sum += pose.translation();
  return sum / static_cast<double>(trajectory.size());
}

/// Yaw of the planar alignment of a motion's antenna trajectory with that of motion capture.
double frame_turn_rad(const Motion& motion, const Trajectory<SE3>& truth) {
  std::vector<Eigen::Vector2d> moved, true_positions;
  for (const auto& [stamp, pose] : *motion.trajectory)
    if (const auto there = truth.at(stamp)) {
      moved.emplace_back((pose * motion.antenna_m).head<2>());
      true_positions.emplace_back(there->translation().head<2>());
    }
  if (moved.size() < 2) return 0;
  const auto n = std::ssize(moved);
  Eigen::Matrix2Xd source(2, n), target(2, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    source.col(k) = moved[static_cast<std::size_t>(k)];
    target.col(k) = true_positions[static_cast<std::size_t>(k)];
  }
  const SE2 T_target_source = align_points(source, target);
  return T_target_source.angle();
}

bool starts_in(const WsrResult& result, const WsrTrial& trial) {
  return std::any_of(trial.motion_capture.begin(), trial.motion_capture.end(), [&](const auto& row) {
    return (row.pose.translation() - result.start_m).cwiseAbs().maxCoeff() < kSamePosition_m;
  });
}

std::vector<double> published_errors(const WsrTrial& trial, const AoaLink& link,
                                     const std::vector<WsrResult>& published) {
  for (const WsrResult& result : published)
    if (result.sight == link.sight && result.motion == link.motion &&
        result.transmitter == link.transmitter && starts_in(result, trial))
      return result.errors_rad;
  return {};
}

void measure(const WsrTrial& trial, const WsrTransmitter& transmitter, const Motion& motion,
             const AoaParams& params, AoaLink& link) {
  const auto both = two_way_track(trial.receiver, transmitter.address, transmitter.heard, trial.carrier_hz,
                                  motion.antenna_m, params.two_way);
  if (!both.track) {
    link.reason = reason_text(both.reason);
    return;
  }
  const auto result = estimate_aoa(*both.track, *motion.trajectory, motion.trajectory->front().stamp,
                                   motion.trajectory->back().stamp, params);
  if (result.estimate) {
    link.peaks = result.estimate->peaks;
    link.profile = result.estimate->profile;
  } else {
    link.reason = reason_text(result.reason);
  }
}

}  // namespace

double error_rad(const AoaLink& link, std::size_t peak) {
  if (peak >= link.peaks.size()) return std::numbers::pi;
  return std::abs(wrap_angle(link.peaks[peak].azimuth_rad - link.true_azimuth_rad));
}

double own_frame_error_rad(const AoaLink& link) {
  if (link.peaks.empty()) return std::numbers::pi;
  return std::abs(wrap_angle(link.peaks.front().azimuth_rad + link.frame_turn_rad - link.true_azimuth_rad));
}

std::vector<AoaLink> measure_wsr_trial(const WsrTrial& trial, const std::vector<WsrResult>& published,
                                       const AoaParams& params) {
  const std::vector<Motion> motions = motions_of(trial);
  const Eigen::Vector3d here_m = mean_position_m(trial.motion_capture);
  std::vector<AoaLink> links(motions.size() * trial.transmitters.size());
  parallel_for(links.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Motion& motion = motions[k / trial.transmitters.size()];
      const WsrTransmitter& transmitter = trial.transmitters[k % trial.transmitters.size()];
      const Eigen::Vector3d there_m = transmitter.position_m - here_m;
      links[k] = {trial.name,
                  transmitter.name,
                  trial.sight,
                  motion.kind,
                  std::atan2(there_m.y(), there_m.x()),
                  {},
                  {},
                  {}};
      links[k].frame_turn_rad = frame_turn_rad(motion, trial.motion_capture);
      links[k].published_rad = published_errors(trial, links[k], published);
      measure(trial, transmitter, motion, params, links[k]);
    }
  });
  return links;
}

}  // namespace radioslam
