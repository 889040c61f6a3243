#include "radioslam/io/mission/anchor_tables.hpp"

#include "io/refusal.hpp"

namespace radioslam {
namespace {

DistanceTable distances(const std::string& text) { return read_distances(make_text("d.csv", text), 0.02); }

const std::string kRangeHeader = "t_s,robot_i,robot_j,range_m,sigma_m,antenna_i,antenna_j\n";

RangeTable anchor_ranges(const std::string& rows) {
  return read_anchor_ranges(make_text("r.csv", kRangeHeader + rows), {"A", "B"});
}

TEST(Distances, NumberTheirAnchorsAsTheyCome) {
  const auto table = distances("distance_m,id_j,id_i,sigma_m\n3,B,A,\n4,A,C,0.5\n3.1,A,B,0.1\n");
  EXPECT_EQ(table.anchors, (std::vector<std::string>{"A", "B", "C"}));
  ASSERT_EQ(table.distances.size(), 3U);
  EXPECT_EQ(table.distances[0].j, 1U);
  EXPECT_EQ(table.distances[0].sigma_m, 0.02) << "the default";
  EXPECT_EQ(table.distances[1].i, 2U);
  EXPECT_EQ(table.distances[1].sigma_m, 0.5);
  EXPECT_EQ(table.distances[2].distance_m, 3.1) << "repeated ones count again";
}

TEST(Distances, RefuseMalformedRows) {
  const std::string header = "id_i,id_j,distance_m\n";
  expect_refusal([&] { distances(header + "A,B,1\nA,A,1\n"); }, 3, "'A' to itself");
  expect_refusal([&] { distances(header + "A,B,0\n"); }, 2, "a distance is not positive");
  expect_refusal([&] { distances(header + "A,B,-1\n"); }, 2, "a distance is not positive");
  expect_refusal([&] { distances(header + "A,,1\n"); }, 2, "is not a valid file name");
  expect_refusal([&] { distances(header + "A,B,x\n"); }, 2, "distance_m");
  expect_refusal([&] { distances("id_i,id_j,distance_m,sigma_m\nA,B,1,0\n"); }, 2, "a sigma is not positive");
  expect_refusal([&] { distances("id_i,id_j\nA,B\n"); }, 1, "distance_m");
}

TEST(AnchorRanges, AreSortedToTheirRobotsAndPairsOfAntennas) {
  const auto table = anchor_ranges(
      "2,r,A,1,0.1,front,\n1,B,r,2,0.1,,front\n3,A,r,3,0.1,,back\n4,r,A,4,0.2,front,\n1,s,B,5,0.1,,x\n"
      "1,r,s,6,0.1,,\n1,A,B,7,0.1,,\n");
  ASSERT_EQ(table.receivers.size(), 2U);
  const auto& r = table.receivers[0];
  EXPECT_EQ(r.robot, "r");
  ASSERT_EQ(r.pairs.size(), 3U);
  EXPECT_EQ(r.pairs[0].receiver, "r/front");
  EXPECT_EQ(r.pairs[0].anchor, "A");
  EXPECT_EQ(r.pairs[1].anchor, "B");
  EXPECT_EQ(r.pairs[2].receiver, "r/back");
  ASSERT_EQ(r.ranges.size(), 4U);
  EXPECT_EQ(r.ranges[0].sight.range_m, 2) << "in the order of time";
  EXPECT_EQ(r.ranges[0].sight.anchor, 1U);
  EXPECT_EQ(r.ranges[3].pair, 0U);
  EXPECT_EQ(r.ranges[3].sight.sigma_m, 0.2);
  EXPECT_EQ(table.receivers[1].pairs[0].anchor, "B/x");
  EXPECT_EQ(table.between_receivers, 1U);
  EXPECT_EQ(table.between_anchors, 1U);
}

TEST(AnchorRanges, RefuseMalformedRows) {
  expect_refusal([] { anchor_ranges("1,r,r,2,0.1,,\n"); }, 2, "to itself");
  expect_refusal([] { anchor_ranges("1,r,A,0,0.1,,\n"); }, 2, "a range is not positive");
  expect_refusal([] { anchor_ranges("1,r,A,2,0,,\n"); }, 2, "a sigma is not positive");
  expect_refusal([] { anchor_ranges("1,r,s,2,0.1,,\n"); }, 0, "between a robot and one of the anchors");
  expect_refusal([] { anchor_ranges("1,../r,A,2,0.1,,\n"); }, 2, "is not a valid file name");
}

}  // namespace
}  // namespace radioslam
