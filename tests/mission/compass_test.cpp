#include <gtest/gtest.h>

#include "mission/phone_walks.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/dead_reckoning.hpp"

namespace radioslam {
namespace {

using test::KnownWalk;
using test::recorded;

/// Largest error of the heading over the recording.
double heading_error(const KnownWalk& walk) {
  const auto motion = recorded(walk);
  const auto level = level_motion(motion, {});
  const auto fit = fit_compass(level, motion.orientation, {});
  double worst = 0;
  for (std::size_t i = 0; i < level.size(); ++i) {
    const double heading = level[i].heading_rad + fit->correction_rad(level[i].stamp);
    worst = std::max(worst, std::abs(wrap_angle(heading - walk.heading_rad(0.02 * static_cast<double>(i)))));
  }
  return worst;
}

TEST(FitCompass, FindsEastForEveryStart) {
  for (const double start_rad : {0.0, 1.0, 3.1, 3.2, -1.5}) {
    KnownWalk walk;
    walk.R_hand_device = test::tilted_hand();
    walk.heading_rad = [start_rad](double t) { return start_rad + std::sin(t); };
    // The tilted y axis seen from above rotates with the walker, up to a constant.
    const auto motion = recorded(walk);
    const auto level = level_motion(motion, {});
    const auto fit = fit_compass(level, motion.orientation, {});
    ASSERT_TRUE(fit);
    const Eigen::Vector3d forward = motion.orientation[0].R_enu_device * Eigen::Vector3d::UnitY();
    EXPECT_NEAR(wrap_angle(fit->correction_rad(level[0].stamp) - std::atan2(forward.y(), forward.x())), 0,
                5e-3);
    EXPECT_LT(fit->spread_rad, 5e-3);
  }
}

TEST(FitCompass, SteelAlongAThirdOfThePathChangesItLittle) {
  KnownWalk walk;
  walk.compass_error_rad = [](double t) { return t > 8 && t < 18 ? 1.0 : 0.0; };
  EXPECT_LT(heading_error(walk), 0.03);
}

TEST(FitCompass, ALongWalkShowsTheGyroscopesBias) {
  KnownWalk walk;
  walk.duration_s = 600;
  walk.gyroscope_bias_radps = {0, 0, 0.001};  // 0.6 rad in all
  EXPECT_LT(heading_error(walk), 0.02);
}

TEST(FitCompass, AShortWalkPastSteelLeavesTheDriftAtItsPrior) {
  KnownWalk walk;
  walk.duration_s = 10;
  walk.compass_error_rad = [](double t) { return 0.02 * (t - 5); };  // looks like 0.02 rad/s
  const auto motion = recorded(walk);
  const auto fit = fit_compass(level_motion(motion, {}), motion.orientation, {});
  EXPECT_LT(std::abs(fit->drift_radps), 0.002);
  EXPECT_LT(std::abs(wrap_angle(fit->offset_rad)), 0.01);
}

TEST(FitCompass, SaysNothingWithoutReadings) {
  const auto motion = recorded({});
  EXPECT_FALSE(fit_compass(level_motion(motion, {}), {}, {}));
  EXPECT_FALSE(fit_compass({}, motion.orientation, {}));
}

}  // namespace
}  // namespace radioslam
