// radioslam import iw-ftm: round trip times printed by iw become the ranges of a mission.
#include <gtest/gtest.h>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

const std::string kLog =
    "wlan0 (phy #0): Peer measurements (cookie 1):\n"
    "  Peer 02:00:00:00:01:00: status=0 (SUCCESS) @8000000000 (final)\n    FTM\n      DIST_AVG: 4706\n"
    "  Peer 02:00:00:00:02:00: status=0 (SUCCESS) @7500000000 (final)\n    FTM\n      DIST_AVG: -20\n"
    "      DIST_VARIANCE: 250000\n"
    "  Peer 02:00:00:00:01:00: status=1 (REFUSED) - no data!\n";

Outcome import(const TemporaryFolder& folder, const std::vector<std::string>& more) {
  write_file(folder.path() / "ftm.txt", kLog);
  std::vector<std::string> arguments{"import", "iw-ftm", "ftm.txt", "-o", "ranges.csv"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run(arguments, folder.path());
}

void expect_log_refused(const std::vector<std::string>& more, const std::string& reason) {
  const TemporaryFolder folder;
  const Outcome outcome = import(folder, more);
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"ftm.txt"}));
}

TEST(ImportRanges, NamesRadiosAndCountsWhatFailed) {
  const TemporaryFolder folder;
  const Outcome outcome = import(folder, {"--robot", "a", "--name", "02:00:00:00:02:00=door", "--name",
                                          "02:00:00:00:03:00=b", "--set", "clock_offset_s=100"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(read_file(folder.path() / "ranges.csv"),
            "t_s,robot_i,robot_j,range_m,sigma_m\n107.5,a,door,0,0.5\n108,a,02:00:00:00:01:00,4.706,1\n");
  EXPECT_EQ(outcome.out,
            "note: 1 measurements failed\nranges.csv: 2 ranges from a to door 02:00:00:00:01:00\n");
}

TEST(ImportRanges, AreAMissionsTable) {
  const TemporaryFolder folder;
  ASSERT_EQ(import(folder, {"--robot", "a"}).status, 0);
  std::filesystem::create_directories(folder.path() / "m/robots/a");
  std::filesystem::create_directories(folder.path() / "m/radio");
  write_file(folder.path() / "m/mission.yaml",
             "format: radioslam-mission/1\nname: m\ndimension: 2\nrobots:\n  a: {}\n");
  write_file(folder.path() / "m/robots/a/odometry.tum", "7 0 0 0 0 0 0 1\n9 2 0 0 0 0 0 1\n");
  write_file(folder.path() / "m/radio/anchors.csv",
             "id,x_m,y_m,z_m,sigma_m\n02:00:00:00:01:00,5,0,0,0\n02:00:00:00:02:00,,,,0\n");
  std::filesystem::rename(folder.path() / "ranges.csv", folder.path() / "m/radio/ranges.csv");
  const Outcome outcome = run({"run", "m", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST(ImportRanges, RefusesInvalidNames) {
  expect_log_refused({}, "--robot is required");
  expect_log_refused({"--robot", "a/b"}, "is not a valid name");
  expect_log_refused({"--robot", "a", "--name", "door"}, "expected BSSID=ID");
  expect_log_refused({"--robot", "a", "--name", "02:00:00:00:02:00=a"}, "cannot measure a range to itself");
  expect_log_refused({"--robot", "a", "--name", "02:00:00:00:02:00=b", "--name", "02:00:00:00:02:00=c"},
                     "already has a name");
  expect_log_refused({"--robot", "a", "--set", "max_range_m=1", "--set", "max_negative_m=0"},
                     "none of the 3 measurements");
}

}  // namespace
}  // namespace radioslam::cli
