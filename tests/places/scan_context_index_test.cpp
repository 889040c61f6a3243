#include "radioslam/places/scan_context_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "places/scanned_town.hpp"

namespace radioslam {
namespace {

using namespace test;

struct Drives {
  std::vector<TownPose> places, queries;
  std::vector<ScanContext> contexts, query_contexts;
};

/// One robot's drive, and places up to 3 m from it where another robot with any heading scans.
const Drives& drives() {
  static const Drives made = [] {
    Drives drives;
    Rng rng(1);
    const Town town = random_town(6, rng);
    const TownScanner scanner;
    const auto context_at = [&](const TownPose& pose) {
      return make_scan_context(scan_town(town, pose, scanner, rng), scanner.max_range_m,
                               ScanContextKind::kHeight, {});
    };
    drives.places = drive(town, 800, 2, rng);
    for (const TownPose& pose : drives.places) drives.contexts.push_back(context_at(pose));
    for (int k = 0; k < 100; ++k) {
      drives.queries.push_back(revisited(drives.places[rng.below(drives.places.size())], 3, rng));
      drives.query_contexts.push_back(context_at(drives.queries.back()));
    }
    return drives;
  }();
  return made;
}

ScanContextIndex index_of(const std::vector<ScanContext>& contexts, const ScanContextIndexParams& params) {
  ScanContextIndex index(params);
  for (const ScanContext& context : contexts) index.add(context);
  return index;
}

double recall(const ScanContextIndex& index) {
  int found = 0;
  for (const ScanContext& query : drives().query_contexts) {
    const Neighbour nearest = index.nearest(query, 1).front(),
                    best = index.nearest_exhaustively(query, 1).front();
    if (nearest.index == best.index || nearest.match.distance - best.match.distance < 1e-9) ++found;
  }
  return found / static_cast<double>(drives().query_contexts.size());
}

TEST(ScanContextIndex, FindsTheBestOfAll) {
  // A fifth by their keys, and a tenth of these by coarse correlation, as among 10,000 by default.
  EXPECT_GE(recall(index_of(drives().contexts, {"spectral", 160, 16})), 0.98);
  EXPECT_GE(recall(index_of(drives().contexts, {"spectral", 160, 160})), 0.98);
  EXPECT_GE(recall(index_of(drives().contexts, {"ring", 160, 160})), 0.9);
  EXPECT_EQ(recall(index_of(drives().contexts, {"spectral", 1000, 1000})), 1);
}

TEST(ScanContextIndex, FindsThePlaceAndTheHeading) {
  const ScanContextIndex index = index_of(drives().contexts, {"spectral", 160, 16});
  int right = 0;
  for (std::size_t k = 0; k < drives().queries.size(); ++k) {
    const Neighbour found = index.nearest(drives().query_contexts[k], 1).front();
    const TownPose &query = drives().queries[k], &place = drives().places[found.index];
    const double yaw_rad = place.yaw_rad - query.yaw_rad;
    if ((place.position - query.position).norm() < 5 &&
        std::abs(std::remainder(found.match.yaw_rad - yaw_rad, 2 * std::numbers::pi)) < 0.15)
      ++right;
  }
  EXPECT_GE(right, 90);
}

TEST(ScanContextIndex, ReturnsTheNearestInOrderWithTheirMatches) {
  const ScanContextIndex index = index_of(drives().contexts, {"spectral", 160, 16});
  for (const ScanContext& query : drives().query_contexts) {
    const auto found = index.nearest(query, 5);
    ASSERT_EQ(found.size(), 5U);
    for (const Neighbour& one : found)
      EXPECT_EQ(one.match.distance, compare(query, index.context(one.index)).distance);
    EXPECT_TRUE(std::is_sorted(found.begin(), found.end(), [](const Neighbour& a, const Neighbour& b) {
      return a.match.distance < b.match.distance;
    }));
  }
}

TEST(ScanContextIndex, ReturnsAllowedContextsOnly) {
  const ScanContextIndex index = index_of(drives().contexts, {"spectral", 160, 16});
  const auto third = [](std::size_t k) { return k % 3 == 1; };
  for (const ScanContext& query : drives().query_contexts) {
    const auto found = index.nearest(query, 20, third), all = index.nearest_exhaustively(query, 1000, third);
    EXPECT_EQ(found.size(), 20U);
    EXPECT_EQ(all.size(), 267U);
    std::set<std::size_t> indices;
    for (const Neighbour& neighbour : found) indices.insert(neighbour.index);
    EXPECT_EQ(indices.size(), found.size());
    for (const std::size_t k : indices) EXPECT_TRUE(third(k));
  }
  EXPECT_TRUE(index.nearest(drives().query_contexts.front(), 1, [](std::size_t) { return false; }).empty());
}

TEST(ScanContextIndex, OfNothingFindsNothing) {
  const ScanContextIndex index({});
  EXPECT_EQ(index.size(), 0U);
  EXPECT_TRUE(index.nearest(drives().query_contexts.front(), 3).empty());
  EXPECT_TRUE(index.nearest_exhaustively(drives().query_contexts.front(), 3).empty());
}

TEST(ScanContextIndex, HasDistanceOneToEmptyScans) {
  const ScanContext nothing(Eigen::MatrixXf::Zero(20, 60), 0.25);
  ScanContextIndex index = index_of(drives().contexts, {"spectral", 160, 16});
  EXPECT_EQ(index.nearest(nothing, 1).front().match.distance, 1);
  index.add(nothing);
  for (const Neighbour& found : index.nearest(drives().query_contexts.front(), 10))
    EXPECT_NE(found.index, 800U);
}

TEST(ScanContextIndex, FindsTheSameEveryTimeAndFromAnyThread) {
  const ScanContextIndex index = index_of(drives().contexts, {"spectral", 160, 16});
  const ScanContextIndex again = index_of(drives().contexts, {"spectral", 160, 16});
  const auto search = [&](const ScanContextIndex& searched) {
    std::vector<std::pair<std::size_t, double>> found;
    for (const ScanContext& query : drives().query_contexts)
      for (const Neighbour& one : searched.nearest(query, 3))
        found.emplace_back(one.index, one.match.distance);
    return found;
  };
  const auto expected = search(index);
  std::vector<std::pair<std::size_t, double>> first, second;
  std::thread one([&] { first = search(again); }), other([&] { second = search(again); });
  one.join();
  other.join();
  EXPECT_EQ(first, expected);
  EXPECT_EQ(second, expected);
}

}  // namespace
}  // namespace radioslam
