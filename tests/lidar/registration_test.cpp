#include "radioslam/lidar/registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "lidar/scanned_room.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/lidar/surfels/surfel_map.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kChiSquared6 = 22.458;  // 99.9 %

/// Exhaustive nearest-neighbour search.
NearestSurfel nearest_of(const std::vector<Surfel>& surfels) {
  return [&surfels](const Eigen::Vector3f& point, float squared_reach) {
    const Surfel* nearest = nullptr;
    for (const Surfel& surfel : surfels) {
      const float squared = (surfel.position - point).squaredNorm();
      if (squared >= squared_reach) continue;
      squared_reach = squared;
      nearest = &surfel;
    }
    return nearest;
  };
}

NearestSurfel nearest_on(const SurfelMap& map) {
  return [&map](const Eigen::Vector3f& point, float squared) { return map.nearest(point, squared); };
}

/// Converges tightly and does not discount normal noise.
RegistrationParams exact_params() {
  RegistrationParams params;
  params.max_iterations = 200;
  params.translation_tolerance_m = params.rotation_tolerance_rad = 1e-7;
  params.normal_noise_factor = 0;
  return params;
}

/// Scattered points with isotropic covariance.
std::vector<Surfel> scattered_surfels(int count, double sigma_m, std::uint64_t seed) {
  Rng rng(seed);
  std::vector<Surfel> surfels;
  for (int k = 0; k < count; ++k) {
    const double x = rng.uniform(-5, 5), y = rng.uniform(-5, 5), z = rng.uniform(-1, 2);
    const auto variance = static_cast<float>(sigma_m * sigma_m);
    surfels.push_back({Eigen::Vector3d(x, y, z).cast<float>(), variance * Eigen::Matrix3f::Identity()});
  }
  return surfels;
}

SE3 tilted_pose() {
  SE3::Tangent xi;
  xi << 3, -2, 0.4, 0.2, -0.1, 1.1;
  return SE3::exp(xi);
}

/// Two scans of one room, half a metre and some degrees apart.
struct ScanPair {
  ScannerKind kind;
  SurfelMap map;
  SurfelSource source;
  SE3 T_target_source;

  Registration align(const SE3& start, const PosePrior& prior = {}) const {
    return register_surfels(nearest_on(map), source, {start, 0.3, map.max_distance_m()}, prior, kind, {});
  }
};

ScanPair scan_pair(const ScannedRoom& room, ScannerKind kind, std::uint64_t seed) {
  const double spacing_m = 0.15;
  Rng noise(seed), places = noise.split("places");
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 120;
  const double x = places.uniform(-1.5, 1.5), y = places.uniform(-1, 1), yaw = places.uniform(-3, 3);
  const double forward = places.uniform(-0.5, 0.5), aside = places.uniform(-0.2, 0.2);
  const SE3 T_room_a = pose_at(x, y, 1.2, yaw);
  const SE3 T_a_b = SE3::exp(planar_motion(forward, aside, places.uniform(-0.2, 0.2)));
  ScanPair pair{kind, SurfelMap(spacing_m, 0.75), {}, T_a_b};
  pair.map.add(surfels_of(sweep(room, scanner, T_room_a, noise), spacing_m, kind), 0);
  pair.source = pyramid_of(sweep(room, scanner, T_room_a * T_a_b, noise), spacing_m, kind).source;
  return pair;
}

/// Normalised squared error per degree of freedom that the scanner observes.
double normalised_squares(const ScanPair& pair, const Registration& fit) {
  const SE3::Tangent error = (pair.T_target_source.inverse() * fit.T_target_source).log();
  const std::array<int, 3> plane{0, 1, 5};
  if (pair.kind == ScannerKind::kSpatial) return error.dot(fit.information * error) / 6;
  return error(plane).dot(fit.information(plane, plane) * error(plane)) / 3;
}

