// radioslam aoa on the captures of a simulated mission.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

using nlohmann::json;
using Arguments = std::vector<std::string>;

const std::string kHeard = "m/robots/a/csi/capture.dat";
const Arguments kTrajectory{"--trajectory", "m/robots/a/odometry.tum"};
const Arguments kReverse{"--reverse", "m/robots/b/csi/capture.dat"};
const Arguments kOfB{"--transmitter", "00:16:ea:00:00:02"};
const Arguments kChannel{"--channel", "108"};
const Arguments kLever{"--lever", "0.15,0,0.3"};

Arguments joined(const std::vector<Arguments>& parts) {
  Arguments all;
  for (const Arguments& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

double apart_rad(double a, double b) { return std::abs(std::remainder(a - b, 2 * M_PI)); }

/// A planar pose from a TUM file.
struct PlaceInRoom {
  double t_s = -1, x_m = 0, y_m = 0, yaw_rad = 0;
};

PlaceInRoom pose_at(const std::filesystem::path& path, double t_s) {
  std::istringstream rows(read_file(path));
  PlaceInRoom best;
  std::array<double, 8> row{};
  while (rows >> row[0]) {
    for (std::size_t k = 1; k < row.size(); ++k) rows >> row[k];
    if (best.t_s < 0 || std::abs(row[0] - t_s) < std::abs(best.t_s - t_s))
      best = {row[0], row[1], row[2], 2 * std::atan2(row[6], row[7])};
  }
  return best;
}

/// Three robots that take turns to drive one leg each; simulated once.
class Aoa : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const Outcome made = run({"simulate", "csi", "-o", "m", "--seed", "3", "--set", "turns_per_robot=1",
                              "--set", "inner_walls=0", "--set", "max_bounces=0"},
                             folder_->path());
    ASSERT_EQ(made.status, 0) << made.err;
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }

  static Outcome aoa(const std::vector<Arguments>& more, const Arguments& trajectory = kTrajectory) {
    return run(joined({{"aoa", kHeard}, trajectory, joined(more)}), folder_->path());
  }

  static void expect_call_refused(const std::vector<Arguments>& more, const std::string& reason,
                                  const Arguments& trajectory = kTrajectory) {
    const auto before = files_in(folder_->path());
    const Outcome outcome = aoa(more, trajectory);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(files_in(folder_->path()), before);
  }

  static json measured(const std::vector<Arguments>& more) {
    const Outcome outcome = aoa({kReverse, kOfB, kChannel, kLever, {"--json"}, joined(more)});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    return json::parse(outcome.out);
  }

  static inline TemporaryFolder* folder_ = nullptr;
};

TEST_F(Aoa, JsonHasTheKeysOfItsFormat) {
  const json result = measured({});
  for (const char* key : {"t_s", "packets", "peaks"}) EXPECT_TRUE(result.contains(key)) << key;
  EXPECT_TRUE(result["t_s"].is_number());
  EXPECT_GT(result["packets"].get<int>(), 300);
  ASSERT_FALSE(result["peaks"].empty());
  double before_db = 0;
  for (const json& peak : result["peaks"]) {
    for (const char* key : {"azimuth_rad", "azimuth_trajectory_frame_rad", "elevation_rad", "sigma_rad",
                            "power_db", "elevation_sigma_rad"}) {
      ASSERT_TRUE(peak.contains(key)) << key;
      EXPECT_TRUE(std::isfinite(peak[key].get<double>())) << key;
    }
    EXPECT_GT(peak["sigma_rad"].get<double>(), 0);
    EXPECT_LE(peak["power_db"].get<double>(), before_db) << "the strongest first";
    before_db = peak["power_db"].get<double>();
  }
  EXPECT_EQ(result["peaks"][0]["power_db"].get<double>(), 0);
}

TEST_F(Aoa, PointsAtTheTransmitterInBothFrames) {
  const json result = measured({});
  const double t_s = result["t_s"].get<double>();
  const auto robots = folder_->path() / "m/robots";
  const PlaceInRoom a = pose_at(robots / "a/groundtruth.tum", t_s),
                    b = pose_at(robots / "b/groundtruth.tum", t_s);
  const double azimuth_rad = std::atan2(b.y_m - a.y_m, b.x_m - a.x_m) - a.yaw_rad;
  const json& peak = result["peaks"][0];
  EXPECT_LT(apart_rad(peak["azimuth_rad"].get<double>(), azimuth_rad), 0.1);
  const PlaceInRoom reckoned = pose_at(robots / "a/odometry.tum", t_s);
  EXPECT_LT(apart_rad(peak["azimuth_trajectory_frame_rad"].get<double>(),
                      peak["azimuth_rad"].get<double>() + reckoned.yaw_rad),
            0.03);
  EXPECT_GT(std::abs(reckoned.yaw_rad), 0.2) << "or the test is pointless";
}

TEST_F(Aoa, IsTheSameForOneThreadAndTwo) {
  EXPECT_EQ(measured({{"--threads", "1"}}), measured({{"--threads", "2"}}));
}

