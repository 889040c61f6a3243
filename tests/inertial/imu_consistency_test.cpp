#include "radioslam/inertial/imu_consistency.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "inertial/smooth_motion.hpp"
#include "radioslam/geometry/so3.hpp"

namespace radioslam {
namespace {

constexpr double kEnd_s = 30, kReadings_hz = 100, kPoses_hz = 10;

/// A drive's poses and IMU samples, both with small errors.
struct Recording {
  Trajectory<SE3> poses;
  std::vector<ImuSample> samples;
};

/// Poses start at 2 s, so that IMU samples with a time offset still cover them.
Recording record(std::uint64_t seed, const test::Liveliness& liveliness) {
  const ImuNoiseParams noise;
  Rng rng = Rng(71).split(seed);
  const test::SmoothMotion motion(rng.split("motion"), liveliness);
  Recording recording{{}, test::perfect_readings(motion, kEnd_s, kReadings_hz, noise)};
  test::add_errors(recording.samples, {{0.01, 0.005, -0.01}, {0.05, -0.05, 0.1}}, kReadings_hz, noise, rng);
  std::vector<StampedPose<SE3>> rows;
  for (int k = 20; k <= (kEnd_s - 2) * kPoses_hz; ++k) {
    SE3::Tangent error;
    error << test::normal_vector(rng, 0.02), test::normal_vector(rng, 0.005);
    rows.push_back({Stamp::from_seconds(k / kPoses_hz), motion.pose(k / kPoses_hz) * SE3::exp(error)});
  }
  recording.poses = Trajectory<SE3>(std::move(rows));
  return recording;
}

constexpr test::Liveliness kTurning{1, 1.5, 2, 0.5, 0.2};

using Spoil = std::function<void(ImuSample&)>;

Recording corrupted(Recording recording, const Spoil& spoil) {
  for (ImuSample& sample : recording.samples) spoil(sample);
  return recording;
}

std::optional<std::string> inconsistency(const Recording& recording) {
  return find_inconsistency(recording.poses, recording.samples, {}, {});
}

/// Whether the reported inconsistency contains these words.
testing::AssertionResult mentions(const Recording& recording, const std::string& words) {
  const auto wrong = inconsistency(recording);
  if (!wrong) return testing::AssertionFailure() << "no inconsistency is reported";
  if (wrong->find(words) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << *wrong;
}

TEST(ReadingAgreement, OfOneBodyIsConsistent) {
  for (std::uint64_t n = 0; n < 5; ++n) EXPECT_EQ(inconsistency(record(n, kTurning)), std::nullopt) << n;
}

/// The first number after these words.
double number_after(const std::string& words, const std::optional<std::string>& text) {
  const auto at = text ? text->find(words) : std::string::npos;
  return at == std::string::npos ? std::nan("") : std::stod(text->substr(at + words.size()));
}

TEST(ReadingAgreement, NamesTheGyroscopesBias) {
  const auto off_by = [](double rate_radps) {
    return corrupted(record(1, kTurning), [=](ImuSample& s) { s.angular_rate_radps.y() += rate_radps; });
  };
  EXPECT_EQ(inconsistency(off_by(0.05)), std::nullopt);  // 5 sigmas are 0.1
  for (const double rate_radps : {0.2, 0.4, 1.5})
    EXPECT_NEAR(number_after("its gyroscope has a bias of ", inconsistency(off_by(rate_radps))), rate_radps,
                0.02);
}

TEST(ReadingAgreement, NamesTheFactorOfTurns) {
  for (const double factor : {3.0, 10.0, -1.0}) {
    const Recording scaled =
        corrupted(record(2, kTurning), [=](ImuSample& s) { s.angular_rate_radps *= factor; });
    EXPECT_NEAR(number_after("its gyroscope measures ", inconsistency(scaled)), factor,
                0.03 * std::abs(factor));
  }
}

/// A factor within the tolerance of rotations is accepted.
TEST(ReadingAgreement, LetsASmallFactorPass) {
  EXPECT_EQ(inconsistency(corrupted(record(3, kTurning), [](ImuSample& s) { s.angular_rate_radps *= 1.03; })),
            std::nullopt);
}

TEST(ReadingAgreement, NamesTheLagOfTheClocks) {
  for (const double lag_s : {-0.8, -0.3, 0.3, 0.8}) {
    const Recording late =
        corrupted(record(4, kTurning), [&](ImuSample& s) { s.stamp.ns += Stamp::from_seconds(lag_s).ns; });
    EXPECT_TRUE(
        mentions(late, lag_s > 0 ? "s too late relative to its scans" : "s too early relative to its scans"))
        << lag_s;
    EXPECT_NEAR(number_after("stamped ", inconsistency(late)), std::abs(lag_s), 0.051);
  }
}

/// Up to a tenth of a second is accepted, although it is significant.
TEST(ReadingAgreement, LetsASmallLagPass) {
  for (const double lag_s : {-0.1, 0.1})
    EXPECT_EQ(inconsistency(corrupted(record(5, {0.2, 1, 5, 0.5, 0.2}),
                                      [&](ImuSample& s) { s.stamp.ns += Stamp::from_seconds(lag_s).ns; })),
              std::nullopt)
        << lag_s;
}

TEST(ReadingAgreement, NamesTheForceThatIsNotGravity) {
  const auto times = [](double factor) {
    return corrupted(record(6, kTurning), [=](ImuSample& s) { s.specific_force_mps2 *= factor; });
  };
  EXPECT_TRUE(mentions(times(1 / 9.81), "are its values in g?"));
  EXPECT_TRUE(mentions(times(2), "m/s^2 instead of gravity's 9.81"));
  EXPECT_FALSE(mentions(times(2), "are its values in g?"));
  EXPECT_EQ(inconsistency(times(1.03)), std::nullopt);
}

TEST(ReadingAgreement, SeesAnotherMounting) {
  const Eigen::Quaterniond mounting = so3_exp({1.2, 0.5, -0.7});
  EXPECT_TRUE(mentions(corrupted(record(7, kTurning),
                                 [&](ImuSample& s) {
                                   s.specific_force_mps2 = mounting * s.specific_force_mps2;
                                   s.angular_rate_radps = mounting * s.angular_rate_radps;
                                 }),
                       "in the body frame?"));
}

/// Without rotation any gyroscope is consistent; the accelerometer is still tested.
TEST(ReadingAgreement, DoesNotTestTheGyroscopeWithoutRotation) {
  const Recording straight = record(8, {1, 0.002, 2, 0.5, 0});
  const auto upset = [](ImuSample& s) {
    s.angular_rate_radps = Eigen::Vector3d(-1, 2, -3).cwiseProduct(s.angular_rate_radps);
  };
  EXPECT_EQ(inconsistency(corrupted(straight, upset)), std::nullopt);
  EXPECT_TRUE(mentions(corrupted(straight, [](ImuSample& s) { s.specific_force_mps2 *= 0.5; }), "gravity"));
}

/// At rest for half a minute, except for five seconds in which it rotates to one side and back.
struct OneLook {
  double yaw_rate(double t) const {
    return 10 < t && t < 15 ? std::sin(2 * std::numbers::pi * (t - 10) / 5) : 0;
  }
  SE3 pose(double t) const {
    const double angle = 2 * std::numbers::pi * (std::clamp(t, 10.0, 15.0) - 10) / 5;
    const double yaw = 5 / (2 * std::numbers::pi) * (1 - std::cos(angle));
    return SE3({0, 0, 0}, so3_exp({0, 0, yaw}));
  }
  ImuSample reading(double t, const Eigen::Vector3d& gravity) const {
    return {Stamp::from_seconds(t), -gravity, {0, 0, yaw_rate(t)}};
  }
};

/// The many windows without rotation do not count.
TEST(ReadingAgreement, UsesOnlyWindowsWithRotation) {
  const OneLook motion;
  Recording recording{{}, test::perfect_readings(motion, kEnd_s, kReadings_hz, {})};
  std::vector<StampedPose<SE3>> rows;
  for (int k = 0; k <= kEnd_s * kPoses_hz; ++k)
    rows.push_back({Stamp::from_seconds(k / kPoses_hz), motion.pose(k / kPoses_hz)});
  recording.poses = Trajectory<SE3>(rows);
  EXPECT_EQ(inconsistency(recording), std::nullopt);
  EXPECT_TRUE(
      mentions(corrupted(recording, [](ImuSample& s) { s.angular_rate_radps *= -1; }), "measures -1 "));
}

/// Every fifth window starts at a wrong pose, and every fifth ends at one.
TEST(ReadingAgreement, IsNotMovedByPosesThatAreWrongNowAndThen) {
  const Recording right = record(9, kTurning);
  Rng rng(72);
  std::vector<StampedPose<SE3>> rows(right.poses.begin(), right.poses.end());
  for (std::size_t k = 0; k < rows.size(); k += 25)
    rows[k].pose = rows[k].pose * SE3({0, 0, 0}, so3_exp(test::normal_vector(rng, 1)));
  EXPECT_EQ(inconsistency({Trajectory<SE3>(rows), right.samples}), std::nullopt);
}

/// The odometry's frame is arbitrary.
TEST(ReadingAgreement, DoesNotDependOnTheFrameOfThePoses) {
  SE3::Tangent frame;
  frame << 10, -20, 3, 0.4, -0.9, 2;
  Recording leaning = record(10, kTurning);
  std::vector<StampedPose<SE3>> rows;
  for (const auto& row : leaning.poses) rows.push_back({row.stamp, SE3::exp(frame) * row.pose});
  leaning.poses = Trajectory<SE3>(std::move(rows));
  EXPECT_EQ(inconsistency(leaning), std::nullopt);
  const auto wrong = corrupted(leaning, [](ImuSample& s) { s.angular_rate_radps *= 3; });
  EXPECT_NEAR(number_after("its gyroscope measures ", inconsistency(wrong)), 3, 0.1);
}

TEST(ReadingAgreement, LooksAtWhatIsThere) {
  Recording half = record(11, kTurning);
  half.samples.erase(half.samples.begin() + 1000, half.samples.begin() + 2000);
  EXPECT_EQ(inconsistency(half), std::nullopt);
  EXPECT_TRUE(mentions(corrupted(half, [](ImuSample& s) { s.angular_rate_radps *= -1; }), "measures -"));
  EXPECT_EQ(inconsistency({half.poses, {}}), std::nullopt);
  EXPECT_EQ(inconsistency({{}, half.samples}), std::nullopt);
}

}  // namespace
}  // namespace radioslam