TEST(RegisterSurfels, FindsAPoseFromThirtyCentimetresAndFiveDegreesOff) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const ScanPair pair = scan_pair(furnished_room(), kind, seed);
      const double side = 30.0 * static_cast<double>(seed) * kDegree;
      const SE3 off =
          SE3::exp(planar_motion(0.3 * std::cos(side), 0.3 * std::sin(side), seed % 2 == 0 ? 0.087 : -0.087));
      const Registration fit = pair.align(pair.T_target_source * off);
      EXPECT_NE(fit.end, RegistrationStatus::kNoOverlap);
      EXPECT_LT(6 * normalised_squares(pair, fit), kChiSquared6) << seed;
      const SE3 error = pair.T_target_source.inverse() * fit.T_target_source;
      EXPECT_LT(error.translation().head<2>().norm(), 0.02) << seed;
      EXPECT_LT(std::abs(error.yaw()), 0.2 * kDegree) << seed;
      EXPECT_GT(fit.inlier_ratio, 0.6);
    }
}

/// Mean NEES over a hundred pairs: one if the information matches the errors, more if it is overconfident.
double mean_nees(const ScannedRoom& room, ScannerKind kind) {
  double mean = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const ScanPair pair = scan_pair(room, kind, 1000 + seed);
    const SE3 off = SE3::exp(planar_motion(0.1, -0.05, 0.03));
    mean += normalised_squares(pair, pair.align(pair.T_target_source * off)) / 100;
  }
  testing::Test::RecordProperty("mean_nees", std::to_string(mean));
  return mean;
}

TEST(RegisterSurfels, IsNotOverconfidentInSpace) {
  EXPECT_LT(mean_nees(furnished_room(), ScannerKind::kSpatial), 1.5);
}

TEST(RegisterSurfels, IsNotOverconfidentInThePlane) {
  EXPECT_LT(mean_nees(furnished_room(), ScannerKind::kPlanar), 1.5);
}

TEST(RegisterSurfels, OfACloudOntoItselfMovedFindsTheMotion) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const SurfelSource source{scattered_surfels(400, 0.05, seed)};
    const auto moved = transformed(tilted_pose(), source.surfels);
    SE3::Tangent off;
    off << 0.1, -0.08, 0.06, 0.02, -0.015, 0.03;
    const RegistrationStart start{tilted_pose() * SE3::exp(off), 0.1, 1};
    const auto fit =
        register_surfels(nearest_of(moved), source, start, {}, ScannerKind::kSpatial, exact_params());
    EXPECT_EQ(fit.end, RegistrationStatus::kConverged);
    EXPECT_LT((tilted_pose().inverse() * fit.T_target_source).log().norm(), 1e-4);
    EXPECT_NEAR(fit.inlier_ratio, 1, 1e-3);
    EXPECT_LT(fit.normalised_rms, 1e-2);
  }
}

/// The sum of J' J / (2 sigma^2), J = [I, -[p]x]: two clouds of the same noise, at rest.
TEST(RegisterSurfels, ReturnsTheInformationOfKnownPoints) {
  const double sigma_m = 0.05;
  for (const double ratio : {1.0, 0.25}) {
    const SurfelSource source{scattered_surfels(300, sigma_m, 7), ratio};
    SE3::Jacobian expected = SE3::Jacobian::Zero();
    for (const Surfel& surfel : source.surfels) {
      Eigen::Matrix<double, 3, 6> jacobian;
      jacobian << Eigen::Matrix3d::Identity(), -skew(surfel.position.cast<double>());
      expected += ratio / (2 * sigma_m * sigma_m) * jacobian.transpose() * jacobian;
    }
    const auto fit = register_surfels(nearest_of(source.surfels), source, {SE3(), 0, 1}, {},
                                      ScannerKind::kSpatial, exact_params());
    EXPECT_LT((fit.information - expected).norm(), 1e-4 * expected.norm());
    EXPECT_LT((fit.posterior - expected).norm(), 1e-4 * expected.norm());
  }
}

