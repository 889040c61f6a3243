// radioslam team: agents over a network with faults end where a run ends; wrong options are named.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/process.hpp"
#include "cli/short_drive.hpp"

namespace radioslam::cli {
namespace {

TEST(Team, EndsWhereARunEndsThoughMuchIsLost) {
  const auto& folder = short_drive();
  const Outcome team = run({"team", "town", "-o", "agents", "--loss", "0.3", "--partition", "5:10", "--late",
                            "b:8", "--kill", "a@12:14", "--seed", "2"},
                           folder.path());
  ASSERT_EQ(team.status, 0) << team.err;
  const auto out = folder.path() / "agents";
  for (const char* file : {"summary.json", "report.html", "traffic.csv", "agents.csv", "agents/a/a.tum",
                           "agents/b/summary.json", "agents/b/known.csv"})
    EXPECT_TRUE(std::filesystem::exists(out / file)) << file;
  EXPECT_FALSE(std::filesystem::exists(out / "journals"));
  for (const char* file : {"a.tum", "b.tum", "closures.csv", "graph.g2o"})
    EXPECT_EQ(read_file(out / "agents/a" / file), read_file(out / "agents/b" / file)) << file;
  EXPECT_LE(error_of(out / "summary.json"), 2 * error_of(folder.path() / "whole/summary.json"));
}

TEST(Team, AKilledRobotThatDoesNotComeBackHasNoResult) {
  const auto& folder = short_drive();
  const Outcome team =
      run({"team", "town", "-o", "without", "--kill", "b@12", "--partition", "2:4:b"}, folder.path());
  ASSERT_EQ(team.status, 0) << team.err;
  const auto out = folder.path() / "without";
  EXPECT_FALSE(std::filesystem::exists(out / "agents/b"));
  const auto summary = nlohmann::json::parse(read_file(out / "agents/a/summary.json"));
  EXPECT_GT(summary["records"]["a"], summary["records"]["b"]);
  EXPECT_GT(summary["bytes_sent"], 0);
  EXPECT_GT(summary["bytes_received"], 0);
  EXPECT_TRUE(summary["refused"].empty());
}

TEST(Team, CountsWhatIsSentAndLost) {
  const auto& folder = short_drive();
  ASSERT_EQ(run({"team", "town", "-o", "lossy", "--loss", "0.5"}, folder.path()).status, 0);
  std::istringstream table(read_file(folder.path() / "lossy/traffic.csv"));
  std::string row;
  std::getline(table, row);
  EXPECT_EQ(row, "from,to,kind,messages,bytes,lost");
  double messages = 0, lost = 0;
  while (std::getline(table, row)) {
    std::istringstream cells(row);
    std::string cell;
    std::vector<std::string> of;
    while (std::getline(cells, cell, ',')) of.push_back(cell);
    ASSERT_EQ(of.size(), 6U);
    messages += std::stod(of[3]);
    lost += std::stod(of[5]);
  }
  EXPECT_NEAR(lost / messages, 0.5, 0.15);
}

TEST(Team, WrongOptionsAreNamed) {
  const auto& folder = short_drive();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"--kill", "z@5"}, "no robot 'z'"},
      {{"--kill", "b5"}, "not a robot and a time"},
      {{"--kill", "b@soon"}, "not a time in seconds"},
      {{"--late", "b@5"}, "not a robot and a time"},
      {{"--partition", "9:5"}, "ends before it begins"},
      {{"--kill", "b@9:5"}, "back before it is killed"},
      {{"--partition", "9"}, "not two times"},
      {{"--partition", "2:9:z"}, "no robot 'z'"}};
  for (const auto& [options, what] : wrong) {
    std::vector<std::string> arguments{"team", "town", "-o", "nothing"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2) << options[1];
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "nothing"));
  }
}

}  // namespace
}  // namespace radioslam::cli
