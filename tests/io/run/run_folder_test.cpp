#include "radioslam/io/run/run_folder.hpp"

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/run/metrics_json.hpp"
#include "radioslam/io/run/run_tables.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

RunResult example() {
  RunResult result;
  result.mission_name = "example";
  result.robots.resize(3);
  for (std::size_t k = 0; k < 2; ++k) {
    result.robots[k].id = k == 0 ? "zoe" : "adam";
    result.robots[k].estimate = Trajectory<SE3>({{{0}, SE3()}, {{1'500'000'000}, lift(SE2({1, 2}, 0.5))}});
  }
  result.robots[2].id = "lost";
  result.robots[2].placed = false;
  result.unplaced = {"lost"};
  result.components = {{{"zoe", "adam"}}};
  result.transforms = {{"zoe", "adam", lift(SE2({1.5, -2}, 0), 0), Eigen::Matrix2d{{4, 0.5}, {0.5, 1}}}};
  result.candidates.push_back({RobotIndex(0), {0}, RobotIndex(1), {1'500'000'000}, 2.5F, 0.75F});
  result.closures = {{RobotIndex(0),
                      {0},
                      RobotIndex(1),
                      {1'500'000'000},
                      ClosureKind::kFingerprint,
                      ClosureStatus::kRejected,
                      17.5,
                      "too far, by half"}};
  result.counts = {{"closures", 1}, {"candidates", 1e6}, {"share", 0.5}};
  result.timings = {{"read", 0.25}};
  result.parameters = {{"keyframe.distance_m", "1", "m", "", false},
                       {"prune.enabled", "true", "", "", false},
                       {"similarity.measure", "mended", "", "", true},
                       {"loss.scale", "2.5", "", "", false}};
  result.angle_checks = {{"zoe", "adam", CheckedPose::kSelfReported, 12, 0.25, 0.75, 1e-4, true}};
  result.notes = {"odometry noise looks larger than stated"};
  return result;
}

TEST(RunFolder, ReadsBackWhatItWrites) {
  const TemporaryFolder folder;
  write_run(folder.path(), example(), {});
  const RunFolder run = read_run(folder.path());
  ASSERT_EQ(run.robots.size(), 3u);
  EXPECT_EQ(run.robots[0].id, "zoe");
  EXPECT_EQ(run.robots[1].poses[1].stamp.ns, 1'500'000'000);
  EXPECT_EQ(run.robots[1].poses[1].pose.translation(), Eigen::Vector3d(1, 2, 0));
  EXPECT_TRUE(run.robots[2].poses.empty());
  EXPECT_EQ(run.unplaced, std::vector<std::string>{"lost"});
  ASSERT_EQ(run.components.size(), 1u);
  EXPECT_EQ(run.components[0].robots, (std::vector<std::string>{"zoe", "adam"}));
  ASSERT_TRUE(run.candidates);
  ASSERT_EQ(run.candidates->size(), 1u);
  const CandidateResult candidate = *run.candidates->begin();
  EXPECT_EQ(candidate.robot_j, RobotIndex(1));
  EXPECT_EQ(candidate.stamp_j.ns, 1'500'000'000);
  EXPECT_EQ(candidate.mahalanobis, 0.75F);
  ASSERT_EQ(run.closures.size(), 1u);
  EXPECT_EQ(run.closures[0].kind, ClosureKind::kFingerprint);
  EXPECT_EQ(run.closures[0].status, ClosureStatus::kRejected);
  EXPECT_EQ(run.closures[0].reason, "too far; by half");
}

TEST(RunFolder, MeasuredDirectionsAreAMissionsTable) {
  const TemporaryFolder folder;
  RunResult result = example();
  write_run(folder.path(), result, {});
  EXPECT_FALSE(fs::exists(folder.path() / "aoa.csv"));
  result.aoa_measurements = {{"zoe",
                              "adam",
                              {1'500'000'000},
                              {{0.25, 0.0625, 0, false}, {1, 0.5, -2, true}, {-3, 0.125, -4.5, false}},
                              {},
                              0.5,
                              {{0.25, {}, 0.0625, 0}, {-3, 0.5, 0.125, -4.5}, {3, -0.5, 0.125, -4.5}}},
                             {"adam", "zoe", {0}, {{2, 0.25, 0, true}}, {}, {}, {{2, {}, 0.25, 0}}}};
  write_run(folder.path(), result, {});
  EXPECT_EQ(folder.read("aoa.csv"),
            "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n"
            "1.5,zoe,adam,0,0.25,,0.0625,0\n"
            "1.5,zoe,adam,1,-3,0.5,0.125,-4.5\n"
            "1.5,zoe,adam,2,3,-0.5,0.125,-4.5\n"
            "0,adam,zoe,0,2,,0.25,0\n");
}

TEST(RunFolder, WhatAnglesAreComparedByReadsBackExactly) {
  const TemporaryFolder folder;
  RunResult result = example();
  result.closures[0].path_weights = {0.1, 1.0 / 3, 3e-17};
  result.aoa_measurements = {
      {"zoe", "adam", {1'500'000'000}, {}, {}, {}, {{0.25, {}, 0.0625, 0}, {-3, 0.5, 0.125, -4.5}}}};
  write_run(folder.path(), result, {});
  const RunFolder run = read_run(folder.path());
  EXPECT_EQ(run.closures[0].path_weights, result.closures[0].path_weights);
  ASSERT_EQ(run.aoa_measurements.size(), 1U);
  const MeasuredAoaResult& angle = run.aoa_measurements[0];
  EXPECT_EQ(angle.receiver, "zoe");
  EXPECT_EQ(angle.transmitter, "adam");
  EXPECT_EQ(angle.stamp.ns, 1'500'000'000);
  ASSERT_EQ(angle.paths.size(), 2U);
  EXPECT_EQ(angle.paths[0].azimuth_rad, 0.25);
  EXPECT_EQ(angle.paths[1].elevation_rad, 0.5);
}

TEST(RunFolder, TheDoubtOfAScanReadsBackExactly) {
  const TemporaryFolder folder;
  RunResult result = example();
  for (const auto doubt : {std::optional<double>(), std::optional<double>(0.1 / 3)}) {
    result.closures[0].doubt = doubt;
    write_run(folder.path(), result, {});
    EXPECT_EQ(read_run(folder.path()).closures[0].doubt, doubt);
  }
}

TEST(RunFolder, AccessPointsAreATableWhereThereAreSome) {
  const TemporaryFolder folder;
  RunResult result = example();
  write_run(folder.path(), result, {});
  EXPECT_FALSE(fs::exists(folder.path() / "access_points.csv"));
  AccessPointResult point;
  point.bssid = "02:00:00:00:00:01";
  point.frequency_mhz = 2437;
  point.position_m = {1.5, -2};
  point.power_at_1m_dbm = -40.5;
  point.exponent = 2.75;
  point.covariance = Eigen::Vector4d(4, 9, 16, 0.25).asDiagonal();
  point.covariance(0, 1) = point.covariance(1, 0) = 1.25;
  point.sigma_db = 5;
  point.readings = 12;
  AccessPointResult other = point;
  other.bssid = "02:00:00:00:00:02";
  other.status = AccessPointStatus::kAmbiguous;
  other.alternative_m = Eigen::Vector2d(1.5, 7);
  result.access_points = {point, other};
  write_run(folder.path(), result, {});
  EXPECT_EQ(folder.read("access_points.csv"),
            "bssid,x_m,y_m,sigma_x_m,sigma_y_m,cov_xy,p0_dbm,exponent,sigma_db,readings,status,sigma_p0_db,"
            "sigma_exponent,frequency_mhz,rival_x_m,rival_y_m\n"
            "02:00:00:00:00:01,1.5,-2,2,3,1.25,-40.5,2.75,5,12,found,4,0.5,2437,,\n"
            "02:00:00:00:00:02,1.5,-2,2,3,1.25,-40.5,2.75,5,12,ambiguous,4,0.5,2437,1.5,7\n");
}

TEST(RunFolder, HasTheFilesAndColumnsOfTheFormat) {
  const TemporaryFolder folder;
  write_run(folder.path(), example(), {nullptr, "VERTEX_SE2 0 0 0 0\n", "<html></html>"});
  EXPECT_EQ(folder.read("candidates.csv"),
            "robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis\nzoe,0,adam,1.5,2.5,0.75\n");
  EXPECT_EQ(folder.read("closures.csv"),
            "robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason,path_weights,x,y,z,qx,qy,qz,qw,doubt\n"
            "zoe,0,adam,1.5,fingerprint,rejected,17.5,too far; by half,,,,,,,,,\n");
  EXPECT_EQ(folder.read("zoe.tum").substr(0, 18), "0 0 0 0 0 0 0 1\n1.");
  EXPECT_EQ(folder.read("graph.g2o"), "VERTEX_SE2 0 0 0 0\n");
  EXPECT_EQ(folder.read("report.html"), "<html></html>");
  EXPECT_FALSE(fs::exists(folder.path() / "lost.tum"));
}

TEST(RunFolder, CandidatesWrittenAsTheyComeAreTheTableOfAList) {
  const TemporaryFolder folder;
  const RunResult result = example();
  {
    CandidateWriter writer(folder.path() / "candidates.csv", {"zoe", "adam", "lost"});
    for (const auto& group : result.candidates.groups()) writer.write(group, result.candidates);
    writer.close();
  }
  const std::string streamed = folder.read("candidates.csv");
  RunDocuments documents;
  documents.candidates = CandidateTable::kWritten;
  RunResult without = result;
  without.candidates = {};
  write_run(folder.path(), without, documents);
  EXPECT_EQ(folder.read("candidates.csv"), streamed) << "the table is left as it is";
  write_run(folder.path(), result, {});
  EXPECT_EQ(folder.read("candidates.csv"), streamed);
}

TEST(RunFolder, HasTheUncertaintyOfEveryKeyframe) {
  const TemporaryFolder folder;
  RunResult result = example();
  result.robots[1].sigma_position_m = {0.25, 1.5};
  result.robots[1].sigma_team_m = {0.125, 0.5};
  result.robots[1].sigma_rad = {0.01, 0.02};
  write_run(folder.path(), result, {});
  EXPECT_EQ(folder.read("uncertainty.csv"),
            "robot,t_s,sigma_m,sigma_team_m,sigma_rad\nadam,0,0.25,0.125,0.01\nadam,1.5,1.5,0.5,0.02\n");
  const RunFolder run = read_run(folder.path());
  EXPECT_TRUE(run.robots[0].sigma_position_m.empty());
  EXPECT_EQ(run.robots[1].sigma_position_m, (std::vector<double>{0.25, 1.5}));
  EXPECT_EQ(run.robots[1].sigma_team_m, (std::vector<double>{0.125, 0.5}));
  EXPECT_EQ(run.robots[1].sigma_rad, (std::vector<double>{0.01, 0.02}));
  EXPECT_EQ(summary_json(result)["robots"]["adam"]["start_sigma_m"], 0.25);
  EXPECT_FALSE(summary_json(result)["robots"]["zoe"].contains("start_sigma_m"));
}

TEST(RunFolder, ClosuresMayEndAtPosesThatAreNotPlaced) {
  RunResult result = example();
  result.robots[1].untied = {{Stamp::from_seconds(2), Stamp::from_seconds(4), 3}};
  result.closures.front().stamp_j = Stamp::from_seconds(3);
  EXPECT_EQ(summary_json(result)["robots"]["adam"]["not_placed"], Json::array({{2.0, 4.0}}));
  EXPECT_FALSE(summary_json(result)["robots"]["zoe"].contains("not_placed"));
  const TemporaryFolder folder;
  write_run(folder.path(), result, {});
  const RunFolder run = read_run(folder.path());
  ASSERT_EQ(run.robots[1].untied.size(), 1u);
  ASSERT_EQ(run.closures.size(), 1u);
  EXPECT_EQ(run.closures[0].stamp_j, Stamp::from_seconds(3));
}

TEST(SummaryJson, HasTheKeysOfTheFormat) {
  const Json json = summary_json(example(), {{"ate_rmse_m", 1.5}});
  EXPECT_EQ(json["robots"]["zoe"]["keyframes"], 2);
  EXPECT_EQ(json["robots"]["lost"]["placed"], false);
  EXPECT_EQ(json["counts"].dump(), R"({"candidates":1000000,"closures":1,"share":0.5})");
  EXPECT_EQ(json["seconds"].dump(), R"({"read":0.25})");
  EXPECT_EQ(
      json["parameters"].dump(),
      R"({"keyframe.distance_m":1,"prune.enabled":true,"similarity.measure":"mended","loss.scale":2.5})");
  EXPECT_EQ(json["team_frame"].dump(),
            R"({"components":[["zoe","adam"]],"unplaced":["lost"],"hypotheses":[{"weight":1.0}],)"
            R"("transforms":[{"robot_i":"zoe","robot_j":"adam","translation_m":[1.5,-2.0,0.0],)"
            R"("rotation_xyzw":[0.0,0.0,0.0,1.0],"covariance":[[4.0,0.5],[0.5,1.0]]}]})");
  EXPECT_EQ(json["metrics"]["ate_rmse_m"], 1.5);
  EXPECT_EQ(json["angle_checks"], Json::array({{{"receiver", "zoe"},
                                                {"transmitter", "adam"},
                                                {"pose", "claim"},
                                                {"measurements", 12},
                                                {"median_weight", 0.25},
                                                {"share_beyond", 0.75},
                                                {"chance", 1e-4},
                                                {"contradicted", true}}}));
  EXPECT_FALSE(summary_json(example()).contains("metrics"));
}

TEST(SummaryJson, ReportsTheStatusOfAnRssiOffset) {
  RunResult result = example();
  const auto offset = [&](RssiOffsetStatus of) {
    result.robots.front().rssi_offset = of;
    return summary_json(result)["robots"][result.robots.front().id];
  };
  EXPECT_FALSE(offset(RssiOffsetStatus::kNotSought).contains("rssi_offset"));
  EXPECT_EQ(offset(RssiOffsetStatus::kNotObserved)["rssi_offset"], "not observed");
  EXPECT_FALSE(offset(RssiOffsetStatus::kNotObserved).contains("rssi_offset_db"));
  EXPECT_EQ(offset(RssiOffsetStatus::kNotSignificant)["rssi_offset"], "not shown");
  result.robots.front().rssi_offset_db = 2.5;
  result.robots.front().sigma_rssi_offset_db = 0.5;
  EXPECT_EQ(offset(RssiOffsetStatus::kCorrected)["rssi_offset"], "taken off");
  EXPECT_EQ(offset(RssiOffsetStatus::kCorrected)["rssi_offset_db"], 2.5);
}

TEST(MetricsJson, HasTheKeysOfTheFormatAndNullForWhatWasNotMeasured) {
  TeamMetrics metrics;
  metrics.ate = ErrorStatistics{1, 2, 3, 4, 5};
  metrics.coverage = 0.5;
  metrics.robots.resize(1);
  metrics.robots[0].id = "a";
  EXPECT_EQ(
      metrics_json(metrics).dump(),
      R"({"ate_rmse_m":1.0,"ate_mean_m":2.0,"ate_median_m":3.0,"ate_p90_m":4.0,"rpe":null,"rotation":null,"consistency":null,)"
      R"("coverage":0.5,)"
      R"("robots":{"a":{"ate_rmse_m":null,"ate_mean_m":null,"ate_median_m":null,"ate_p90_m":null,)"
      R"("coverage":0.0}}})");
  EXPECT_EQ(pair_counts_json({10, 4, 3, 2}).dump(), R"({"pairs":10,"true":4,"kept":3,"true_kept":2})");
}

TEST(MetricsJson, OnlyAnglesHaveCountsOfPaths) {
  EXPECT_EQ(closures_by_kind_json(
                {{ClosureKind::kRange, {4, 3, 2, 1, 0, 0, 0}}, {ClosureKind::kAoa, {6, 3, 2, 1, 3, 2, 1}}})
                .dump(),
            R"({"range":{"accepted":4,"true_accepted":3,"rejected":2,"true_rejected":1},)"
            R"("aoa":{"accepted":6,"true_accepted":3,"rejected":2,"true_rejected":1,)"
            R"("direct_found":3,"wrong_path":2,"none_direct":1}})");
}

TEST(ReadRun, TakesAFolderOfTrajectoriesAlone) {
  const TemporaryFolder folder;
  folder.write("b.tum", "0 0 0 0 0 0 0 1\n");
  folder.write("a.tum", "0 0 0 0 0 0 0 1\n");
  const RunFolder run = read_run(folder.path());
  ASSERT_EQ(run.robots.size(), 2u);
  EXPECT_EQ(run.robots[0].id, "a");
  EXPECT_TRUE(run.summary.is_null());
}

void expect_refused(const char* file, const std::string& content, std::size_t line,
                    const std::string& words) {
  const TemporaryFolder folder;
  write_run(folder.path(), example(), {});
  folder.write(file, content);
  expect_refusal([&] { read_run(folder.path()); }, line, words);
}

TEST(ReadRun, RefusesMalformedFiles) {
  expect_refused("summary.json", "{\n\"robots\": {\n", 3, "not valid JSON");
  expect_refused("summary.json", "{\"robots\": 1e999}", 0, "too large");
  expect_refused("summary.json", "[]", 1, "'robots' is missing");
  expect_refused("summary.json", R"({"robots": {"a/../b": {}}})", 0, "contains a path");
  expect_refused("summary.json", R"({"robots": {}, "team_frame": {"unplaced": [1]}})", 1, "list of robots");
  expect_refused("summary.json", R"({"robots": {"eve": {}}})", 0, "eve.tum: no such file");
  expect_refused("zoe.tum", "0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1\n", 2, "twice");
  const std::string header = "robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason\n";
  expect_refused("closures.csv", header + "zoe,0,eve,0,range,accepted,1,\n", 2, "unknown robot 'eve'");
  expect_refused("closures.csv", header + "zoe,0,adam,0,magic,accepted,1,\n", 2, "unknown word 'magic'");
  expect_refused("closures.csv", header + "zoe,0.5,adam,0,range,accepted,1,\n", 2, "no keyframe at 0.5");
  expect_refused("closures.csv",
                 "robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason,path_weights\n"
                 "zoe,0,adam,0,aoa,accepted,1,,0.5 x\n",
                 2, "path weight 'x'");
  expect_refused("aoa.csv",
                 "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n"
                 "0,zoe,eve,0,1,,0.1,0\n",
                 2, "eve");
  expect_refused("uncertainty.csv", "robot,t_s,sigma_m\nzoe,1.5,1\n", 2, "not those of zoe.tum");
  expect_refused("uncertainty.csv", "robot,t_s,sigma_m\nzoe,0,-1\n", 2, "must not be negative");
  expect_refused("uncertainty.csv", "robot,t_s,sigma_m\nzoe,0,1\n", 0, "fewer rows of robot 'zoe'");
  expect_refused("candidates.csv", "robot_i,t_i_s,robot_j,t_j_s,distance_m\n", 1, "'mahalanobis' is missing");
}

TEST(ReadRun, RefusesAFolderThatIsNoRun) {
  const TemporaryFolder folder;
  expect_refusal([&] { read_run(folder.path()); }, 0, "is not a run");
  expect_refusal([&] { read_run(folder.path() / "none"); }, 0, "no such run folder");
}

}  // namespace
}  // namespace radioslam