/// Mean NEES of a cloud registered to itself with noise: by the sandwich of posterior and noise, whatever
/// sigma its surfels state. `alike`: points in the same fifteen degrees of azimuth share their noise.
double nees_of_noise(double stated_m, bool alike) {
  const double actual_m = 0.02;
  const int trials = 60;
  double mean = 0;
  for (std::uint64_t seed = 0; seed < trials; ++seed) {
    const std::vector<Surfel> target = scattered_surfels(300, stated_m, seed);
    SurfelSource source{target};
    Rng rng(500 + seed);
    std::vector<Eigen::Vector3f> shared(48);
    const auto noise = [&] {
      return (actual_m * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()))
          .eval()
          .cast<float>()
          .eval();
    };
    for (Eigen::Vector3f& offset : shared) offset = noise();
    for (Surfel& surfel : source.surfels) {
      const float turn = std::atan2(surfel.position.y(), surfel.position.x()) / float(kDegree) + 180;
      const auto sector = static_cast<std::size_t>(turn / 15) % 24 + (surfel.position.z() > 0 ? 24 : 0);
      surfel.position += alike ? shared[sector] : noise();
    }
    const auto fit = register_surfels(nearest_of(target), source, {SE3(), 0, 1}, {}, ScannerKind::kSpatial,
                                      exact_params());
    const SE3::Jacobian back = fit.posterior.inverse();
    const SE3::Tangent error = fit.T_target_source.log();
    mean += error.dot((back * fit.noise * back).inverse() * error) / (6 * trials);
  }
  return mean;
}

TEST(RegisterSurfels, KnowsTheNoiseOfItsPointsWhateverTheyState) {
  for (const double stated_m : {0.02, 0.05})
    for (const bool alike : {false, true}) {
      EXPECT_GT(nees_of_noise(stated_m, alike), 0.4) << stated_m << alike;
      EXPECT_LT(nees_of_noise(stated_m, alike), 2) << stated_m << alike;
    }
}

/// With equal information, the result is half way between the measurement and the prior.
TEST(RegisterSurfels, IsMidwayBetweenMeasurementAndPriorOfEqualInformation) {
  const SurfelSource source{scattered_surfels(300, 0.05, 8)};
  const auto moved = transformed(SE3::exp(planar_motion(0.06, 0, 0)), source.surfels);
  RegistrationParams params = exact_params();
  params.loss_scale = 100;  // squares, or nearly so
  const RegistrationStart start{SE3(), 0, 1};
  const auto free = register_surfels(nearest_of(moved), source, start, {}, ScannerKind::kSpatial, params);
  EXPECT_NEAR(free.T_target_source.translation().x(), 0.06, 1e-3);
  const PosePrior prior{SE3(), free.information};
  const auto fit = register_surfels(nearest_of(moved), source, start, prior, ScannerKind::kSpatial, params);
  EXPECT_NEAR(fit.T_target_source.translation().x(), 0.03, 1e-3);
  EXPECT_LT((fit.posterior - 2 * free.information).norm(), 0.02 * free.information.norm());
}

TEST(RegisterSurfels, TurnsWithItsTarget) {
  const ScanPair pair = scan_pair(furnished_room(), ScannerKind::kSpatial, 3);
  const auto target = pair.map.surfels(), turned = transformed(tilted_pose(), target);
  const SE3 start = pair.T_target_source * SE3::exp(planar_motion(0.1, 0.1, 0.04));
  const auto fit =
      register_surfels(nearest_of(target), pair.source, {start, 0.2, 0.75}, {}, pair.kind, exact_params());
  const auto other = register_surfels(nearest_of(turned), pair.source, {tilted_pose() * start, 0.2, 0.75}, {},
                                      pair.kind, exact_params());
  const SE3 expected = tilted_pose() * fit.T_target_source;
  EXPECT_LT((expected.inverse() * other.T_target_source).log().norm(), 1e-3);
  EXPECT_LT((other.information - fit.information).norm(), 0.02 * fit.information.norm());
}

