#include "radioslam/pipeline/inertial_guide.hpp"

#include <gtest/gtest.h>

#include "inertial/smooth_motion.hpp"

namespace radioslam {
namespace {

constexpr double kFirst_s = 1, kScans_hz = 10;
constexpr SweptTime kSweep{-0.02, 0.03, 0.08};

/// Exact readings, and exact poses in a frame that leans.
struct ExactDrive {
  test::SmoothMotion motion;
  std::vector<InertialSample> samples;

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
    pose.outcome = k == 0 ? ScanOutcome::kFirst : ScanOutcome::kRegistered;
    pose.information.diagonal() << 1e6, 1e6, 1e6, 1e8, 1e8, 1e8;
    return pose;
  }
};

/// How far a guess of scan k is from the truth, about the scan before and within the sweep.
struct GuessErrors {
  double motion_m = 0, motion_rad = 0;
  double sweep_m = 0, sweep_rad = 0;
};

double error_rad(const SE3& error) { return error.log().tail<3>().norm(); }

GuessErrors errors_of(const ScanGuess& guess, const ExactDrive& drive, int k) {
  GuessErrors errors;
  const SE3 motion = guess.T_previous_body->inverse() * drive.truth(k - 1).inverse() * drive.truth(k);
  errors.motion_m = motion.translation().norm();
  errors.motion_rad = error_rad(motion);
  for (std::size_t n = 0; n < guess.way.poses.size(); ++n) {
    const SE3 way = drive.truth(k).inverse() * drive.truth(k, guess.way.time_of(n));
    const SE3 error = guess.way.poses[n].inverse() * way;
    errors.sweep_m = std::max(errors.sweep_m, error.translation().norm());
    errors.sweep_rad = std::max(errors.sweep_rad, error_rad(error));
  }
  return errors;
}

/// Where scans are laid: exactly, or as far off at their stamps as the guess that unbent them, which leaves
/// the middles of their sweeps right.
enum class LaidScans { kExactly, kRightInTheMiddle };

/// The worst guesses of the scans from `from_s` after the first one on, up to `to_s`.
GuessErrors worst_errors(const ExactDrive& drive, double from_s, double to_s,
                         LaidScans laid = LaidScans::kExactly) {
  InertialGuide guide(drive.samples, {});
  GuessErrors worst;
  for (int k = 0; k <= std::lround(to_s * kScans_hz); ++k) {
    ScanPose scan = drive.scan(k);
    const auto guess = guide.guess(scan.stamp, kSweep);
    EXPECT_EQ(guess.has_value(), k > 1) << k;
    if (guess && k >= from_s * kScans_hz) {
      const GuessErrors errors = errors_of(*guess, drive, k);
      worst.motion_m = std::max(worst.motion_m, errors.motion_m);
      worst.motion_rad = std::max(worst.motion_rad, errors.motion_rad);
      worst.sweep_m = std::max(worst.sweep_m, errors.sweep_m);
      worst.sweep_rad = std::max(worst.sweep_rad, errors.sweep_rad);
    }
    if (laid == LaidScans::kRightInTheMiddle && !guess)
      scan.T_start_body = scan.T_start_body * SE3({0.02 * k, 0, 0}, Eigen::Quaterniond::Identity());
    if (laid == LaidScans::kRightInTheMiddle && guess)
      scan.T_start_body = scan.T_start_body * drive.truth(k).inverse() * drive.truth(k, kSweep.middle_s) *
                          guess->way.middle().inverse();
    guide.add(scan, guess);
  }
  return worst;
}

/// Once gravity is known, on exact readings and poses the guess is the motion.
TEST(InertialGuide, KnowsTheMotion) {
  for (std::uint64_t n = 0; n < 3; ++n) {
    const GuessErrors worst = worst_errors(ExactDrive(n), 3.1, 14);
    EXPECT_LT(worst.motion_m, 1e-3) << n;
    EXPECT_LT(worst.motion_rad, 1e-4) << n;
    EXPECT_LT(worst.sweep_m, 1e-3) << n;
    EXPECT_LT(worst.sweep_rad, 1e-4) << n;
  }
}

/// Until then the gyroscope tells the turns, and the velocity is that of the last step.
TEST(InertialGuide, KnowsTheTurnsBeforeItKnowsGravity) {
  for (std::uint64_t n = 0; n < 3; ++n) {
    const GuessErrors worst = worst_errors(ExactDrive(n), 0.2, 2.9);
    EXPECT_LT(worst.motion_rad, 1e-4) << n;
    EXPECT_LT(worst.sweep_rad, 1e-4) << n;
    EXPECT_LT(worst.motion_m, 0.1) << n;
  }
}

/// A body that keeps its velocity: though its first scans lie where they should not, two that were unbent by
/// a wrong velocity tell the right one. An error would otherwise come back with every scan.
TEST(InertialGuide, KnowsAnEvenMotionFromTheFifthScanOn) {
  const ExactDrive drive(5, {0, 0, 1, 2, 0});
  const GuessErrors worst = worst_errors(drive, 0.4, 2.9, LaidScans::kRightInTheMiddle);
  EXPECT_LT(worst.motion_m, 1e-6);
  EXPECT_LT(worst.sweep_m, 1e-6);
  EXPECT_LT(worst.motion_rad, 1e-6);
}

TEST(InertialGuide, HasNoGuessWhereReadingsAreMissing) {
  ExactDrive drive(6);
  std::erase_if(drive.samples,
                [](const InertialSample& s) { return 2 < s.stamp.seconds() && s.stamp.seconds() < 2.5; });
  InertialGuide guide(drive.samples, {});
  for (int k = 0; k <= 20; ++k) {
    const ScanPose scan = drive.scan(k);
    const auto guess = guide.guess(scan.stamp, {});
    // Scans at 2.1 to 2.4 s lie in the gap, the one at 2.5 s after it.
    EXPECT_EQ(guess.has_value(), k > 1 && (k <= 10 || k > 15)) << k;
    guide.add(scan, guess);
  }
}

}  // namespace
}  // namespace radioslam
