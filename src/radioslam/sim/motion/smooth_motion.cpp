#include "radioslam/sim/motion/smooth_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kMinSwing_s = 6, kMaxSwing_s = 20;
constexpr double kMinSway_s = 1.5, kMaxSway_s = 5;

/// One sine of the speed variation or of the sway.
struct RideWave {
  double rate_radps = 0;
  double phase_rad = 0;
};
using RideWaves = std::array<RideWave, 3>;

RideWaves draw_waves(double min_s, double max_s, Rng rng) {
  RideWaves waves;
  for (auto& wave : waves)
    wave = {2 * std::numbers::pi / rng.uniform(min_s, max_s), rng.uniform(0, 2 * std::numbers::pi)};
  return waves;
}

/// Sum of sines with variance 1.
double sum_of_sines(const RideWaves& waves, double t_s) {
  double sum = 0;
  for (const auto& wave : waves) sum += std::sin(wave.rate_radps * t_s + wave.phase_rad);
  return sum * std::sqrt(2.0 / static_cast<double>(waves.size()));
}

/// Deviations of the smooth motion from its given poses.
class RideStyle {
 public:
  RideStyle(const SmoothMotionParams& params, const Rng& rng)
      : params_(params),
        swing_(draw_waves(kMinSwing_s, kMaxSwing_s, rng.split("swing"))),
        roll_(draw_waves(kMinSway_s, kMaxSway_s, rng.split("roll"))),
        pitch_(draw_waves(kMinSway_s, kMaxSway_s, rng.split("pitch"))) {}

  /// Time tau of the given poses at a time of the smooth motion.
  double pose_time_s(double t_s) const {
    const double ratio = std::clamp((t_s - params_.rest_s) / params_.accelerate_s, 0.0, 1.0);
    const double late_s = std::max(0.0, t_s - params_.rest_s - params_.accelerate_s);
    const double steady_s = params_.accelerate_s * ratio * ratio * ratio * (1 - ratio / 2) + late_s;
    double swung_s = steady_s;
    for (const auto& wave : swing_) {
      const double reach_s = params_.speed_swing / (static_cast<double>(swing_.size()) * wave.rate_radps);
      swung_s += reach_s * (std::sin(wave.rate_radps * steady_s + wave.phase_rad) - std::sin(wave.phase_rad));
    }
    return swung_s;
  }

  Eigen::Quaterniond sway(double pose_time_s) const {
    return so3_exp(params_.sway_rad *
                   Eigen::Vector3d(sum_of_sines(roll_, pose_time_s), sum_of_sines(pitch_, pose_time_s), 0));
  }

 private:
  const SmoothMotionParams& params_;
  RideWaves swing_, roll_, pitch_;
};

}  // namespace

SplineMotion smooth_motion(const Trajectory<SE3>& poses, const SmoothMotionParams& params, const Rng& rng) {
  RADIOSLAM_CHECK(!poses.empty(), "a smooth motion needs poses");
  constexpr std::size_t kMinControls = 4;
  const RideStyle style(params, rng);
  std::vector<SE3> controls;
  for (int k = -1;; ++k) {
    const double tau_s = style.pose_time_s(std::max(0, k) * params.knot_s);
    const Stamp stamp = Stamp::from_seconds(tau_s);
    if (stamp > poses.back().stamp && controls.size() >= kMinControls) break;
    const SE3 pose = *poses.at(std::clamp(stamp, poses.front().stamp, poses.back().stamp));
    controls.emplace_back(pose.translation(), pose.rotation() * style.sway(tau_s));
  }
  return SplineMotion(std::move(controls), params.knot_s);
}

}  // namespace radioslam
