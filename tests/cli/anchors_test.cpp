// radioslam anchors from its tables to the output folder.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

struct Place {
  const char* id;
  double x, y;
};
constexpr Place kAnchors[] = {{"P", 0, 0}, {"Q", 20, 0}, {"R", 18, 15}, {"S", 2, 12}};

std::string distance_rows() {
  std::ostringstream out;
  out.precision(17);
  out << "id_i,id_j,distance_m\n";
  for (const auto& a : kAnchors)
    for (const auto& b : kAnchors)
      if (&a < &b) out << a.id << ',' << b.id << ',' << std::hypot(a.x - b.x, a.y - b.y) << '\n';
  return out.str();
}

/// A robot around (10, 8); every range to Q is half a metre too long.
std::string range_rows() {
  std::ostringstream out;
  out.precision(17);
  out << "t_s,robot_i,robot_j,range_m,sigma_m\n";
  for (int k = 0; k < 300; ++k)
    for (const auto& a : kAnchors) {
      const double x = 10 + 6 * std::sin(0.05 * k), y = 8 + 5 * std::cos(0.08 * k);
      const double bias = a.id[0] == 'Q' ? 0.5 : 0;
      out << 0.1 * k << ",robot," << a.id << ',' << std::hypot(x - a.x, y - a.y) + bias << ",0.05\n";
    }
  return out.str();
}

void expect_refused(const std::string& distances, const std::string& reason,
                    const std::vector<std::string>& more = {}) {
  const TemporaryFolder folder;
  write_file(folder.path() / "d.csv", distances);
  std::vector<std::string> arguments{"anchors", "d.csv", "-o", "out"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto outcome = run(arguments, folder.path());
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"d.csv"}));
}

TEST(Anchors, AreWrittenWithTheRobotsPositionsAndTheBias) {
  const TemporaryFolder folder;
  write_file(folder.path() / "d.csv", distance_rows());
  write_file(folder.path() / "r.csv", range_rows());
  const auto outcome = run({"anchors", "d.csv", "--ranges", "r.csv", "-o", "out", "--json"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json, nlohmann::json::parse(read_file(folder.path() / "out/summary.json")));
  for (const auto& anchor : kAnchors) {
    EXPECT_NEAR(json["anchors"][anchor.id]["position_m"][0], anchor.x, 1e-6);
    EXPECT_NEAR(json["anchors"][anchor.id]["position_m"][1], anchor.y, 1e-6);
  }
  for (const auto& bias : json["robots"]["robot"]["biases"])
    EXPECT_NEAR(bias["bias_m"], bias["antenna_j"] == "Q" ? 0.5 : 0, 0.02) << bias;
  EXPECT_EQ(json["robots"]["robot"]["positions"], 300);

  EXPECT_EQ(read_file(folder.path() / "out/anchors.csv").rfind("id,x_m,y_m,z_m,sigma_m\nP,", 0), 0U);
  std::istringstream track(read_file(folder.path() / "out/robot.tum"));
  double t = 0, x = 0, y = 0, rest = 0;
  int rows = 0;
  for (; track >> t >> x >> y >> rest >> rest >> rest >> rest >> rest; ++rows) {
    EXPECT_NEAR(x, 10 + 6 * std::sin(0.5 * t), 0.1) << t;
    EXPECT_NEAR(y, 8 + 5 * std::cos(0.8 * t), 0.15) << t;
  }
  EXPECT_EQ(rows, 300);
}

TEST(Anchors, HandednessIsAsAsked) {
  const TemporaryFolder folder;
  write_file(folder.path() / "d.csv", distance_rows());
  const auto outcome =
      run({"anchors", "d.csv", "--origin", "Q", "--along-x", "P", "--left", "R", "-o", "out", "--json"},
          folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto r = nlohmann::json::parse(outcome.out)["anchors"]["R"]["position_m"];
  EXPECT_NEAR(r[0], 2, 1e-6);
  EXPECT_NEAR(r[1], 15, 1e-6);
}

TEST(Anchors, DistancesThatDetermineNoLayoutAreRefused) {
  const std::string header = "id_i,id_j,distance_m\n";
  expect_refused(header + "A,B,3\n", "only 2 anchors; at least 3 are needed");
  expect_refused(header + "A,B,3\nB,C,5\nA,C,4\nD,E,1\n", "connects anchor 'A' to 'D'");
  expect_refused(header + "A,B,3\nB,C,5\nA,C,4\nD,A,1\n", "the position of anchor 'D' is not determined");
  expect_refused(header + "A,B,3\nB,C,5\nA,C,8\n", "on one line");
  expect_refused(distance_rows(), "--origin, --along-x and --left must name",
                 {"--origin", "P", "--left", "P"});
  expect_refused(distance_rows(), "unknown anchor", {"--left", "X"});
  expect_refused(distance_rows(), "nothing.csv", {"--ranges", "nothing.csv"});
  expect_refused(header + "A,B,3\nB,C,5\nA,C,4\n", "at least 4 are needed", {"--set", "layout.dimension=3"});
}

TEST(Anchors, ARobotWithoutPositionsIsRefused) {
  const TemporaryFolder folder;
  write_file(folder.path() / "d.csv", distance_rows());
  write_file(folder.path() / "r.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n1,r,P,5,0.1\n1,r,Q,15,0.1\n");
  const auto outcome = run({"anchors", "d.csv", "--ranges", "r.csv", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("robot 'r' has no position"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace radioslam::cli