/// T Exp(xi) B = T B Exp(Ad(B)^-1 xi).
TEST(RegisterSurfels, TurnsWithItsSource) {
  const ScanPair pair = scan_pair(furnished_room(), ScannerKind::kSpatial, 4);
  const auto target = pair.map.surfels();
  const SE3 start = pair.T_target_source * SE3::exp(planar_motion(0.1, 0.1, 0.04));
  const SE3 B = tilted_pose();
  const SurfelSource turned{transformed(B.inverse(), pair.source.surfels),
                            pair.source.effective_sample_ratio};
  const auto fit =
      register_surfels(nearest_of(target), pair.source, {start, 0.2, 0.75}, {}, pair.kind, exact_params());
  const auto other =
      register_surfels(nearest_of(target), turned, {start * B, 0.2, 0.75}, {}, pair.kind, exact_params());
  const SE3 expected = fit.T_target_source * B;
  EXPECT_LT((expected.inverse() * other.T_target_source).log().norm(), 1e-3);
  const SE3::Jacobian carry = B.adjoint();
  const SE3::Jacobian information = carry.transpose() * fit.information * carry;
  EXPECT_LT((other.information - information).norm(), 0.02 * information.norm());
}

TEST(RegisterSurfels, OfAPlanarScannerLeavesHeightRollAndPitchAsTheyWere) {
  const ScanPair pair = scan_pair(furnished_room(), ScannerKind::kPlanar, 5);
  const Registration fit = pair.align(pair.T_target_source * SE3::exp(planar_motion(0.2, -0.1, 0.05)));
  EXPECT_EQ(fit.T_target_source.translation().z(), 0);
  EXPECT_EQ(fit.T_target_source.rotation().x(), 0);
  EXPECT_EQ(fit.T_target_source.rotation().y(), 0);
  EXPECT_LT(distance_between(fit.T_target_source, pair.T_target_source), 0.03);
}

TEST(RegisterSurfels, WithoutOverlapReportsItAndKeepsTheInitialPose) {
  const SurfelSource source{scattered_surfels(300, 0.05, 9)};
  const SE3 start = pose_at(100, 0, 0, 0.3);
  const auto expect_refusal = [&](const std::vector<Surfel>& target, const SurfelSource& of) {
    const auto fit = register_surfels(nearest_of(target), of, {start, 0.2, 1}, {}, ScannerKind::kSpatial, {});
    EXPECT_EQ(fit.end, RegistrationStatus::kNoOverlap);
    EXPECT_EQ(fit.inlier_ratio, 0);
    EXPECT_TRUE(fit.information.isZero(0));
    EXPECT_LT((start.inverse() * fit.T_target_source).log().norm(), 1e-12);
  };
  expect_refusal(source.surfels, source);
  expect_refusal({}, source);
  expect_refusal(source.surfels, {});
  const SurfelSource few{scattered_surfels(5, 0.05, 9)};  // too few to constrain a pose
  expect_refusal(transformed(start, few.surfels), few);
}

/// A featureless corridor without visible ends.
struct CorridorScans {
  SurfelMap map{0.1, 0.3};
  SurfelSource source;
  SE3 T_target_source = pose_at(0.5, 0.1, 0, 0);
};

CorridorScans corridor_scans(ScannerKind kind, std::uint64_t seed) {
  ScannedRoom corridor;
  corridor.boxes = {{{-1000, -1.5, 0}, {1000, 1.5, 2.5}}};
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  scanner.max_m = 25;
  Rng rng(seed);
  CorridorScans scans;
  scans.map.add(surfels_of(sweep(corridor, scanner, pose_at(0, 0, 1.2, 0), rng), 0.1, kind), 0);
  scans.source = pyramid_of(sweep(corridor, scanner, pose_at(0.5, 0.1, 1.2, 0), rng), 0.1, kind).source;
  return scans;
}

