// radioslam poses: where the robots of a run were at given times.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

class Poses : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(
        run({"simulate", "carpark", "-o", "m", "--seed", "2", "--set", "path_length_m=60"}, folder()).status,
        0);
    ASSERT_EQ(run({"run", "m", "-o", "out"}, folder()).status, 0);
  }

  const std::filesystem::path& folder() const { return temporary_.path(); }

  /// Rows of the answer, without the header.
  std::vector<std::vector<std::string>> ask(const std::string& table, std::vector<std::string> more = {}) {
    write_file(folder() / "at.csv", table);
    std::vector<std::string> arguments{"poses", "out", "--at", "at.csv"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    answer_ = run(arguments, folder());
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(answer_.out);
    for (std::string line; std::getline(lines, line);) {
      auto& fields = rows.emplace_back();
      std::istringstream in(line + ",");
      for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    }
    if (!rows.empty()) rows.erase(rows.begin());
    return rows;
  }

  Outcome answer_;

 private:
  TemporaryFolder temporary_;
};

TEST_F(Poses, AreThoseOfTheRunAtKeyframesAndBetweenThem) {
  std::istringstream keyframes(read_file(folder() / "out" / "b.tum"));
  double t[3], x[3], rest = 0;
  for (int k = 0; k < 3; ++k) {
    keyframes >> t[k] >> x[k];
    for (int i = 0; i < 6; ++i) keyframes >> rest;
  }
  std::ostringstream table;
  table << "t_s\n" << t[2] << "\n" << t[1] << "\n" << (t[1] + t[2]) / 2 << "\n";
  const auto rows = ask(table.str(), {"--robot", "b"});
  ASSERT_EQ(rows.size(), 3U) << answer_.err;
  EXPECT_EQ(rows[0].size(), 12U);
  EXPECT_EQ(rows[0][0], "b");
  EXPECT_NEAR(std::stod(rows[0][2]), x[2], 1e-9);
  EXPECT_NEAR(std::stod(rows[1][2]), x[1], 1e-9);
  const double sigma_before = std::stod(rows[1][9]), sigma_after = std::stod(rows[0][9]);
  EXPECT_GT(sigma_after, 0);
  EXPECT_NEAR(std::stod(rows[2][9]), std::sqrt((sigma_before * sigma_before + sigma_after * sigma_after) / 2),
              1e-6);
}

TEST_F(Poses, AreEmptyWithANoteWhereTheRunHasNone) {
  const auto rows = ask("robot,t_s\na,1e6\na,5\nb,5\n");
  EXPECT_EQ(answer_.status, 0);
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0], (std::vector<std::string>{"a", "1000000", "", "", "", "", "", "", "", "", "", ""}));
  EXPECT_GT(std::stod(rows[1][10]), 0);
  EXPECT_NE(answer_.err.find("robot a: 1 times have no pose"), std::string::npos) << answer_.err;
}

TEST_F(Poses, RefuseWhatTheyDoNotKnow) {
  ask("robot,t_s\nz,5\n", {"-o", "poses.csv"});
  EXPECT_EQ(answer_.status, 2);
  EXPECT_NE(answer_.err.find("at.csv:2"), std::string::npos) << answer_.err;
  EXPECT_FALSE(std::filesystem::exists(folder() / "poses.csv"));
  ask("t_s\n5\n");
  EXPECT_EQ(answer_.status, 2) << "no robot";
  ask("t_s\n5\n", {"--robot", "z"});
  EXPECT_NE(answer_.err.find("--robot"), std::string::npos) << answer_.err;
}

}  // namespace
}  // namespace radioslam::cli
