// Occupancy images on the page.
#include <gtest/gtest.h>

#include "report/sample_page.hpp"

namespace radioslam {
namespace {

using namespace sample;

TEST(ReportPicture, RowsUnpackToTheCells) {
  RunResult result;
  result.robots.emplace_back().id = "a";
  OccupancyImageResult& picture = result.robots[0].picture.emplace();
  picture.cell_m = 0.25;
  picture.scans = 7;
  picture.cells = {{-3, -1, 1}, {4, -1, 2}, {5, -1, 9}, {0, 2, 100000}};
  const Json data = data_of(render_report(result))["robots"][0]["picture"];
  EXPECT_EQ(data["cell_m"], 0.25);
  EXPECT_EQ(data["scans"], 7);
  EXPECT_EQ(data["cells"], 4);
  EXPECT_EQ(data["rows"], Json::parse("[[-1, -3, 7, 1], [2, 0]]"));
  EXPECT_EQ(data["hits"], Json::parse(R"(["124", "9"])"));
}

TEST(ReportPicture, RobotsWithoutScansAndFixesHaveNothingOfThem) {
  RunResult result;
  result.robots.emplace_back().id = "a";
  const Json robot = data_of(render_report(result))["robots"][0];
  EXPECT_FALSE(robot.contains("picture"));
  EXPECT_FALSE(robot.contains("fixes"));
}

TEST(ReportPicture, FixesAreCounted) {
  RunResult result;
  result.robots.emplace_back().id = "a";
  result.robots[0].fixes = FixResult{30, 4, 0, true, ""};
  const Json fixes = data_of(render_report(result))["robots"][0]["fixes"];
  EXPECT_EQ(fixes["used"], 30);
  EXPECT_EQ(fixes["rejected"], 4);
}

}  // namespace
}  // namespace radioslam