/// Motion along the corridor is unobservable, and its information reflects that.
TEST(RegisterSurfels, HasNoInformationAlongACorridor) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const double off_m : {-0.2, 0.0, 0.2}) {
      const CorridorScans scans = corridor_scans(ScannerKind::kSpatial, seed);
      PosePrior prior{scans.T_target_source * SE3::exp(planar_motion(off_m, 0.03, 0.01))};
      prior.information.diagonal().setConstant(100);  // 10 cm
      const auto fit = register_surfels(nearest_on(scans.map), scans.source, {prior.pose, 0.1, 0.3}, prior,
                                        ScannerKind::kSpatial, {});
      EXPECT_NEAR(fit.T_target_source.translation().y(), 0.1, 0.01);
      EXPECT_LT(fit.information(0, 0), 0.002 * fit.information(1, 1));
      EXPECT_LT(std::abs((scans.T_target_source.inverse() * fit.T_target_source).yaw()), 0.2 * kDegree);
    }
}

/// Normal noise is discounted and little else. The information never exceeds that of the points, in combined
/// rotations and shifts either: off the centre of a round hall, only their combination is unobservable.
TEST(RegisterSurfels, HasNoMoreInformationThanItsPointsInAnyDirection) {
  ScannedRoom round_hall;
  round_hall.boxes = {{{-20, -20, 0}, {20, 20, 3}}};
  round_hall.pillars = {{{4, 0}, 8}};
  ScannedRoom corridor;
  corridor.boxes = {{{-1000, -1.5, 0}, {1000, 1.5, 2.5}}};
  for (const ScannedRoom& room : {round_hall, corridor, furnished_room()})
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      Rng rng(seed);
      Scanner scanner;
      scanner.max_m = 25;
      SurfelMap map(0.1, 0.3);
      map.add(surfels_of(sweep(room, scanner, pose_at(0, 0, 1.2, 0), rng), 0.1, ScannerKind::kSpatial), 0);
      const SE3 moved = pose_at(0.05, 0.03, 1.2, 0.3);
      const SurfelSource source =
          pyramid_of(sweep(room, scanner, moved, rng), 0.1, ScannerKind::kSpatial).source;
      RegistrationParams once;
      once.max_iterations = 1;  // both at the same pose
      const auto information_by = [&](double normal_noise_factor) {
        once.normal_noise_factor = normal_noise_factor;
        return register_surfels(nearest_on(map), source, {pose_at(0.05, 0.03, 0, 0.3), 0, 0.3}, {},
                                ScannerKind::kSpatial, once)
            .information;
      };
      const SE3::Jacobian all = information_by(0), discounted = information_by(2);
      const auto smallest = [](const SE3::Jacobian& m) {
        return Eigen::SelfAdjointEigenSolver<SE3::Jacobian>(m).eigenvalues()[0];
      };
      EXPECT_GE(smallest(all - discounted), -1e-9 * all.norm());
      EXPECT_GE(smallest(discounted), -1e-9 * all.norm());
      EXPECT_GT(discounted(1, 1), 0.9 * all(1, 1));  // towards the walls
    }
}

/// Along the corridor the pose keeps the prior despite the spurious information of many noisy normals.
TEST(RegisterSurfels, KeepsThePriorAlongACorridor) {
  for (std::uint64_t seed = 0; seed < 4; ++seed)
    for (const double off_m : {-0.2, 0.0, 0.2}) {
      const CorridorScans scans = corridor_scans(ScannerKind::kSpatial, seed);
      PosePrior prior{scans.T_target_source * SE3::exp(planar_motion(off_m, 0.03, 0))};
      prior.information.diagonal().setConstant(1);
      const auto fit = register_surfels(nearest_on(scans.map), scans.source, {prior.pose, 0.1, 0.3}, prior,
                                        ScannerKind::kSpatial, {});
      EXPECT_NEAR((prior.pose.inverse() * fit.T_target_source).translation().x(), 0, 0.01) << off_m;
    }
}

