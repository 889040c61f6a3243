#include "radioslam/radio/fingerprints/access_point_fixes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "radioslam/base/random.hpp"

namespace radioslam {
namespace {

constexpr double kHeight_m = 2, kPower_dbm = -46, kExponent = 2.8;

/// One robot along a path of 90 m through a hall with eight access points, whose positions are stated.
struct Hall {
  Mission mission;
  std::vector<std::vector<PlacedFingerprint>> robots = std::vector<std::vector<PlacedFingerprint>>(1);
  std::vector<Eigen::Vector2d> places_m;

  explicit Hall(double noise_db) {
    const std::vector<Eigen::Vector2d> points{{0, 0},  {20, 2},  {40, -1}, {61, 0},
                                              {2, 30}, {19, 28}, {41, 31}, {60, 29}};
    for (std::size_t a = 0; a < points.size(); ++a) {
      mission.access_points.push_back("02:aa:00:00:00:0" + std::to_string(a));
      mission.anchors.push_back(
          {"02-AA-00-00-00-0" + std::to_string(a), Eigen::Vector3d(points[a].x(), points[a].y(), 2.8), 0.5});
    }
    mission.robots.emplace_back().id = "a";
    Rng rng = Rng(7).split("noise");
    for (int k = 0; k <= 90; ++k) {
      const Eigen::Vector2d place(k < 60 ? k : 60, k < 60 ? 15 : 15 - (k - 60) / 2.0);
      PlacedFingerprint placed;
      placed.fingerprint.stamp = Stamp::from_seconds(k);
      placed.travelled_m = k;
      for (std::size_t a = 0; a < points.size(); ++a) {
        const double distance_m = std::hypot((place - points[a]).norm(), kHeight_m);
        const double rss = kPower_dbm - 10 * kExponent * std::log10(distance_m) + noise_db * rng.normal();
        placed.fingerprint.entries.push_back({AccessPointIndex(a), static_cast<float>(rss), 1});
      }
      places_m.push_back(place);
      robots[0].push_back(placed);
    }
  }

  /// Params for transmitters that are all alike.
  static AccessPointFixParams alike() {
    AccessPointFixParams params;
    params.known_sigma_db = 4;
    return params;
  }
  AccessPointFixes fixes(const AccessPointFixParams& params = alike()) const {
    return fixes_by_access_points(mission, robots, params, {});
  }
  double error_m(const PositionFix& fix) const {
    return (fix.position_m.head<2>() - places_m[static_cast<std::size_t>(fix.stamp.seconds())]).norm();
  }
};

TEST(AccessPointFixes, AreWhereTheFingerprintsWereTaken) {
  const Hall hall(3);
  const AccessPointFixes fixes = hall.fixes();
  EXPECT_EQ(fixes.known.size(), 8U) << "addresses in another spelling";
  ASSERT_EQ(fixes.robots[0].size(), 12U) << "one per 8 m of path";
  for (const PositionFix& fix : fixes.robots[0]) {
    EXPECT_LT(hall.error_m(fix), 3 * fix.sigma_m);
    EXPECT_LT(hall.error_m(fix), 12);
    EXPECT_GT(fix.sigma_m, 2) << "the model is no better than this";
  }
}

/// Inverse variances, summed: the weight of all fixes together.
double weight_of(const std::vector<PositionFix>& fixes) {
  double sum = 0;
  for (const PositionFix& fix : fixes) sum += 1 / (fix.sigma_m * fix.sigma_m);
  return sum;
}

TEST(AccessPointFixes, CountAsOneWhereTheyShareTheirErrors) {
  const Hall hall(3);
  AccessPointFixParams few, many;  // of transmitters that differ by some 6 dB
  few.known_spacing_m = 16;
  many.known_spacing_m = 1;
  const auto of_few = hall.fixes(few).robots[0], of_many = hall.fixes(many).robots[0];
  ASSERT_GT(of_many.size(), 10 * of_few.size());
  EXPECT_LT(weight_of(of_many), 1.5 * weight_of(of_few)) << "they come from the same eight transmitters";
  EXPECT_GT(weight_of(of_many), 0.5 * weight_of(of_few));
}

TEST(AccessPointFixes, ATransmitterThatDiffersMovesAllFixesWithinTheirSigma) {
  Hall hall(0.5);
  for (PlacedFingerprint& placed : hall.robots[0]) {
    placed.fingerprint.entries[1].rss_dbm += 9;
    placed.fingerprint.entries[6].rss_dbm -= 6;
  }
  AccessPointFixParams params;
  params.known_max_sigma_m = 40;
  const auto fixes = hall.fixes(params).robots[0];
  ASSERT_GE(fixes.size(), 6U);
  double squares = 0;
  for (const PositionFix& fix : fixes) squares += std::pow(hall.error_m(fix) / fix.sigma_m, 2);
  const double of_all = squares / 2;  // all errors have the same cause: their sum is no more than one's
  EXPECT_LT(of_all, 9) << "the sum over the fixes stays within three standard deviations";
}

TEST(AccessPointFixes, BearAnAccessPointThatIsElsewhere) {
  Hall hall(3);
  hall.mission.anchors[1].position_m = Eigen::Vector3d(60, 70, 2.8);
  const AccessPointFixes fixes = hall.fixes();
  ASSERT_GE(fixes.robots[0].size(), 6U);
  const auto far_off =
      std::count_if(fixes.robots[0].begin(), fixes.robots[0].end(),
                    [&](const PositionFix& fix) { return hall.error_m(fix) > 3 * fix.sigma_m; });
  EXPECT_LE(far_off, 1) << "which those who use them reject";
}

TEST(AccessPointFixes, NeedThreeAccessPointsAndThePlane) {
  Hall hall(3);
  AccessPointFixParams off = Hall::alike();
  off.use_known = false;
  EXPECT_TRUE(hall.fixes(off).robots[0].empty());
  Hall in_space(3);
  in_space.mission.dimension = 3;
  EXPECT_TRUE(in_space.fixes().robots[0].empty());
  EXPECT_EQ(in_space.fixes().known.size(), 8U);
  Hall with_gnss(3);
  with_gnss.mission.robots[0].fixes.push_back({Stamp{}, Eigen::Vector3d::Zero(), 1});
  EXPECT_TRUE(with_gnss.fixes().robots[0].empty()) << "a robot with fixes of its own";
  hall.mission.anchors.resize(2);
  hall.mission.anchors.push_back({"02:aa:00:00:00:05", std::nullopt, 0});
  hall.mission.anchors.push_back({"door", Eigen::Vector3d::Zero(), 0});
  EXPECT_EQ(hall.fixes().known.size(), 2U);
  EXPECT_TRUE(hall.fixes().robots[0].empty());
}

TEST(AccessPointFixes, WhatIsAmbiguousHasALargeSigma) {
  Hall hall(1);
  hall.mission.anchors.resize(4);  // on one line: its two sides look the same
  AccessPointFixParams all = Hall::alike();
  all.known_max_sigma_m = 1000;
  const AccessPointFixes fixes = hall.fixes(all);
  for (const PositionFix& fix : fixes.robots[0]) EXPECT_LT(hall.error_m(fix), 3 * fix.sigma_m);
  EXPECT_LT(hall.fixes().robots[0].size(), 6U) << "most are not precise enough";
}

}  // namespace
}  // namespace radioslam
