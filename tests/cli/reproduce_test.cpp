// radioslam reproduce from end to end: tables are listed, refused, computed and written.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "cli/process.hpp"
#include "study/aoa/synthetic_trial.hpp"

namespace radioslam::cli {
namespace {

/// Two rounds of a circle in KITTI format, one pose per metre; the radius varies by `wobble_m`.
std::string circle(double wobble_m, double mean_radius_m = 19) {
  const long poses = std::lround(4 * std::numbers::pi * mean_radius_m) + 1;
  std::ostringstream lines;
  for (int k = 0; k < poses; ++k) {
    const double angle = k / mean_radius_m, c = std::cos(angle), s = std::sin(angle);
    const double radius_m = mean_radius_m + wobble_m * std::sin(0.1 * k);
    lines << c << ' ' << -s << " 0 " << radius_m * s << ' ' << s << ' ' << c << " 0 "
          << mean_radius_m - radius_m * c << " 0 0 1 0\n";
  }
  return lines.str();
}

class Reproduce : public testing::Test {
 protected:
  void SetUp() override {
    write_file(folder() / "truth.txt", circle(0));
    write_file(folder() / "odometry.txt", circle(0.2));
  }
  const std::filesystem::path& folder() const { return folder_.path(); }
  /// The JSON that a call with `--json -o out` prints and writes.
  nlohmann::json reproduced(const std::vector<std::string>& arguments) const {
    const auto outcome = run(arguments, folder());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(files_in(folder() / "out"),
              (std::vector<std::string>{"index.html", "table.csv", "table.json", "table.txt"}));
    EXPECT_EQ(read_file(folder() / "out" / "table.json"), outcome.out);
    return nlohmann::json::parse(outcome.out);
  }
  std::string refusal(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "reproduce");
    const auto outcome = run(arguments, folder());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    return outcome.err;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Reproduce, WithoutATableListsThem) {
  const auto outcome = run({"reproduce"}, folder());
  EXPECT_EQ(outcome.status, 0);
  for (const char* name : {"wi-closure-kitti", "wi-closure-table1", "wi-closure-hall", "robustness-map",
                           "fingerprint-tables", "threshold-sweep"})
    EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
}

TEST_F(Reproduce, WritesTheTableThatItPrints) {
  const auto json =
      reproduced({"reproduce", "wi-closure-kitti", "--trajectory", "truth.txt", "--odometry", "odometry.txt",
                  "--cut", "0.5", "--set", "links=6", "dimension=2", "--json", "-o", "out"});
  EXPECT_EQ(json["published"]["kept"], 7049);
  EXPECT_EQ(json["seeds"][0]["cut"], 0.5);
  EXPECT_EQ(json["seeds"][0]["links"], 6);
  EXPECT_GT(json["seeds"][0]["joint"]["recall"], 0.9);
}

TEST_F(Reproduce, RefusesInvalidCalls) {
  EXPECT_NE(refusal({"wi-closure-kiti"}).find("did you mean wi-closure-kitti"), std::string::npos);
  EXPECT_NE(refusal({"wi-closure-kitti", "--odometry", "odometry.txt"}).find("--trajectory"),
            std::string::npos);
  EXPECT_NE(refusal({"robustness-map", "--cut", "0.5"}).find("towns are simulated"), std::string::npos);
  EXPECT_NE(refusal({"verification-budget", "--set", "robots=3"}).find("only --seed"), std::string::npos);
  EXPECT_NE(refusal({"team", "--set", "robots=3"}).find("only --seed"), std::string::npos);
  EXPECT_NE(refusal({"distributed-optimization", "--seeds", "2"}).find("only --team"), std::string::npos);
  EXPECT_NE(refusal({"distributed-optimization", "--team", "none.g2o"}).find("none.g2o"), std::string::npos);
  EXPECT_NE(refusal({"robustness-map", "--team", "none.g2o"}).find("no --team"), std::string::npos);
  EXPECT_NE(refusal({"robustness-map", "--seeds", "0"}).find("--seeds"), std::string::npos);
  EXPECT_NE(refusal({"robustness-map", "--set", "lamps=3"}).find("lamps"), std::string::npos);
  write_file(folder() / "short.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_NE(refusal({"wi-closure-kitti", "--trajectory", "truth.txt", "--odometry", "short.txt"})
                .find("short.txt: has 1 poses"),
            std::string::npos);
}

TEST_F(Reproduce, ComparesAHallWithAndWithoutRadio) {
  const auto outcome = run(
      {"reproduce", "wi-closure-hall", "--seeds", "1", "--seed", "2", "--json", "-o", "out", "--set",
       "path_length_m=8", "speed_mps=1", "lidar_beams=8", "lidar_azimuth_steps=120", "lidar_rotation_hz=3"},
      folder());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(files_in(folder() / "out"),
            (std::vector<std::string>{"index.html", "links.csv", "table.csv", "table.json", "table.txt"}));
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["published"]["pairs"], 1848);
  ASSERT_EQ(json["seeds"].size(), 1U);
  EXPECT_GE(json["seeds"][0]["disco"]["unpruned"]["place_pairs_allowed"],
            json["seeds"][0]["disco"]["pruned"]["place_pairs_allowed"]);
  EXPECT_NE(read_file(folder() / "out" / "table.txt").find("Paths of the angles"), std::string::npos);
  EXPECT_NE(refusal({"wi-closure-hall", "--set", "lidar_beams=0"}).find("lidar_beams"), std::string::npos);
  EXPECT_NE(refusal({"wi-closure-hall", "--cut", "0.5"}).find("--cut"), std::string::npos);
}

TEST_F(Reproduce, ComparesADriveWithAndWithoutRadio) {
  write_file(folder() / "small.txt", circle(0, 10));
  write_file(folder() / "wobbling.txt", circle(0.2, 10));
  const auto json = reproduced({"reproduce", "wi-closure-table1", "--trajectory", "small.txt", "--odometry",
                                "wobbling.txt", "--cut", "0.5", "--json", "-o", "out", "--set", "links=6",
                                "lidar_range_m=10", "lidar_beams=8", "lidar_azimuth_steps=120"});
  EXPECT_EQ(json["published"]["true_kept"], 3631);
  ASSERT_EQ(json["seeds"].size(), 1U);
  EXPECT_EQ(json["seeds"][0]["cut"], 0.5);
  EXPECT_EQ(json["seeds"][0]["links"], 6);
  EXPECT_GT(json["seeds"][0]["defaults"]["without_radio"]["descriptor_pairs"], 0);
  EXPECT_NE(refusal({"wi-closure-table1", "--odometry", "odometry.txt"}).find("--trajectory"),
            std::string::npos);
  EXPECT_NE(refusal({"wi-closure-table1", "--trajectory", "truth.txt", "--odometry", "odometry.txt", "--set",
                     "lidar_beams=0"})
                .find("lidar_beams"),
            std::string::npos);
}

/// The error message of a call in an empty folder.
std::string refused(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  const auto outcome = run(arguments, folder.path());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  return outcome.err;
}

TEST(ReproduceAoa, ComparesWithTheAuthorsFigures) {
  const TemporaryFolder folder;
  sample::write_trial(folder.path() / "raw" / "LOS_Set_A" / "L1", "_now");
  const auto link = sample::results_json("tx2", {-30, 5}, sample::antenna_at(0).translation());
  const std::string results = "2D-Displacement_output_files/default_configuration";
  sample::write_bytes(folder.path() / results / "LOS_Set_A_using_groundtruth_displacement.json",
                      "{\"1\": [" + link + "]}");
  const auto outcome =
      run({"reproduce", "aoa", "--dataset", "raw", "--set", "azimuths=180", "--json", "-o", "out"},
          folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(files_in(folder.path() / "out"),
            (std::vector<std::string>{"index.html", "links.csv", "table.csv", "table.json", "table.txt"}));
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["groups"].size(), 3U);
  EXPECT_EQ(json["groups"][0]["motion"], "motion capture");
  EXPECT_EQ(json["groups"][0]["ours"]["links"], 2);
  EXPECT_EQ(json["groups"][0]["ours"]["within_10_deg"], 1);
  EXPECT_EQ(json["groups"][0]["authors_same_trials"]["links"], 1);
  EXPECT_EQ(json["groups"][0]["authors_same_trials"]["within_10_deg"], 0);
  EXPECT_EQ(json["groups"][0]["authors_same_trials"]["best_of_4_within_10_deg"], 1);
  EXPECT_EQ(json["links"].size(), 6U);
}

TEST(ReproduceAoa, RefusesInvalidCalls) {
  EXPECT_NE(refused({"reproduce", "aoa"}).find("--dataset"), std::string::npos);
  EXPECT_NE(refused({"reproduce", "aoa", "--dataset", "."}).find("csi_rx"), std::string::npos);
  EXPECT_NE(refused({"reproduce", "aoa", "--dataset", ".", "--seeds", "3"}).find("--seeds"),
            std::string::npos);
  EXPECT_NE(refused({"reproduce", "aoa-paths", "--cut", "0.5"}).find("--cut"), std::string::npos);
  EXPECT_NE(refused({"reproduce", "aoa-paths", "--dataset", "."}).find("--dataset"), std::string::npos);
  EXPECT_NE(refused({"reproduce", "aoa-paths", "--set", "azimuth=3"}).find("azimuths"), std::string::npos);
}

TEST(ReproduceAoaPaths, PrintsARowPerProfileAndCards) {
  const TemporaryFolder folder;
  const auto outcome =
      run({"reproduce", "aoa-paths", "--seeds", "1", "--set", "azimuths=120"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* row : {"bartlett, no carrier", "music, carrier", "sparse, carrier"})
    EXPECT_NE(outcome.out.find(row), std::string::npos) << row;
}

/// `reproduce TABLE` on one car park so small that it takes a moment.
Outcome reproduce_small_carpark(const std::string& table, const std::filesystem::path& folder) {
  return run({"reproduce", table, "--seeds", "1", "--seed", "3", "--json", "-o", "out", "--set",
              "floor_x_m=40", "floor_y_m=30", "aisles_along_y=3", "aisles_along_x=3", "path_length_m=60",
              "odometry_rate_hz=2", "access_points=30"},
             folder);
}

TEST(ReproduceFingerprintTables, ComparesWithThePublishedFigures) {
  const TemporaryFolder folder;
  const auto outcome = reproduce_small_carpark("fingerprint-tables", folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(files_in(folder.path() / "out"),
            (std::vector<std::string>{"index.html", "table.csv", "table.json", "table.txt"}));
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["defaults_ate_m"].size(), 1U);
  ASSERT_EQ(json["cells"].size(), 189U);
  EXPECT_EQ(json["cells"][1]["measure"], "cosine");
  EXPECT_EQ(json["cells"][1]["nu_s_m"], 5);
  EXPECT_EQ(json["cells"][1]["published_m"], (std::vector<double>{4.876, 9.137}));
}

TEST(ReproduceThresholdSweep, ComparesTheDefaultsWithTheBestCell) {
  const TemporaryFolder folder;
  const auto outcome = reproduce_small_carpark("threshold-sweep", folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["missions"].size(), 1U);
  const auto& mission = json["missions"][0];
  EXPECT_EQ(mission["seed"], 3);
  EXPECT_EQ(mission["cells"].size(), 45U);
  for (const auto& cell : mission["cells"]) EXPECT_GE(cell["ate_m"], mission["best"]["ate_m"]);
  EXPECT_NE(read_file(folder.path() / "out" / "table.txt").find("mission 3"), std::string::npos);
}

TEST(ReproduceFingerprintTables, RefusesInvalidCalls) {
  EXPECT_NE(refused({"reproduce", "fingerprint-tables", "--cut", "0.5"}).find("--cut"), std::string::npos);
  EXPECT_NE(refused({"reproduce", "fingerprint-tables", "--dataset", "."}).find("--dataset"),
            std::string::npos);
  EXPECT_NE(refused({"reproduce", "threshold-sweep", "--poses", "2000"}).find("--poses"), std::string::npos);
  EXPECT_NE(refused({"reproduce", "threshold-sweep", "--set", "known_start=false"}).find("known_start=true"),
            std::string::npos);
}

/// Studies of fingerprints on a mission folder, here a simulated one.
class ReproduceOnAMission : public testing::Test {
 protected:
  void SetUp() override {
    const auto outcome = run({"simulate", "carpark", "-o", "floor", "--seed", "3", "--robots", "2", "--set",
                              "floor_x_m=40", "floor_y_m=30", "aisles_along_y=3", "aisles_along_x=3",
                              "path_length_m=60", "odometry_rate_hz=2", "access_points=30"},
                             folder());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  const std::filesystem::path& folder() const { return folder_.path(); }
  std::string refusal(const std::vector<std::string>& arguments) const {
    const auto outcome = run(arguments, folder());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    return outcome.err;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ReproduceOnAMission, GivesTheTableOfTheSimulatorsSeed) {
  const std::vector<std::string> call{"reproduce", "threshold-sweep", "--measure", "gaussian", "--json"};
  auto recorded = call, simulated = call;
  recorded.insert(recorded.end(), {"--mission", "floor", "-o", "out"});
  simulated.insert(simulated.end(), {"--seeds", "1", "--seed", "3", "--set", "robots=2", "floor_x_m=40",
                                     "floor_y_m=30", "aisles_along_y=3", "aisles_along_x=3",
                                     "path_length_m=60", "odometry_rate_hz=2", "access_points=30"});
  const auto of_folder = run(recorded, folder()), of_seed = run(simulated, folder());
  ASSERT_EQ(of_folder.status, 0) << of_folder.err;
  ASSERT_EQ(of_seed.status, 0) << of_seed.err;
  const auto a = nlohmann::json::parse(of_folder.out)["missions"][0],
             b = nlohmann::json::parse(of_seed.out)["missions"][0];
  EXPECT_TRUE(a.contains("mission") && b["seed"] == 3);
  EXPECT_EQ(a["measure"], "gaussian");
  EXPECT_NEAR(a["default_ate_m"], b["default_ate_m"], 1e-6) << "but for the digits of the files";
  EXPECT_TRUE(std::filesystem::exists(folder() / "out" / "index.html"));
}

TEST_F(ReproduceOnAMission, TakesAllMeasures) {
  const auto outcome =
      run({"reproduce", "sequence-closures", "--mission", "floor", "--measure", "all", "--json"}, folder());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  ASSERT_EQ(json["cells"].size(), 6U * 36);
  EXPECT_EQ(json["cells"][0]["measure"], "cosine");
  EXPECT_EQ(json["cells"][215]["measure"], "sorensen");
}

TEST_F(ReproduceOnAMission, SaysWhatIsMissing) {
  const std::vector<std::string> tables{"sequence-closures", "fingerprint-tables", "threshold-sweep"};
  for (const std::string& table : tables) {
    EXPECT_NE(refusal({"reproduce", table, "--measure", "gausian"}).find("did you mean gaussian"),
              std::string::npos);
    EXPECT_NE(refusal({"reproduce", table, "--mission", "none"}).find("none"), std::string::npos);
    EXPECT_NE(refusal({"reproduce", table, "--mission", "floor", "--set", "robots=2"}).find("--set"),
              std::string::npos);
  }
  EXPECT_EQ(run({"reproduce", tables[0], "--mission", "floor", "--seeds", "2"}, folder()).status, 2);
  EXPECT_NE(refusal({"reproduce", "rendezvous", "--mission", "floor"}).find("takes no --mission"),
            std::string::npos);
  std::string yaml = read_file(folder() / "floor" / "mission.yaml");
  for (std::size_t at = yaml.find("initial_pose: ["); at != std::string::npos;
       at = yaml.find("initial_pose: ["))
    yaml.erase(yaml.rfind('{', at) + 1, yaml.find(']', at) - yaml.rfind('{', at));
  write_file(folder() / "floor" / "mission.yaml", yaml);
  std::filesystem::remove(folder() / "floor" / "robots" / "a" / "groundtruth.tum");
  EXPECT_NE(refusal({"reproduce", tables[1], "--mission", "floor"}).find("initial_pose"), std::string::npos);
  std::filesystem::remove(folder() / "floor" / "robots" / "b" / "groundtruth.tum");
  EXPECT_NE(refusal({"reproduce", tables[0], "--mission", "floor"}).find("groundtruth.tum"),
            std::string::npos);
}

TEST(SimulateKitti, NotesThatTheRobotsAreNeverInRange) {
  const TemporaryFolder folder;
  std::string straight;
  for (int k = 0; k < 1200; ++k) straight += "1 0 0 0 0 1 0 0 0 0 1 " + std::to_string(k) + "\n";
  write_file(folder.path() / "drive.txt", straight);
  const auto simulate = [&](const std::string& reach) {
    return run({"simulate", "kitti", "-o", "m" + reach, "--trajectory", "drive.txt", "--odometry",
                "drive.txt", "--cut", "0.5", "--set", "radio_range_m=" + reach},
               folder.path());
  };
  const auto apart = simulate("100");
  EXPECT_EQ(apart.status, 0) << apart.err;
  EXPECT_NE(apart.out.find("note: no two robots ever come within reach"), std::string::npos) << apart.out;
  const auto near = simulate("700");
  EXPECT_EQ(near.status, 0) << near.err;
  EXPECT_EQ(near.out.find("note"), std::string::npos) << near.out;
}

TEST(ReproduceProgram, IsNamedWhereItIsNotBuilt) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(RADIOSLAM_PROGRAM, folder.path() / "radioslam");
  FILE* call = popen((folder.path() / "radioslam reproduce aoa-paths 2>&1").c_str(), "r");
  ASSERT_NE(call, nullptr);
  std::string said;
  for (int c = fgetc(call); c != EOF; c = fgetc(call)) said += static_cast<char>(c);
  EXPECT_EQ(WEXITSTATUS(pclose(call)), 2);
  EXPECT_NE(said.find("--target radioslam_reproduce"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
}

TEST(ReproduceProgram, TakesTheThreadsOfTheCall) {
  const TemporaryFolder folder;
  EXPECT_EQ(run({"--threads", "1", "reproduce"}, folder.path()).status, 0);
  EXPECT_EQ(run({"reproduce", "--threads", "0"}, folder.path()).status, 2);
}

}  // namespace
}  // namespace radioslam::cli