TEST_F(Aoa, WritesTheProfile) {
  const Outcome outcome = aoa({kReverse, kOfB, kChannel, kLever, {"-o", "profile.csv"}});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("packets around"), std::string::npos);
  const std::string profile = read_file(folder_->path() / "profile.csv");
  EXPECT_TRUE(profile.starts_with("azimuth_trajectory_frame_rad,power\n-3.14159265,"));
  EXPECT_EQ(std::count(profile.begin(), profile.end(), '\n'), 361);
  EXPECT_NE(profile.find(",1\n"), std::string::npos) << "the strongest is 1";
}

TEST_F(Aoa, AClockOffsetIsAppliedAndReported) {
  const json plain = measured({}), late = measured({{"--clock-offset", "0.3"}});
  EXPECT_FALSE(plain.contains("clock_offset"));
  EXPECT_EQ(late["clock_offset"]["offset_s"].get<double>(), 0.3);
  EXPECT_EQ(late["clock_offset"]["sigma_s"].get<double>(), 0) << "given, not estimated";
  EXPECT_GT(apart_rad(plain["peaks"][0]["azimuth_trajectory_frame_rad"].get<double>(),
                      late["peaks"][0]["azimuth_trajectory_frame_rad"].get<double>()),
            0.02);
}

TEST_F(Aoa, RefusesToGuessTheSender) {
  expect_call_refused({kReverse, kChannel},
                      "has packets from 00:16:ea:00:00:02, 00:16:ea:00:00:03: choose one with --transmitter");
  expect_call_refused({kReverse, kChannel, {"--transmitter", "00:16:ea:00:00:09"}},
                      "has no packets from 00:16:ea:00:00:09, only from 00:16:ea:00:00:02");
  expect_call_refused({kReverse, kChannel, {"--transmitter", "b"}}, "--transmitter b: is not a MAC address");
}

TEST_F(Aoa, RefusesToGuessTheChannel) {
  expect_call_refused({kReverse, kOfB}, "does not record its carrier: give its WiFi channel with --channel");
  expect_call_refused({kReverse, kOfB, {"--channel", "15"}}, "is not the number of a WiFi channel");
}

TEST_F(Aoa, RefusesAnswersOfAnotherRobot) {
  expect_call_refused({{"--reverse", "m/robots/c/csi/capture.dat"}, kOfB, kChannel},
                      "c/csi/capture.dat: does not answer the packets of");
}

TEST_F(Aoa, RefusesOneAntennaInOneDirection) {
  expect_call_refused({kOfB, kChannel},
                      "give the other end's capture with --reverse, or the positions of two antennas");
  expect_call_refused({kOfB, kChannel, {"--lever", "0,0,0"}, {"--lever", "0.1,0,0"}},
                      "has no packets received by two antennas");
}

TEST_F(Aoa, RefusesMoreLeversThanItUses) {
  const Arguments twice{"--lever", "0.1,0,0", "--lever", "0.2,0,0"};
  expect_call_refused({kReverse, kOfB, kChannel, twice}, "--lever: may be given only once with --reverse");
  expect_call_refused({kOfB, kChannel, twice, {"--lever", "0.3,0,0"}}, "--lever: may be given at most twice");
}

TEST_F(Aoa, MeasuresASegmentOfTheTrajectory) {
  const json all = measured({});
  const std::string middle = std::to_string(all["t_s"].get<double>());
  const json first = measured({{"--end", middle}}), second = measured({{"--begin", middle}});
  EXPECT_LT(first["t_s"].get<double>(), all["t_s"].get<double>());
  EXPECT_GT(second["t_s"].get<double>(), all["t_s"].get<double>());
  EXPECT_LT(first["packets"].get<int>() + second["packets"].get<int>(), all["packets"].get<int>() + 2);
  expect_call_refused({kReverse, kOfB, kChannel, {"--begin", "1e6"}},
                      "has no packets between --begin and --end");
}

TEST_F(Aoa, RefusesAnApertureTooWideWithAHint) {
  expect_call_refused({kReverse, kOfB, kChannel, {"--lever", "1e6,0,0"}},
                      "select a shorter segment with --begin and --end");
}

TEST_F(Aoa, ReportsTheCapturesPowerAndEffectiveSnr) {
  const json result = measured({});
  for (const char* end : {"heard", "answers"}) {
    ASSERT_TRUE(result["captures"].contains(end));
    const json& capture = result["captures"][end];
    EXPECT_GT(capture["packets"].get<int>(), 300) << end;
    EXPECT_LT(capture["received_power_dbm"].get<double>(), 0) << end;
    const json& esnr = capture["effective_snr_db"];
    EXPECT_LE(esnr["bpsk"].get<double>(), esnr["qpsk"].get<double>()) << end;
    EXPECT_LE(esnr["qpsk"].get<double>(), esnr["qam16"].get<double>()) << end;
    EXPECT_LE(esnr["qam16"].get<double>(), esnr["qam64"].get<double>()) << end;
  }
}

