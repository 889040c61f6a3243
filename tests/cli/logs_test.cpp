// run --log, run of logs, log, and run --stream.
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
  EXPECT_GT(json["by_kind"]["fingerprint"]["records"], 10);
  EXPECT_TRUE(json["missing"].empty());
  EXPECT_NE(run({"log", "logs/a.rslog"}, folder).out.find("keyframe"), std::string::npos);
}

/// The front ends see the recording sample by sample, and the estimate is that of the whole.
TEST(Stream, WritesWhatWasKnownOnTheWayBesideTheEstimateOfTheRun) {
  const TemporaryFolder temporary;
  const auto& folder = temporary.path();
  ASSERT_EQ(run({"simulate", "hall", "-o", "m", "--seed", "2", "--set", "path_length_m=20", "lidar_beams=8",
                 "lidar_azimuth_steps=180", "lidar_rotation_hz=4"},
                folder)
                .status,
            0);
  ASSERT_EQ(run({"run", "m", "-o", "whole"}, folder).status, 0);
  for (const char* threads : {"1", "2"}) {
    const auto streamed =
        run({"run", "m", "-o", std::string("stream") + threads, "--stream", "--threads", threads}, folder);
    ASSERT_EQ(streamed.status, 0) << streamed.err;
    EXPECT_NE(streamed.out.find("99 % of them registered within"), std::string::npos) << streamed.out;
  }
  for (const char* file : {"a.tum", "b.tum", "closures.csv"})
    EXPECT_EQ(read_file(folder / "whole" / file), read_file(folder / "stream1" / file)) << file;
  for (const char* file : {"a.online.tum", "b.online.tum", "a.tum"})
    EXPECT_EQ(read_file(folder / "stream1" / file), read_file(folder / "stream2" / file)) << file;
  EXPECT_FALSE(read_file(folder / "stream1" / "a.online.tum").empty());
  const std::string table = read_file(folder / "stream1" / "online.csv");
  EXPECT_EQ(table.rfind("t_s,robot,keyframe,latency_ms,solve_ms,effort,component,ate_m,delay_s\n", 0), 0u);
  EXPECT_NE(table.find(",b,0,"), std::string::npos);
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
