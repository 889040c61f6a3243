#include "radioslam/radio/fingerprints/access_points.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

const PathLoss kLaw{-38, 2.8};
constexpr double kHeight_m = 2;

double heard_dbm(const Eigen::Vector2d& from, const Eigen::Vector2d& at) {
  return kLaw.power_dbm(std::hypot((from - at).norm(), kHeight_m));
}

/// Readings along a straight path of 60 m on x.
RssAlongPath straight_path(const Eigen::Vector2d& access_point) {
  RssAlongPath heard;
  for (double x = 0; x <= 60; x += 2) heard.readings.push_back({{x, 0}, heard_dbm(access_point, {x, 0})});
  return heard;
}

/// The straight path, continued along y.
RssAlongPath path_with_turn(const Eigen::Vector2d& access_point) {
  RssAlongPath heard = straight_path(access_point);
  for (double y = 2; y <= 40; y += 2) heard.readings.push_back({{60, y}, heard_dbm(access_point, {60, y})});
  return heard;
}

TEST(AccessPoints, ExactReadingsGiveThePlaceAndTheLaw) {
  const Eigen::Vector2d truth(45, 14);
  RssAlongPath heard = path_with_turn(truth);
  for (double x = 58; x >= 0; x -= 2) heard.readings.push_back({{x, 40}, heard_dbm(truth, {x, 40})});
  const auto fit = fit_access_point(heard, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->status, AccessPointStatus::kFound);
  EXPECT_LT((fit->position_m - truth).norm(), 0.5);
  EXPECT_NEAR(fit->path_loss.exponent, kLaw.exponent, 0.15);
  EXPECT_NEAR(fit->path_loss.power_at_1m_dbm, kLaw.power_at_1m_dbm, 2);
  EXPECT_EQ(fit->places, 81U);
}

TEST(AccessPoints, AStraightPathHasAMirrorSolution) {
  const Eigen::Vector2d truth(30, 12);
  const auto fit = fit_access_point(straight_path(truth), {});
  ASSERT_TRUE(fit);
  ASSERT_EQ(fit->status, AccessPointStatus::kAmbiguous);
  ASSERT_TRUE(fit->alternative_m);
  EXPECT_NEAR(std::abs(fit->position_m.y()), truth.y(), 2);
  EXPECT_NEAR(fit->position_m.y(), -fit->alternative_m->y(), 0.1);
  EXPECT_NEAR(fit->alternative_m->x(), truth.x(), 1);
}

TEST(AccessPoints, AUniformlyWeakSignalIsPoorlyConstrained) {
  RssAlongPath heard;
  for (double x = 0; x <= 20; x += 2) heard.readings.push_back({{x, 0}, -85});
  const auto fit = fit_access_point(heard, {});
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->status, AccessPointStatus::kPoorlyConstrained);
}

TEST(AccessPoints, FewPlacesAreNoAccessPoint) {
  RssAlongPath heard = path_with_turn({45, 14});
  heard.readings.resize(7);
  EXPECT_FALSE(fit_access_point(heard, {}));
  EXPECT_FALSE(fit_access_point({}, {}));
}

TEST(AccessPoints, AFewOutliersMoveItLittle) {
  const Eigen::Vector2d truth(45, 14);
  RssAlongPath heard = path_with_turn(truth);
  for (std::size_t k = 3; k < heard.readings.size(); k += 11) heard.readings[k].rss_dbm -= 25;
  const auto fit = fit_access_point(heard, {});
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->position_m - truth).norm(), 4);
}

TEST(AccessPoints, ManyReadingsOfAPlaceAreOnePlace) {
  RssAlongPath heard = path_with_turn({45, 14});
  const auto once = fit_access_point(heard, {});
  const std::vector<PlacedReading> each = heard.readings;
  for (int again = 0; again < 9; ++again)
    heard.readings.insert(heard.readings.end(), each.begin(), each.end());
  const auto often = fit_access_point(heard, {});
  ASSERT_TRUE(once && often);
  EXPECT_EQ(often->places, once->places);
  EXPECT_GT(often->covariance(0, 0), 0.5 * once->covariance(0, 0));
  AccessPointParams few;
  few.max_places = 20;
  EXPECT_LE(fit_access_point(heard, few)->places, 20U);
}

TEST(AccessPoints, MissingDetectionsConstrainTheExponent) {
  // A path that leads away: only the part above the detection threshold has readings.
  const Eigen::Vector2d truth(0, 5);
  RssAlongPath heard;
  heard.floor_dbm = -75;
  for (double x = 0; x <= 150; x += 2) {
    const double rss_dbm = heard_dbm(truth, {x, 0}) + (static_cast<int>(x) % 4 == 0 ? 6 : -6);
    if (rss_dbm > heard.floor_dbm)
      heard.readings.push_back({{x, 0}, rss_dbm});
    else
      heard.undetected_m.emplace_back(x, 0);
  }
  RssAlongPath without_undetected = heard;
  without_undetected.undetected_m.clear();
  const auto with = fit_access_point(heard, {}), without = fit_access_point(without_undetected, {});
  ASSERT_TRUE(with && without);
  EXPECT_GT(with->path_loss.exponent, without->path_loss.exponent + 0.1);
}

/// With shadowing as modelled along a path with a turn, errors match the covariance.
TEST(AccessPoints, TheTruthLiesWithinTheCovariance) {
  const AccessPointParams params;
  const Rng rng(7);
  double sum = 0;
  int runs = 0;
  for (std::uint64_t run = 0; run < 40; ++run) {
    Rng own = rng.split(run);
    const Eigen::Vector2d truth(own.uniform(20, 70), own.uniform(-10, 35));
    RssAlongPath heard = path_with_turn(truth);
    double shadowing_db = own.normal(0, params.sigma_shadowing_db);
    const double kept = std::exp(-2 / params.shadowing_length_m);
    for (PlacedReading& reading : heard.readings) {
      reading.rss_dbm += shadowing_db + own.normal(0, params.sigma_fading_db);
      shadowing_db =
          kept * shadowing_db + own.normal(0, params.sigma_shadowing_db * std::sqrt(1 - kept * kept));
    }
    const auto fit = fit_access_point(heard, params);
    ASSERT_TRUE(fit);
    if (fit->status != AccessPointStatus::kFound) continue;
    const Eigen::Vector2d off = fit->position_m - truth;
    sum += off.dot(fit->covariance.topLeftCorner<2, 2>().inverse() * off) / 2;
    ++runs;
  }
  ASSERT_GT(runs, 15);
  EXPECT_GT(sum / runs, 0.4);
  EXPECT_LT(sum / runs, 2);
}

}  // namespace
}  // namespace radioslam