/// The trajectory up to a time; afterwards it stays at its last pose.
std::string stopped_at(const std::string& rows, double stop_s) {
  std::istringstream lines(rows);
  std::string out, line, rest;
  while (std::getline(lines, line)) {
    const std::string stamp = line.substr(0, line.find(' '));
    if (rest.empty() || std::stod(stamp) <= stop_s) rest = line.substr(line.find(' '));
    out += stamp + rest + "\n";
  }
  return out;
}

TEST_F(Aoa, ExplainsWhyNoClockOffsetIsEstimated) {
  write_file(folder_->path() / "short.tum", "0 0 0 0 0 0 0 1\n0.5 1 0 0 0 0 0 1\n");
  expect_call_refused({kReverse, kOfB, kChannel, {"--clock-offset", "estimate"}},
                      "short.tum covers too few of the packets", {"--trajectory", "short.tum"});
  const std::string truth = read_file(folder_->path() / "m/robots/a/groundtruth.tum");
  const double middle_s = measured({})["t_s"].get<double>();
  write_file(folder_->path() / "still.tum", stopped_at(truth, middle_s - 20));
  expect_call_refused({kReverse, kOfB, kChannel, {"--clock-offset", "estimate"}},
                      "the speed changes too little", {"--trajectory", "still.tum"});
  const Outcome pair = run({"simulate", "csi", "-o", "pair", "--seed", "3", "--set", "turns_per_robot=1",
                            "--set", "antennas=2", "--set", "robots=2"},
                           folder_->path());
  ASSERT_EQ(pair.status, 0) << pair.err;
  const Outcome outcome =
      run(joined({{"aoa", "pair/robots/a/csi/capture.dat", "--trajectory", "pair/robots/a/odometry.tum",
                   "--lever", "0.15,0,0.3", "--lever", "0.15,0.027,0.3", "--clock-offset", "estimate"},
                  kChannel}),
          folder_->path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("needs packets in both directions"), std::string::npos) << outcome.err;
}

TEST_F(Aoa, TakesCapturesOfFewPacketsASecond) {
  const Outcome made = run({"simulate", "csi", "-o", "slow", "--seed", "3", "--set", "turns_per_robot=1",
                            "--set", "inner_walls=0", "--set", "max_bounces=0", "--set", "packet_rate_hz=40"},
                           folder_->path());
  ASSERT_EQ(made.status, 0) << made.err;
  const Outcome outcome =
      run(joined({{"aoa", "slow/robots/a/csi/capture.dat", "--reverse", "slow/robots/b/csi/capture.dat",
                   "--trajectory", "slow/robots/a/odometry.tum", "--json"},
                  kOfB,
                  kChannel,
                  kLever}),
          folder_->path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json result = json::parse(outcome.out);
  const double t_s = result["t_s"].get<double>();
  const auto robots = folder_->path() / "slow/robots";
  const PlaceInRoom a = pose_at(robots / "a/groundtruth.tum", t_s),
                    b = pose_at(robots / "b/groundtruth.tum", t_s);
  EXPECT_LT(apart_rad(result["peaks"][0]["azimuth_rad"].get<double>(),
                      std::atan2(b.y_m - a.y_m, b.x_m - a.x_m) - a.yaw_rad),
            0.1);
}

TEST_F(Aoa, RefusesInvalidLevers) {
  for (const char* lever : {"0.1,0.2", "0.1,x,0", "1,2,3,4", "1 2 3"})
    expect_call_refused({kReverse, kOfB, kChannel, {"--lever", lever}},
                        std::string("--lever ") + lever + ": is not x,y,z in metres");
}

TEST_F(Aoa, RefusesInvalidClockOffsets) {
  expect_call_refused({kReverse, kOfB, kChannel, {"--clock-offset", "soon"}},
                      "--clock-offset soon: is neither seconds nor 'estimate'");
  expect_call_refused({kReverse, kOfB, kChannel, {"--clock-offset", "1e30"}},
                      "--clock-offset 1e30: is too large for an offset of two clocks");
}

TEST_F(Aoa, RefusesUnusableTrajectories) {
  write_file(folder_->path() / "still.tum", "0 0 0 0 0 0 0 1\n1000 0 0 0 0 0 0 1\n");
  write_file(folder_->path() / "later.tum", "5000 0 0 0 0 0 0 1\n6000 5 0 0 0 0 0 1\n");
  const std::vector<Arguments> rest{kReverse, kOfB, kChannel};
  expect_call_refused(rest, "still.tum: hardly moves", {"--trajectory", "still.tum"});
  expect_call_refused(rest, "later.tum: has no poses at the times of", {"--trajectory", "later.tum"});
  expect_call_refused(rest, "nothing.tum: no such file", {"--trajectory", "nothing.tum"});
}

TEST_F(Aoa, RefusesAReverseWithoutAnswers) {
  write_file(folder_->path() / "empty.dat", "");
  const Outcome outcome = aoa({{"--reverse", "empty.dat"}, kOfB, kChannel});
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("empty.dat"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace radioslam::cli
