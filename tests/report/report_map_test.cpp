// Maps of the team, and position fixes, on the page.
#include <gtest/gtest.h>

#include "report/sample_page.hpp"

namespace radioslam {
namespace {

using namespace sample;

RunResult result_with_map() {
  RunResult result;
  result.robots.emplace_back().id = "a";
  result.robots.emplace_back().id = "b";
  MapResult& map = result.maps.emplace_back();
  map.robots = {"b"};
  map.voxel_m = 0.1;
  map.all_points = 7;
  map.grid = {0.5, {-1, 2}, 3, 2, {}};
  using enum CellState;
  map.grid.cells = {kFree, kFree, kOccupied, kUnknown, kOccupied, kOccupied};
  return result;
}

TEST(ReportMap, AGridIsRunsOfUnknownFreeAndOccupiedCellsInTurn) {
  const Json map = data_of(render_report(result_with_map()))["maps"][0];
  EXPECT_EQ(map["robots"], Json::parse("[1]"));
  EXPECT_EQ(map["grid"]["runs"], Json::parse("[0, 2, 1, 1, 0, 2]"));
  EXPECT_EQ(map["grid"]["width"], 3);
  EXPECT_EQ(map["grid"]["x0"], -1);
  EXPECT_FALSE(map.contains("points"));
}

TEST(ReportMap, PointsAreStepsBetweenTheirLimits) {
  RunResult result = result_with_map();
  result.maps[0].points = {{{1, 2, 3}, {0, 0, 1}, 0, 4, 0}, {{3, 2, 4}, {0, 0, 1}, 0, 6, 0}};
  const Json points = data_of(render_report(result))["maps"][0]["points"];
  EXPECT_EQ(points["count"], 2);
  EXPECT_EQ(points["low"], Json::parse("[1, 2, 3, 4]"));
  EXPECT_EQ(points["high"], Json::parse("[3, 2, 4, 6]"));
  // x: 0 65535, y: 0 0, z: 0 65535, time: 0 65535, robots 0 0
  EXPECT_EQ(points["data"], "AAD//wAAAAAAAP//AAD//wAA");
}

TEST(ReportMap, RobotsWithoutScansAndFixesHaveNothingOfThem) {
  RunResult result;
  result.robots.emplace_back().id = "a";
  const Json page = data_of(render_report(result));
  EXPECT_TRUE(page["maps"].empty());
  EXPECT_FALSE(page["robots"][0].contains("fixes"));
}

TEST(ReportMap, FixesAreCounted) {
  RunResult result;
  result.robots.emplace_back().id = "a";
  result.robots[0].fixes = FixResult{30, 4, 0, true, ""};
  const Json fixes = data_of(render_report(result))["robots"][0]["fixes"];
  EXPECT_EQ(fixes["used"], 30);
  EXPECT_EQ(fixes["rejected"], 4);
}

}  // namespace
}  // namespace radioslam
