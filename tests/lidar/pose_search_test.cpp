#include "radioslam/lidar/pose_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lidar/scanned_room.hpp"
#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

using namespace test;

constexpr double kMapSpacing_m = 0.25;

/// A scan from `T_room_scan`, to be found on the map of scans from these poses.
struct SearchedScan {
  LocalMap map;
  ScanPyramid scan;
};

SearchedScan searched_scan(const ScannedRoom& room, const std::vector<SE3>& places, const SE3& T_room_scan,
                           std::uint64_t seed, ScannerKind kind = ScannerKind::kSpatial, double max_m = 100) {
  Rng rng(seed);
  Scanner scanner = kind == ScannerKind::kPlanar ? planar_scanner() : Scanner();
  if (kind == ScannerKind::kSpatial) scanner.azimuths = 180;
  scanner.max_m = max_m;
  SearchedScan result{LocalMap(kMapSpacing_m, {}), {}};
  for (const SE3& place : places)
    result.map.add(pyramid_of(sweep(room, scanner, place, rng), kMapSpacing_m, kind), place, 0);
  result.scan = pyramid_of(sweep(room, scanner, T_room_scan, rng), kMapSpacing_m, kind);
  return result;
}

UncertainPose<SE3> guess_at(const SE3& pose, double sigma_m, double sigma_yaw_rad) {
  UncertainPose<SE3> guess{pose};
  guess.covariance.diagonal().setConstant(1e-4);
  guess.covariance.diagonal().head<2>().setConstant(sigma_m * sigma_m);
  guess.covariance(5, 5) = sigma_yaw_rad * sigma_yaw_rad;
  return guess;
}

std::vector<SE3> places_in_furnished_room() {
  return {pose_at(-3.5, 0, 1.2, 0), pose_at(0, 0.4, 1.2, 1), pose_at(3, -1, 1.2, 2)};
}

void expect_found(const PoseSearch& found, const SE3& expected) {
  EXPECT_LT(distance_between(found.best().T_target_source, expected), 0.05);
  EXPECT_LT(angle_between(found.best().T_target_source, expected), 0.5 * kDegree);
}

/// Inlier ratio of the best pose that is distinct from the best of all.
double next_ratio(const PoseSearch& found) { return found.fits.size() > 1 ? found.fits[1].inlier_ratio : 0; }

TEST(SearchPose, FindsAScanFromMetresAndFortyDegreesOff) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar})
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      Rng rng(50 + seed);
      const double x = rng.uniform(-2.5, 2.5), y = rng.uniform(-1, 1);
      const SE3 truth = pose_at(x, y, 1.2, rng.uniform(-3, 3));
      const auto [map, scan] = searched_scan(furnished_room(), places_in_furnished_room(), truth, seed, kind);
      const double side = rng.uniform(-3, 3);
      const SE3 guess = pose_at(x + 3 * std::cos(side), y + 3 * std::sin(side), 1.2,
                                truth.yaw() + (seed % 2 == 0 ? 40 : -40) * kDegree);
      const auto found = search_pose(Submap(map), scan, guess_at(guess, 1.5, 20 * kDegree), kind, {}, {});
      expect_found(found, truth);
      EXPECT_LT(next_ratio(found), 0.9 * found.best().inlier_ratio) << seed;
    }
}

/// The true pose is outside the window and is not found.
TEST(SearchPose, LooksWithinItsWindow) {
  const SE3 truth = pose_at(0.5, 0.2, 1.2, 0.4);
  const auto [map, scan] = searched_scan(furnished_room(), places_in_furnished_room(), truth, 1);
  const SE3 far = pose_at(4.5, 0.2, 1.2, 0.4 + 170 * kDegree);
  const auto found =
      search_pose(Submap(map), scan, guess_at(far, 0.1, 2 * kDegree), ScannerKind::kSpatial, {}, {});
  EXPECT_GT(angle_between(found.best().T_target_source, truth), 90 * kDegree);
}

TEST(SearchPose, OfAGuessThatIsRightNeedsNoWindow) {
  const SE3 truth = pose_at(0.5, 0.2, 1.2, 0.4);
  const auto [map, scan] = searched_scan(furnished_room(), places_in_furnished_room(), truth, 2);
  const auto found = search_pose(Submap(map), scan, {truth}, ScannerKind::kSpatial, {}, {});
  expect_found(found, truth);
  EXPECT_EQ(next_ratio(found), 0);
}

/// Identical pillars every four metres, and no wall in range.
SearchedScan scan_among_pillars(const SE3& T_hall_scan, ScannerKind kind) {
  ScannedRoom hall;
  hall.boxes = {{{-100, -100, 0}, {100, 100, 4}}};
  for (int x = -6; x <= 6; ++x)
    for (int y = -6; y <= 6; ++y) hall.pillars.push_back({{4.0 * x, 4.0 * y}, 0.4});
  std::vector<SE3> places;
  for (const double x : {-6.0, -2.0, 2.0, 6.0})
    for (const double y : {-6.0, -2.0, 2.0, 6.0}) places.push_back(pose_at(x, y, 1.2, 0.3 * x + y));
  return searched_scan(hall, places, T_hall_scan, 3, kind, 10);
}

