#include "radioslam/odometry/imu_motion_prior.hpp"

#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"

namespace radioslam {
namespace {

constexpr double kFirst_s = 1, kScans_hz = 10;
constexpr ScanTimeSpan kSweep{-0.02, 0.03, 0.08};

/// Exact IMU samples, and exact poses in a tilted frame.
struct ExactDrive {
  test::SmoothMotion motion;
  std::vector<ImuSample> samples;

  explicit ExactDrive(std::uint64_t seed, const test::Liveliness& liveliness = {})
      : motion(Rng(91).split(seed), liveliness), samples(test::perfect_readings(motion, 16, 200, {})) {}

  static double time_of(int k) { return kFirst_s + k / kScans_hz; }
  SE3 truth(int k, double later_s = 0) const { return motion.pose(time_of(k) + later_s); }

  ScanPose scan(int k) const {
    SE3::Tangent lean;
    lean << 3, -1, 2, 0.3, -0.2, 1;
    ScanPose pose;
    pose.stamp = Stamp::from_seconds(time_of(k));
    pose.T_start_body = SE3::exp(lean) * truth(k);
    pose.status = k == 0 ? ScanStatus::kMapStart : ScanStatus::kRegistered;
    pose.information.diagonal() << 1e6, 1e6, 1e6, 1e8, 1e8, 1e8;
    return pose;
  }
};

/// Error of the prior of scan k: motion since the previous scan, and motion within the sweep.
struct GuessErrors {
  double motion_m = 0, motion_rad = 0;
  double sweep_m = 0, sweep_rad = 0;
};

double error_rad(const SE3& error) { return error.log().tail<3>().norm(); }

GuessErrors errors_of(const MotionPrior& guess, const ExactDrive& drive, int k) {
  GuessErrors errors;
  const SE3 motion = guess.T_previous_body->inverse() * drive.truth(k - 1).inverse() * drive.truth(k);
  errors.motion_m = motion.translation().norm();
  errors.motion_rad = error_rad(motion);
  for (std::size_t n = 0; n < guess.scan_motion.poses.size(); ++n) {
    const SE3 expected = drive.truth(k).inverse() * drive.truth(k, guess.scan_motion.time_of(n));
    const SE3 error = guess.scan_motion.poses[n].inverse() * expected;
    errors.sweep_m = std::max(errors.sweep_m, error.translation().norm());
    errors.sweep_rad = std::max(errors.sweep_rad, error_rad(error));
  }
  return errors;
}

/// Registered poses: exact, or off at their stamps by the error of the prior that deskewed them, which leaves
/// the middles of their sweeps right.
enum class ScansWithImu { kExactly, kRightInTheMiddle };

/// The worst errors of the priors from `from_s` to `to_s` after the first scan.
GuessErrors worst_errors(const ExactDrive& drive, double from_s, double to_s,
                         ScansWithImu scans = ScansWithImu::kExactly) {
  ImuMotionPrior guide(drive.samples, {});
  GuessErrors worst;
  for (int k = 0; k <= std::lround(to_s * kScans_hz); ++k) {
    ScanPose scan = drive.scan(k);
    const auto guess = guide.predict(scan.stamp, kSweep);
    EXPECT_EQ(guess.has_value(), k > 1) << k;
    if (guess && k >= from_s * kScans_hz) {
      const GuessErrors errors = errors_of(*guess, drive, k);
      worst.motion_m = std::max(worst.motion_m, errors.motion_m);
      worst.motion_rad = std::max(worst.motion_rad, errors.motion_rad);
      worst.sweep_m = std::max(worst.sweep_m, errors.sweep_m);
      worst.sweep_rad = std::max(worst.sweep_rad, errors.sweep_rad);
    }
    if (scans == ScansWithImu::kRightInTheMiddle && !guess)
      scan.T_start_body = scan.T_start_body * SE3({0.02 * k, 0, 0}, Eigen::Quaterniond::Identity());
    if (scans == ScansWithImu::kRightInTheMiddle && guess)
      scan.T_start_body = scan.T_start_body * drive.truth(k).inverse() * drive.truth(k, kSweep.middle_s) *
                          guess->scan_motion.middle().inverse();
    guide.add(scan, guess);
  }
  return worst;
}

/// Once gravity is known, the prior from exact IMU samples and poses equals the motion.
TEST(ImuMotionPrior, KnowsTheMotion) {
  for (std::uint64_t n = 0; n < 3; ++n) {
    const GuessErrors worst = worst_errors(ExactDrive(n), 3.1, 14);
    EXPECT_LT(worst.motion_m, 1e-3) << n;
    EXPECT_LT(worst.motion_rad, 1e-4) << n;
    EXPECT_LT(worst.sweep_m, 1e-3) << n;
    EXPECT_LT(worst.sweep_rad, 1e-4) << n;
  }
}

/// Until then the gyroscope measures rotation, and the velocity is that of the last step.
TEST(ImuMotionPrior, KnowsTheTurnsBeforeItKnowsGravity) {
  for (std::uint64_t n = 0; n < 3; ++n) {
    const GuessErrors worst = worst_errors(ExactDrive(n), 0.2, 2.9);
    EXPECT_LT(worst.motion_rad, 1e-4) << n;
    EXPECT_LT(worst.sweep_rad, 1e-4) << n;
    EXPECT_LT(worst.motion_m, 0.1) << n;
  }
}

/// At constant velocity: although the first poses are wrong, two scans deskewed by a wrong velocity yield the
/// right one. Otherwise the error would return with every scan.
TEST(ImuMotionPrior, KnowsAnEvenMotionFromTheFifthScanOn) {
  const ExactDrive drive(5, {0, 0, 1, 2, 0});
  const GuessErrors worst = worst_errors(drive, 0.4, 2.9, ScansWithImu::kRightInTheMiddle);
  EXPECT_LT(worst.motion_m, 1e-6);
  EXPECT_LT(worst.sweep_m, 1e-6);
  EXPECT_LT(worst.motion_rad, 1e-6);
}

TEST(ImuMotionPrior, HasNoGuessWhereReadingsAreMissing) {
  ExactDrive drive(6);
  std::erase_if(drive.samples,
                [](const ImuSample& s) { return 2 < s.stamp.seconds() && s.stamp.seconds() < 2.5; });
  ImuMotionPrior guide(drive.samples, {});
  for (int k = 0; k <= 20; ++k) {
    const ScanPose scan = drive.scan(k);
    const auto guess = guide.predict(scan.stamp, {});
    // Scans at 2.1 to 2.4 s are in the gap, the one at 2.5 s after it.
    EXPECT_EQ(guess.has_value(), k > 1 && (k <= 10 || k > 15)) << k;
    guide.add(scan, guess);
  }
}

}  // namespace
}  // namespace radioslam