/// Points without normals are matched to nearby planar surfels of the map.
TEST(RegisterSurfels, MatchesIsolatedPointsToSurfacesOnly) {
  const double spacing_m = 0.1;
  Rng rng(12);
  SurfelMap map(spacing_m, 0.3);
  const SE3 T_room_a = pose_at(0.5, 0.3, 1.2, 0.4), T_a_b = SE3::exp(planar_motion(0.05, -0.03, 0.02));
  Scanner scanner;
  map.add(surfels_of(sweep(furnished_room(), scanner, T_room_a, rng), spacing_m, ScannerKind::kSpatial), 0);
  SurfelSource points =
      pyramid_of(sweep(furnished_room(), scanner, T_room_a * T_a_b, rng), spacing_m, ScannerKind::kSpatial)
          .source;
  for (Surfel& surfel : points.surfels)
    surfel = {surfel.position, 4e-4F * Eigen::Matrix3f::Identity(), 0, SurfelShape::kIsolated};
  const auto align = [&](const NearestSurfel& target) {
    return register_surfels(target, points, {SE3(), 0.05, 0.3}, {}, ScannerKind::kSpatial, {});
  };
  const Registration fit = align(nearest_on(map));
  const SE3::Tangent error = (T_a_b.inverse() * fit.T_target_source).log();
  EXPECT_LT(error.head<2>().norm(), 0.02);
  EXPECT_LT(error.dot(fit.information * error), kChiSquared6) << error.transpose();
  // Scan lines on the floor match no surface, so height is not observed.
  for (const int axis : {0, 1, 5}) EXPECT_GT(fit.information(axis, axis), 1000);
  EXPECT_TRUE(align(nearest_of(points.surfels)).information.isZero(0));
}

/// Scan lines on the ground ahead, in successive scans: they constrain height as well as the ground is level
/// between them.
TEST(RegisterSurfels, KnowsTheHeightOfLinesAsWellAsGroundIsLevel) {
  const SurfelParams surfel;
  const double variance_m2 = surfel.sigma_range_m * surfel.sigma_range_m;
  const double slope_rad2 = surfel.line_slope_rad * surfel.line_slope_rad;
  const auto lines_at = [&](double x_m) {
    std::vector<Eigen::Vector3f> beam;
    for (int k = -20; k <= 20; ++k) beam.emplace_back(Eigen::Vector3d(x_m, 0.08 * k, -1).cast<float>());
    return measure_surfels(beam, 0.1, ScannerKind::kSpatial, surfel);
  };
  RegistrationParams once;
  once.max_iterations = 1;
  for (const double between_m : {0.0, 0.1, 0.2}) {
    const auto before = lines_at(8 + between_m);
    const SurfelSource now{lines_at(8)};
    const auto lines =
        static_cast<double>(std::ranges::count(now.surfels, SurfelShape::kScanLine, &Surfel::shape));
    ASSERT_GT(lines, 30);
    const SE3::Jacobian information =
        register_surfels(nearest_of(before), now, {SE3(), 0, 0.3}, {}, ScannerKind::kSpatial, once)
            .information;
    const double each = 1 / (2 * variance_m2 + slope_rad2 * between_m * between_m);
    EXPECT_NEAR(information(2, 2), lines * each, 0.01 * lines * each) << between_m;
    for (const int axis : {0, 1, 5}) EXPECT_LT(information(axis, axis), 0.01 * information(2, 2)) << axis;
  }
}

