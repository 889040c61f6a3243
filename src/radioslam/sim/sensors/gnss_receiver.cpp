#include "radioslam/sim/sensors/gnss_receiver.hpp"

#include <algorithm>

namespace radioslam {
namespace {

Eigen::Vector3d fix_noise(Rng& rng, double sigma) {
  return {rng.normal(0, sigma), rng.normal(0, sigma), rng.normal(0, sigma)};
}

/// The gross errors of successive fixes.
class GrossSpells {
 public:
  GrossSpells(const GnssReceiverParams& params, Rng rng)
      : sigma_m_(params.gnss_outlier_m),
        leave_(std::min(1.0, 1 / (params.gnss_outlier_s * params.gnss_hz))),
        enter_(leave_ * params.gnss_outlier_ratio / (1 - params.gnss_outlier_ratio)),
        rng_(rng) {
    if (rng_.uniform() < params.gnss_outlier_ratio) begin();
  }

  Eigen::Vector3d next() {
    const Eigen::Vector3d now = error_m_;
    const double chance = rng_.uniform();
    if (inside_ && chance < leave_)
      inside_ = false, error_m_.setZero();
    else if (!inside_ && chance < enter_)
      begin();
    return now;
  }

 private:
  void begin() {
    inside_ = true;
    error_m_ = fix_noise(rng_, sigma_m_);
  }

  double sigma_m_, leave_, enter_;
  Rng rng_;
  bool inside_ = false;
  Eigen::Vector3d error_m_ = Eigen::Vector3d::Zero();
};

}  // namespace

std::vector<PositionFix> simulate_gnss(const TrueMotion& motion, const GnssReceiverParams& params,
                                       const Rng& rng) {
  std::vector<PositionFix> fixes;
  if (params.gnss_hz <= 0) return fixes;
  Rng noise = rng.split("noise");
  GrossSpells gross(params, rng.split("gross"));
  for (std::int64_t k = 0;; ++k) {
    const Stamp stamp = Stamp::from_seconds(static_cast<double>(k) / params.gnss_hz);
    if (motion.end() < stamp) return fixes;
    fixes.push_back(
        {stamp, motion.pose_at(stamp).translation() + fix_noise(noise, params.gnss_sigma_m) + gross.next(),
         params.gnss_sigma_m});
  }
}

}  // namespace radioslam
