// run --log, run of logs, and log.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

TEST(Logs, GiveTheSameTrajectoriesAsTheMissionInAnyOrder) {
  const TemporaryFolder temporary;
  const auto& folder = temporary.path();
  ASSERT_EQ(
      run({"simulate", "carpark", "-o", "m", "--seed", "2", "--set", "path_length_m=120"}, folder).status, 0);
  const auto mission = run({"run", "m", "-o", "out", "--log", "logs"}, folder);
  ASSERT_EQ(mission.status, 0) << mission.err;
  const auto logs = run({"run", "logs/b.rslog", "logs/a.rslog", "logs/b.rslog", "-o", "again"}, folder);
  ASSERT_EQ(logs.status, 0) << logs.err;
  for (const char* file : {"a.tum", "b.tum", "closures.csv"})
    EXPECT_EQ(read_file(folder / "out" / file), read_file(folder / "again" / file)) << file;
  const auto printed = run({"log", "logs/a.rslog", "--json"}, folder);
  const auto json = nlohmann::json::parse(printed.out);
  EXPECT_GT(json["robots"]["a"]["kinds"]["fingerprint"]["records"], 10);
  EXPECT_TRUE(json["robots"]["a"]["gaps"].empty());
  EXPECT_NE(run({"log", "logs/a.rslog"}, folder).out.find("keyframe"), std::string::npos);
}

TEST(Logs, AreRefusedWithOneLineWhereTheyAreNone) {
  const TemporaryFolder temporary;
  write_file(temporary.path() / "a.rslog", "not a log");
  for (const char* command : {"log", "run"}) {
    const auto outcome =
        run(command == std::string("run") ? std::vector<std::string>{"run", "a.rslog", "-o", "out"}
                                          : std::vector<std::string>{"log", "a.rslog"},
            temporary.path());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("a.rslog: is no log"), std::string::npos) << outcome.err;
  }
}

}  // namespace
}  // namespace radioslam::cli