/// For a planar scanner, the visible ends of the walls constrain motion along the corridor a little.
TEST(RegisterSurfels, HasFarLessInformationAlongACorridorThanAcross) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const CorridorScans scans = corridor_scans(ScannerKind::kPlanar, seed);
    const auto fit = register_surfels(nearest_on(scans.map), scans.source, {scans.T_target_source, 0.1, 0.3},
                                      {scans.T_target_source}, ScannerKind::kPlanar, {});
    EXPECT_NEAR(fit.T_target_source.translation().y(), 0.1, 0.01);
    EXPECT_LT(fit.information(0, 0), 0.1 * fit.information(1, 1));
  }
}

/// Steps along an axis with almost all information discounted are no longer than elsewhere.
TEST(RegisterSurfels, DoesNotOvershootWhatItTrustsLess) {
  const SurfelSource source{scattered_surfels(300, 0.05, 10)};
  const auto moved = transformed(SE3::exp(planar_motion(0.03, -0.02, 0.01)), source.surfels);
  RegistrationParams params = exact_params();
  for (const double normal_noise_factor : {0.0, 0.3, 0.5}) {
    params.normal_noise_factor = normal_noise_factor;
    params.max_iterations = 1;
    const auto step =
        register_surfels(nearest_of(moved), source, {SE3(), 0, 1}, {}, ScannerKind::kSpatial, params);
    EXPECT_NEAR(step.T_target_source.translation().x(), 0.03, 0.003) << normal_noise_factor;
    EXPECT_NEAR(step.T_target_source.translation().y(), -0.02, 0.003) << normal_noise_factor;
    EXPECT_NEAR(step.T_target_source.yaw(), 0.01, 0.003) << normal_noise_factor;
  }
}

/// Six points in a clump can rotate a scanner far from them out of their correspondence distance.
TEST(RegisterSurfels, ReportsOverlapLostDuringIterations) {
  int lost = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Rng rng(seed);
    SurfelSource source;
    std::vector<Surfel> target;
    for (int k = 0; k < 6; ++k) {
      Eigen::Vector3f at(60, 0, 0), target_point(60, 0, 0);
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] += static_cast<float>(rng.normal(0, 0.3));
        target_point[axis] += static_cast<float>(rng.normal(0.2, 0.3));
      }
      source.surfels.push_back({at, 0.001F * Eigen::Matrix3f::Identity()});
      target.push_back({target_point, 0.001F * Eigen::Matrix3f::Identity()});
    }
    const auto fit =
        register_surfels(nearest_of(target), source, {SE3(), 0, 1}, {}, ScannerKind::kSpatial, {});
    EXPECT_TRUE(fit.T_target_source.translation().allFinite());
    EXPECT_TRUE(fit.information.allFinite());
    if (fit.end != RegistrationStatus::kNoOverlap) continue;
    ++lost;
    EXPECT_EQ(fit.inlier_ratio, 0) << seed;
    EXPECT_TRUE(fit.information.isZero(0)) << seed;
    EXPECT_LT(fit.T_target_source.log().norm(), 1e-12) << seed;
  }
  EXPECT_GT(lost, 0) << "the task is too easy";
}

TEST(RegisterSurfels, GivesTheSameBytesForAnyNumberOfThreads) {
  const ScanPair pair = scan_pair(furnished_room(), ScannerKind::kSpatial, 6);
  const SE3 start = pair.T_target_source * SE3::exp(planar_motion(0.2, 0.1, -0.05));
  set_thread_count(1);
  const Registration alone = pair.align(start);
  for (const std::size_t threads : {2U, 5U}) {
    set_thread_count(threads);
    const Registration together = pair.align(start);
    EXPECT_EQ(together.T_target_source.translation(), alone.T_target_source.translation());
    EXPECT_EQ(together.T_target_source.rotation().coeffs(), alone.T_target_source.rotation().coeffs());
    EXPECT_EQ(together.information, alone.information);
    EXPECT_EQ(together.inlier_ratio, alone.inlier_ratio);
    EXPECT_EQ(together.normalised_rms, alone.normalised_rms);
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace radioslam
