#include "radioslam/pipeline/inertial_guide.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/inertial/motion_prediction.hpp"

namespace radioslam {
namespace {

/// The poses of a body that turns as these states do and keeps its velocity in its own frame.
std::vector<SE3> led_by_turns(const std::vector<InertialState>& states, const std::vector<Stamp>& stamps,
                              const Eigen::Vector3d& velocity_mps) {
  std::vector<SE3> way{SE3({0, 0, 0}, states.front().T_world_body.rotation())};
  for (std::size_t k = 1; k < states.size(); ++k) {
    const SE3 turned({0, 0, 0},
                     states[k - 1].T_world_body.rotation().conjugate() * states[k].T_world_body.rotation());
    SE3::Tangent step = turned.log();
    step.head<3>() = seconds_between(stamps[k - 1], stamps[k]) * velocity_mps;
    way.push_back(way.back() * SE3::exp(step));
  }
  return way;
}

}  // namespace

std::optional<std::vector<SE3>> InertialGuide::way_through(const std::vector<Stamp>& stamps) const {
  const InertialState start = filter_ ? filter_->state() : InertialState{};
  const Stamp from = filter_ ? state_stamp_ : stamps.front();
  const auto states = predict_motion(start, from, *samples_, stamps, params_.noise);
  if (!states) return std::nullopt;
  if (!filter_) return led_by_turns(*states, stamps, *velocity_mps_);
  std::vector<SE3> way;
  for (const InertialState& state : *states) way.push_back(state.T_world_body);
  return way;
}

std::optional<ScanGuess> InertialGuide::guess(Stamp stamp, const SweptTime& time) const {
  if (!velocity_mps_) return std::nullopt;
  ScanGuess guess{{}, SweptWay::over(time)};
  std::vector<Stamp> stamps{stamp};
  for (std::size_t k = 0; k < guess.way.poses.size(); ++k)
    stamps.push_back({stamp.ns + Stamp::from_seconds(guess.way.time_of(k)).ns});
  if (last_) stamps.push_back(last_->stamp);
  if (filter_)  // what was before its state it does not know
    for (Stamp& at : stamps) at = std::max(at, state_stamp_);
  std::vector<Stamp> sorted = stamps;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
  const auto way = way_through(sorted);
  if (!way) return std::nullopt;
  const auto pose_at = [&](Stamp at) -> const SE3& {
    return (
        *way)[static_cast<std::size_t>(std::lower_bound(sorted.begin(), sorted.end(), at) - sorted.begin())];
  };
  const SE3 T_body_any = pose_at(stamp).inverse();
  for (std::size_t k = 0; k < guess.way.poses.size(); ++k)
    guess.way.poses[k] = T_body_any * pose_at(stamps[k + 1]);
  if (last_) guess.T_previous_body = (T_body_any * pose_at(stamps.back())).inverse();
  return guess;
}

void InertialGuide::align(const ScanPose& scan) {
  const auto aligned = align_gravity(Trajectory<SE3>(poses_), *samples_, params_.noise, params_.alignment);
  if (!aligned) {
    poses_.erase(poses_.begin(), poses_.begin() + std::ssize(poses_) / 2);
    return;
  }
  filter_.emplace(
      start_prior(aligned->states.back(), map_pose(scan, params_.stage), params_.noise, params_.smoother));
  state_stamp_ = scan.stamp;
  poses_.clear();
}

void InertialGuide::take_velocity(const StampedPose<SE3>& middle) {
  if (middle_ && middle_->stamp < middle.stamp)
    velocity_mps_ = (middle_->pose.inverse() * middle.pose).log().head<3>() /
                    seconds_between(middle_->stamp, middle.stamp);
  middle_ = middle;
}

void InertialGuide::add(const ScanPose& scan, const std::optional<ScanGuess>& guess) {
  last_ = {scan.stamp, scan.T_start_body};
  take_velocity(guess ? StampedPose<SE3>{{scan.stamp.ns + Stamp::from_seconds(guess->way.time.middle_s).ns},
                                         scan.T_start_body * guess->way.middle()}
                      : *last_);
  if (!filter_) {
    poses_.push_back(*last_);
    if (seconds_between(poses_.front().stamp, scan.stamp) >= params_.alignment.window_s) align(scan);
    if (filter_) drift_.emplace(scan, params_.stage);
    return;
  }
  drift_->add(scan);
  const double dt_s = seconds_between(state_stamp_, scan.stamp);
  if (dt_s < params_.stage.node_s && scan.outcome != ScanOutcome::kNewMap) return;
  auto readings = preintegrate(*samples_, state_stamp_, scan.stamp, filter_->state().bias, params_.noise);
  const StateStep step =
      state_step(map_pose(scan, params_.stage), drift_->covariance(), std::move(readings), dt_s);
  if (filter_->advance(step, params_.noise) != InertialFilter::Advance::kDone) return;
  state_stamp_ = scan.stamp;
  drift_.emplace(scan, params_.stage);
}

}  // namespace radioslam
