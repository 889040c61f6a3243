// radioslam rendezvous: a simulated team. One robot by lines: tests/io/rendezvous.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

TEST(Rendezvous, SimulatesATeamAndSaysHowItFared) {
  const TemporaryFolder folder;
  const std::vector<std::string> call{"rendezvous", "--robots", "3",     "--policy", "active",
                                      "--monitor",  "seed",     "--set", "delta=5",  "--iterations",
                                      "20",         "--seed",   "4",     "--json"};
  const auto outcome = run(call, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key : {"error", "error_std", "sigma_m"}) EXPECT_EQ(json[key].size(), 20U) << key;
  EXPECT_EQ(json["delta"], 5);
  EXPECT_GT(json["metres_walked"], 0);
  EXPECT_NEAR(json["ate_rmse_m"].get<double>() * json["ate_rmse_m"].get<double>(),
              json["ate_trans_mean_squared"].get<double>(), 1e-9);
  auto again = nlohmann::json::parse(run(call, folder.path()).out), before = json;
  again.erase("seconds");
  before.erase("seconds");
  EXPECT_EQ(again, before);
}

TEST(Rendezvous, InputThatEndsBeforeAStartIsSaidToDoSo) {
  const TemporaryFolder folder;
  const auto outcome = run({"rendezvous", "--stdio", "--robot", "a"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("standard input: ended before the robot was started"), std::string::npos)
      << outcome.err;
  EXPECT_EQ(outcome.out, "");
}

TEST(Rendezvous, RefusesWhatItDoesNotKnow) {
  const TemporaryFolder folder;
  EXPECT_EQ(run({"rendezvous", "--policy", "telepathy"}, folder.path()).status, 2);
  EXPECT_EQ(run({"rendezvous", "--stdio"}, folder.path()).status, 2);
  EXPECT_EQ(run({"rendezvous", "--stdio", "--robot", "a", "--robots", "3"}, folder.path()).status, 2);
  EXPECT_EQ(run({"rendezvous", "--robot", "a"}, folder.path()).status, 2);
}

}  // namespace
}  // namespace radioslam::cli