TEST(SearchPose, AmongIdenticalPillarsReportsASimilarAlternative) {
  for (const ScannerKind kind : {ScannerKind::kSpatial, ScannerKind::kPlanar}) {
    const SE3 truth = pose_at(1.5, 1.8, 1.2, 0.2);
    const auto [map, scan] = scan_among_pillars(truth, kind);
    const auto wide = search_pose(Submap(map), scan, guess_at(truth, 2, 5 * kDegree), kind, {}, {});
    EXPECT_GT(next_ratio(wide), 0.95 * wide.best().inlier_ratio);
    const auto narrow = search_pose(Submap(map), scan, guess_at(truth, 0.3, 5 * kDegree), kind, {}, {});
    EXPECT_LT(next_ratio(narrow), 0.9 * narrow.best().inlier_ratio);
    expect_found(narrow, truth);
  }
}

/// In the middle of a square room four headings look the same at one position.
TEST(SearchPose, CountsAnotherHeadingAsADistinctPose) {
  ScannedRoom square;
  square.boxes = {{{-5, -5, 0}, {5, 5, 3}}};
  const SE3 truth = pose_at(0, 0, 1.2, 0);
  const auto [map, scan] = searched_scan(square, {truth}, truth, 4);
  const auto found =
      search_pose(Submap(map), scan, guess_at(truth, 0.1, 60 * kDegree), ScannerKind::kSpatial, {}, {});
  EXPECT_GT(next_ratio(found), 0.9 * found.best().inlier_ratio);
}

/// A window of a thousand kilometres has more initial poses than an int can count.
TEST(SearchPose, OfAnUninformativeEstimateStillTerminates) {
  const SE3 truth = pose_at(0, 0, 1.2, 0);
  const auto [map, scan] = searched_scan(furnished_room(), {truth}, truth, 5);
  PoseSearchParams search;
  search.max_starts = 1000;
  for (const double sigma_m : {1e3, 1e6, 1e12, kNothing_m}) {
    const auto found =
        search_pose(Submap(map), scan, guess_at(truth, sigma_m, 100), ScannerKind::kSpatial, search, {});
    EXPECT_LE(found.best().inlier_ratio, 1) << sigma_m;
  }
}

TEST(SearchPose, GivesTheSameBytesForAnyNumberOfThreads) {
  const SE3 truth = pose_at(0.5, 0.2, 1.2, 0.4);
  const auto [map, scan] = searched_scan(furnished_room(), places_in_furnished_room(), truth, 6);
  const auto guess = guess_at(pose_at(2, -0.5, 1.2, 0.9), 1, 20 * kDegree);
  set_thread_count(1);
  const auto alone = search_pose(Submap(map), scan, guess, ScannerKind::kSpatial, {}, {});
  set_thread_count(3);
  const auto together = search_pose(Submap(map), scan, guess, ScannerKind::kSpatial, {}, {});
  set_thread_count(0);
  EXPECT_EQ(alone.best().T_target_source.translation(), together.best().T_target_source.translation());
  EXPECT_EQ(alone.best().T_target_source.rotation().coeffs(),
            together.best().T_target_source.rotation().coeffs());
  EXPECT_EQ(alone.best().information, together.best().information);
  EXPECT_EQ(next_ratio(alone), next_ratio(together));
}

TEST(RegisterFrom, TakesTheFirstStartThatIsGoodEnoughElseTheBest) {
  const SE3 truth = pose_at(0.5, 0.2, 1.2, 0.4);
  const auto [map, scan] = searched_scan(furnished_room(), places_in_furnished_room(), truth, 7);
  const std::vector<SE3> starts{pose_at(-2, -0.5, 1.2, 2.5), pose_at(0.9, 0, 1.2, 0.5), truth};
  const auto best = register_best_of(map, scan, starts, 2, ScannerKind::kSpatial, {});
  EXPECT_LT(distance_between(best.T_target_source, truth), 0.05);
  const auto first = register_best_of(map, scan, starts, 0, ScannerKind::kSpatial, {});
  EXPECT_GT(distance_between(first.T_target_source, truth), 0.5);
  EXPECT_EQ(register_best_of(map, scan, {}, 0, ScannerKind::kSpatial, {}).inlier_ratio, 0);
}

TEST(RegisterNear, KeepsThePriorWhereScansDoNotConstrain) {
  const SE3 truth = pose_at(0.5, 0.2, 1.2, 0.4);
  const auto [map, scan] = searched_scan(furnished_room(), places_in_furnished_room(), truth, 8);
  PosePrior prior{truth * SE3::exp(planar_motion(0.1, 0.1, 0.02))};
  prior.information.diagonal().setConstant(1e12);
  const auto held = register_near(map, scan, prior, 0.2, ScannerKind::kSpatial, {});
  EXPECT_LT((prior.pose.inverse() * held.T_target_source).log().norm(), 1e-4);
  prior.information.diagonal().setConstant(1);
  const auto free = register_near(map, scan, prior, 0.2, ScannerKind::kSpatial, {});
  EXPECT_LT(distance_between(free.T_target_source, truth), 0.03);
}

}  // namespace
}  // namespace radioslam
