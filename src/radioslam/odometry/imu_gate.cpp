#include "radioslam/odometry/imu_gate.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include "radioslam/inertial/imu_consistency.hpp"

namespace radioslam {

bool ImuGate::test(const ScanPoses& scans, const std::vector<ImuSample>& samples) {
  if (trust_ == ImuTrust::kRejected || scans.empty()) return false;
  const Stamp now = scans.back().stamp;
  if (!first_) first_ = last_test_ = now;
  if (seconds_between(*last_test_, now) < kTestEvery_s) return false;
  last_test_ = now;
  auto wrong = inconsistency(scans, samples);
  right_ = wrong ? 0 : right_ + 1;
  if (std::exchange(was_wrong_, wrong.has_value()) && wrong) {
    reject(std::move(*wrong));
    return true;
  }
  const bool is_over = seconds_between(*first_, now) >= params_.stage.check_s;
  if (wrong || trust_ == ImuTrust::kTrusted || !is_over) return false;
  trust_ = ImuTrust::kTrusted;
  return true;
}

void ImuGate::conclude(const ScanPoses& scans, const std::vector<ImuSample>& samples) {
  if (trust_ != ImuTrust::kUntested) return;
  if (auto wrong = inconsistency(scans, samples))
    reject(std::move(*wrong));
  else
    trust_ = ImuTrust::kTrusted;
}

void ImuGate::reject(std::string reason) {
  trust_ = ImuTrust::kRejected;
  reason_ = std::move(reason);
}

std::optional<std::string> ImuGate::inconsistency(const ScanPoses& scans,
                                                  const std::vector<ImuSample>& samples) const {
  if (scans.empty()) return std::nullopt;
  const auto is_recent = [&](const auto& of) {
    return seconds_between(of.stamp, scans.back().stamp) <= params_.stage.check_s;
  };
  std::vector<StampedPose<SE3>> poses;
  const auto first = std::partition_point(scans.begin(), scans.end(), std::not_fn(is_recent));
  for (auto scan = first; scan != scans.end(); ++scan) poses.push_back({scan->stamp, scan->T_start_body});
  const std::vector<ImuSample> recent(
      std::partition_point(samples.begin(), samples.end(), std::not_fn(is_recent)), samples.end());
  return find_inconsistency(Trajectory<SE3>(std::move(poses)), recent, params_.noise, params_.consistency);
}

}  // namespace radioslam
