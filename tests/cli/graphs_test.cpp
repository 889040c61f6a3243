// Factor graphs as inputs: JRL logs, several g2o files, stated starts, kept keys, and the truth of their
// loops.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"
#include "io/recorded_data.hpp"

namespace radioslam::cli {
namespace {

using nlohmann::json;

constexpr int kPoses = 6;

std::uint64_t key(char robot, int place) {
  return (std::uint64_t{static_cast<unsigned char>(robot)} << 56) + static_cast<std::uint64_t>(place);
}

json pose(double x, double y) {
  return {{"type", "Pose3"}, {"translation", {x, y, 0}}, {"rotation", {1, 0, 0, 0}}};
}

std::vector<double> covariance(double variance) {
  std::vector<double> entries(36, 0.0);
  for (std::size_t k = 0; k < 6; ++k) entries[7 * k] = variance;
  return entries;
}

json between(std::uint64_t i, std::uint64_t j, const json& measured) {
  return {{"type", "BetweenFactorPose3"},
          {"key1", i},
          {"key2", j},
          {"measurement", measured},
          {"covariance", covariance(1e-4)}};
}

json prior(std::uint64_t at, const json& stated) {
  return {{"type", "PriorFactorPose3"}, {"key", at}, {"prior", stated}, {"covariance", covariance(1e-4)}};
}

/// Robots a and b drive along x, b 2 m to the left; two loops from a to b, the second of them wrong.
json team_log() {
  json log{{"name", "team"}, {"robots", {97, 98}}};
  for (const char robot : {'a', 'b'}) {
    const std::string name(1, robot);
    log["measurements"][name] = json::array();
    for (int k = 0; k < kPoses; ++k) {
      json value = pose(k, robot == 'a' ? 0 : 2);
      value["key"] = key(robot, k);
      log["groundtruth"][name].push_back(value);
      json entry{{"stamp", k}, {"measurements", json::array()}};
      if (k > 0) entry["measurements"].push_back(between(key(robot, k - 1), key(robot, k), pose(1, 0)));
      log["measurements"][name].push_back(entry);
    }
  }
  for (const double off : {0.0, 7.0})
    log["measurements"]["a"].push_back(
        {{"stamp", 9}, {"measurements", {between(key('a', 3), key('b', 2), pose(-1 + off, 2))}}});
  log["outlier_factors"] = {{"a", {{kPoses + 1, 0}}}};
  return log;
}

struct TeamGraphs : testing::Test {
  Outcome run_in(const std::vector<std::string>& arguments) const { return run(arguments, folder.path()); }
  json summary() const { return json::parse(read_file(folder.path() / "out/summary.json")); }
  void write(const std::string& name, const std::string& content) const {
    write_file(folder.path() / name, content);
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) const {
    const Outcome outcome = run_in(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
  }

  TemporaryFolder folder;
};

TEST_F(TeamGraphs, ARunKeepsTheKeysOfItsFile) {
  json log = team_log();
  log["measurements"]["b"][0]["measurements"].push_back({{"type", "CombinedIMUFactor"}});
  write("team.jrl", log.dump());
  const Outcome outcome = run_in({"run", "team.jrl", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: team.jrl: 1 measurements of type CombinedIMUFactor are not used"),
            std::string::npos)
      << outcome.out;
  const std::string graph = read_file(folder.path() / "out/graph.g2o");
  for (const char robot : {'a', 'b'})
    EXPECT_NE(graph.find("VERTEX_SE3:QUAT " + std::to_string(key(robot, kPoses - 1)) + " "),
              std::string::npos);
  EXPECT_NE(graph.find("EDGE_SE3:QUAT " + std::to_string(key('a', 0)) + " "), std::string::npos);
}

/// Robots on one g2o file each, with a line that is cut in half.
TEST_F(TeamGraphs, OptimizationWithoutACentreNamesTheLinesLeftOut) {
  const auto edge = [](char i, int k, char j, int l) {
    return "EDGE_SE2 " + std::to_string(key(i, k)) + " " + std::to_string(key(j, l)) + " 1 0 0 1 0 0 1 0 1\n";
  };
  write("0.g2o", edge('a', 0, 'a', 1) + edge('a', 1, 'b', 0) + edge('a', 1, 'a', 2) + "EDGE_SE2 1 2 0.5\n");
  write("1.g2o", edge('b', 0, 'b', 1));
  const Outcome outcome =
      run_in({"optimize", "--distributed", "separators", "0.g2o", "1.g2o", "-o", "o.g2o"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: 0.g2o: 1 line is left out"), std::string::npos) << outcome.out;
}

TEST_F(TeamGraphs, MethodsThatDoNotBearANetworkRefuseIt) {
  const std::string edge = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
  write("0.g2o", edge);
  for (const char* method : {"separators", "two-stage", "alternating"}) {
    const std::string reason = "--loss-share: " + std::string(method) + " does not bear lost messages";
    expect_refused({"optimize", "--distributed", method, "0.g2o", "-o", "o.g2o", "--loss-share", "0.1"},
                   reason);
    expect_refused({"optimize", "--distributed", method, "0.g2o", "-o", "o.g2o", "--set",
                    "distributed.network.loss_share=0.1"},
                   reason);
  }
  for (const char* method : {"two-stage", "alternating"})
    expect_refused({"optimize", "--distributed", method, "0.g2o", "-o", "o.g2o", "--delay-rounds", "1"},
                   "--delay-rounds: " + std::string(method) + " does not bear late messages");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "o.g2o"));
}

TEST_F(TeamGraphs, ARobotAloneIsOptimisedWithoutACentreToo) {
  const auto edge = [](int i, int j, const std::string& x) {
    return "EDGE_SE2 " + std::to_string(i) + " " + std::to_string(j) + " " + x + " 0 0 1 0 0 1 0 1\n";
  };
  write("0.g2o", edge(0, 1, "1") + edge(1, 2, "1") + edge(0, 2, "2.3"));
  const auto optimum = json::parse(run_in({"optimize", "0.g2o", "-o", "o.g2o", "--json"}).out);
  for (const char* method : {"separators", "asynchronous", "block-coordinate", "two-stage", "alternating"}) {
    const auto found =
        json::parse(run_in({"optimize", "--distributed", method, "0.g2o", "-o", "o.g2o", "--json"}).out);
    EXPECT_NEAR(found["final_cost"].get<double>(), optimum["final_cost"].get<double>(), 1e-6) << method;
    EXPECT_EQ(found["termination"], "converged") << method;
    EXPECT_EQ(found["frames"], json::parse(R"([["a"]])")) << method;
  }
  write("0.g2o", "VERTEX_SE2 0 0 0 0\n");
  const auto nothing =
      json::parse(run_in({"optimize", "--distributed", "separators", "0.g2o", "-o", "o.g2o", "--json"}).out);
  EXPECT_EQ(nothing["termination"], "nothing to do");
}

TEST_F(TeamGraphs, LoopsAreComparedWithTheLabelsOfTheFile) {
  write("team.jrl", team_log().dump());
  ASSERT_EQ(run_in({"run", "team.jrl", "-o", "out"}).status, 0);
  write("out/closures.csv",
        "robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason\na,3,b,2,file,accepted,1,\n"
        "a,3,b,2,file,rejected,99,wrong\n");
  const Outcome outcome = run_in({"evaluate", "out", "team.jrl", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json file = json::parse(outcome.out)["closures"]["file"];
  EXPECT_EQ(file["accepted"], 1);
  EXPECT_EQ(file["true_accepted"], 1);
  EXPECT_EQ(file["rejected"], 1);
  EXPECT_EQ(file["true_rejected"], 0);
  EXPECT_NEAR(file["worst_accepted_m"].get<double>(), 0, 1e-9);
}

TEST_F(TeamGraphs, StatedStartsAreUsedOnRequest) {
  json log = team_log();
  write("unknown.jrl", log.dump());
  expect_refused({"run", "unknown.jrl", "-o", "out", "--known-starts"}, "unknown.jrl: states no starts");
  for (const char robot : {'a', 'b'})
    log["measurements"][std::string(1, robot)][0]["measurements"].push_back(
        prior(key(robot, 0), pose(0, robot == 'a' ? 0 : 2)));
  write("team.jrl", log.dump());
  const Outcome without = run_in({"run", "team.jrl", "-o", "out"});
  ASSERT_EQ(without.status, 0) << without.err;
  EXPECT_NE(without.out.find("without --known-starts"), std::string::npos) << without.out;
  const Outcome with = run_in({"run", "team.jrl", "-o", "out", "--known-starts"});
  ASSERT_EQ(with.status, 0) << with.err;
  EXPECT_EQ(summary()["team_frame"]["components"].size(), 1U);
  EXPECT_EQ(with.out.find("without --known-starts"), std::string::npos) << with.out;
  const Outcome evaluated = run_in({"evaluate", "out", "team.jrl", "--json"});
  EXPECT_LT(json::parse(evaluated.out)["ate_rmse_m"].get<double>(), 0.01);
  write("m/mission.yaml", "format: radioslam-mission/1\nrobots: {a: {}}\n");
  expect_refused({"run", "m", "-o", "out", "--known-starts"}, "mission.yaml");
}

std::string edge(std::uint64_t i, std::uint64_t j) {
  return "EDGE_SE2 " + std::to_string(i) + " " + std::to_string(j) + " 1 0 0 100 0 0 100 0 100\n";
}

TEST_F(TeamGraphs, ATeamMayBeSeveralFilesOrAFolderOfThem) {
  write("team/1.g2o", edge(key('a', 0), key('a', 1)) + "0410268 0.7588833\n");
  write("team/2.g2o", edge(key('b', 0), key('b', 1)));
  for (const auto& inputs : {std::vector<std::string>{"team/1.g2o", "team/2.g2o"}, {"team"}}) {
    std::vector<std::string> call{"run"};
    call.insert(call.end(), inputs.begin(), inputs.end());
    call.insert(call.end(), {"-o", "out"});
    const Outcome outcome = run_in(call);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(summary()["robots"].size(), 2U);
    EXPECT_NE(outcome.out.find("1 line is left out; the first: "), std::string::npos) << outcome.out;
  }
  expect_refused({"run", "team/1.g2o", "team", "-o", "out"}, "team: is not a .g2o file");
  expect_refused({"run", "team/1.g2o", "team/2.g2o", "-o", "team"}, "contains the input");
}

TEST_F(TeamGraphs, TablesOfDpgoBecomeAGraphOrAMission) {
  const std::string header = "robot_src,pose_src,robot_dst,pose_dst,qx,qy,qz,qw,tx,ty,tz,kappa,tau\n";
  const std::string step = ",0,0,0,1,2,0,0,10000,100\n", loop = "0,1,1,0,0,0,0,1,0,3,0,10000,100\n";
  write("tables/robot0/measurements.csv", header + "0,0,0,1" + step + loop);
  write("tables/robot1/measurements.csv", header + "1,0,1,1" + step + loop);
  const Outcome graph = run_in({"import", "dpgo", "tables", "-o", "team.g2o"});
  ASSERT_EQ(graph.status, 0) << graph.err;
  EXPECT_EQ(graph.out, "team.g2o: 2 robots, 4 poses, 3 relative poses\n");
  ASSERT_EQ(run_in({"import", "dpgo", "tables/robot0/measurements.csv", "tables/robot1/measurements.csv",
                    "-o", "mission"})
                .status,
            0);
  for (const char* input : {"team.g2o", "mission"}) {
    const Outcome outcome = run_in({"run", input, "-o", "out"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(summary()["robots"].size(), 2U);
  }
  expect_refused({"import", "dpgo", "out", "-o", "other.g2o"}, "is missing");
}

/// A robot of the plane that drives along x, in g2o: its vertices and steps, without the steps from `gaps`.
std::string drive(char robot, int poses, double y, const std::vector<int>& gaps = {}) {
  std::string text;
  for (int k = 0; k < poses; ++k)
    text += "VERTEX_SE2 " + std::to_string(key(robot, k)) + " " + std::to_string(k) + " " +
            std::to_string(y) + " 0\n";
  for (int k = 0; k + 1 < poses; ++k)
    if (std::find(gaps.begin(), gaps.end(), k) == gaps.end())
      text += "EDGE_SE2 " + std::to_string(key(robot, k)) + " " + std::to_string(key(robot, k + 1)) +
              " 1 0 0 400 0 0 400 0 1e4\n";
  return text;
}

std::string link(char robot_i, int i, char robot_j, int j, double x, double y) {
  return "EDGE_SE2 " + std::to_string(key(robot_i, i)) + " " + std::to_string(key(robot_j, j)) + " " +
         std::to_string(x) + " " + std::to_string(y) + " 0 400 0 0 400 0 1e4\n";
}

std::size_t rows_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Robots a, which lacks the step behind pose 5, and b, 3 m beside it; loops between them before the gap.
std::string gap_team() {
  std::string text = drive('a', 12, 0, {5}) + drive('b', 12, 3);
  for (const int k : {0, 2, 4}) text += link('a', k, 'b', k, 0, 3);
  return text;
}

TEST_F(TeamGraphs, RobotsOfOnePoseEachHaveAResult) {
  const std::string space = "EDGE_SE3:QUAT " + std::to_string(key('a', 0)) + " " +
                            std::to_string(key('b', 0)) +
                            " 1 0 0 0 0 0 1 100 0 0 0 0 0 100 0 0 0 0 100 0 0 0 900 0 0 900 0 900\n";
  write("space.g2o", space);
  write("plane.g2o", link('a', 0, 'b', 0, 1, 0));
  write("pairs.g2o", link('a', 0, 'b', 0, 1, 0) + link('a', 1, 'b', 1, 1, 0));
  for (const char* file : {"space.g2o", "plane.g2o", "pairs.g2o"})
    for (const char* command : {"run", "prune"}) {
      const Outcome outcome = run_in({command, file, "-o", "out"});
      EXPECT_EQ(outcome.status, 0) << file << outcome.err;
      for (const char* robot : {"out/a.tum", "out/b.tum"})
        EXPECT_EQ(rows_of(read_file(folder.path() / robot)), 1U) << file;
    }
}

TEST_F(TeamGraphs, OdometryOfOneRowAndAMatchHaveAResult) {
  write("m/mission.yaml", "format: radioslam-mission/1\nrobots: {a: {}, b: {}}\n");
  for (const char* robot : {"a", "b"})
    write(std::string("m/robots/") + robot + "/odometry.tum", "0 0 0 0 0 0 0 1\n");
  write("m/matches.csv",
        "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw,sigma_t_m,sigma_r_rad\na,0,b,0,1,0,0,0,0,0,1,0.1,0."
        "05\n");
  const Outcome outcome = run_in({"run", "m", "-o", "out"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
}

TEST_F(TeamGraphs, PosesBehindAGapThatNothingTiesHaveNoPose) {
  write("team.g2o", gap_team());
  const Outcome outcome = run_in({"run", "team.g2o", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: 6 poses are not placed"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("a from 6 to 11 s"), std::string::npos) << outcome.out;
  EXPECT_EQ(rows_of(read_file(folder.path() / "out/a.tum")), 6U);
  EXPECT_EQ(rows_of(read_file(folder.path() / "out/b.tum")), 12U);
  EXPECT_EQ(summary()["robots"]["a"]["not_placed"], json::array({{6, 11}}));
  EXPECT_EQ(rows_of(read_file(folder.path() / "out/uncertainty.csv")), 1 + 18U);
  EXPECT_NE(read_file(folder.path() / "out/report.html").find("6 poses are not placed"), std::string::npos);
  const Outcome pruned = run_in({"prune", "team.g2o", "-o", "pruned"});
  EXPECT_EQ(pruned.status, 0) << pruned.err;
  EXPECT_EQ(read_file(folder.path() / "pruned/candidates.csv").find("a,7,"), std::string::npos);
  const Outcome optimum = run_in({"optimize", "team.g2o", "-o", "optimum.g2o"});
  EXPECT_NE(optimum.out.find("note: 2 frames that nothing ties together"), std::string::npos) << optimum.out;
}

TEST_F(TeamGraphs, APartBehindAGapIsPlacedByWhatTiesIt) {
  for (const std::string& tie :
       {link('a', 0, 'a', 11, 11, 0), link('a', 8, 'b', 8, 0, 3) + link('a', 10, 'b', 10, 0, 3)}) {
    write("team.g2o", gap_team() + tie);
    const Outcome outcome = run_in({"run", "team.g2o", "-o", "out"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out.find("not placed"), std::string::npos) << outcome.out;
    const std::string a = read_file(folder.path() / "out/a.tum");
    ASSERT_EQ(rows_of(a), 12U);
    EXPECT_NEAR(std::stod(a.substr(a.find("\n6 ") + 3)), 6, 0.05);
    const std::string sigmas = read_file(folder.path() / "out/uncertainty.csv");
    EXPECT_GT(std::stod(sigmas.substr(sigmas.find("\na,6,") + 5)), 0.01);
  }
}

/// The part that another robot's loops tie is the robot's, not the one before the gap.
TEST_F(TeamGraphs, ARobotIsWhereItsTeamIs) {
  std::string text = drive('a', 12, 0, {2, 5}) + drive('b', 12, 3);
  for (const int k : {7, 9, 11}) text += link('a', k, 'b', k, 0, 3);
  write("team.g2o", text);
  const Outcome outcome = run_in({"run", "team.g2o", "-o", "out"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: 6 poses are not placed"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("1 frame\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(read_file(folder.path() / "out/a.tum").substr(0, 2), "6 ");
}

TEST_F(TeamGraphs, IdsThatContradictEachOtherAreRefusedByEveryReader) {
  std::string stripped;
  for (const double y : {0.0, 3.0})
    for (int k = 0; k < 3; ++k)
      stripped +=
          "VERTEX_SE2 " + std::to_string(k) + " " + std::to_string(k) + " " + std::to_string(y) + " 0\n";
  for (int k = 0; k < 2; ++k)
    stripped += "EDGE_SE2 " + std::to_string(k) + " " + std::to_string(k + 1) + " 1 0 0 1 0 0 1 0 1\n";
  write("stripped.g2o", stripped);
  write("mixed/0.g2o", drive('a', 3, 0));
  write("mixed/1.g2o",
        stripped.substr(0, stripped.find("VERTEX_SE2 0 0.000000 3")) + "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  for (const char* input : {"stripped.g2o", "mixed"}) {
    const std::string words = "letters are missing";
    expect_refused({"run", input, "-o", "out"}, words);
    expect_refused({"prune", input, "-o", "out"}, words);
    expect_refused({"optimize", input, "-o", "out.g2o"}, words);
    expect_refused({"optimize", input, "--distributed", "separators", "-o", "out.g2o"}, words);
    expect_refused({"evaluate", input, input}, input == std::string("mixed") ? "is not a run" : words);
  }
}

TEST_F(TeamGraphs, OptimizeIsRobustWithoutMessagesAndTakesSeveralFiles) {
  std::string a = drive('a', 12, 0), b = drive('b', 12, 3);
  for (const int k : {1, 4, 7, 10}) a += link('a', k, 'b', k, 0, 3);
  a += link('a', 0, 'b', 9, -30, 8);
  write("a.g2o", a);
  write("b.g2o", b);
  const auto optimize = [&](const std::vector<std::string>& options) {
    std::vector<std::string> arguments{"optimize", "a.g2o", "b.g2o", "-o", "out.g2o", "--json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Outcome outcome = run_in(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return json::parse(outcome.out);
  };
  const json plain = optimize({}), robust = optimize({"--robust"});
  EXPECT_EQ(plain["poses"], 24);
  EXPECT_GT(plain["final_cost"].get<double>(), 100);
  EXPECT_LT(robust["final_cost"].get<double>(), 1e-6);
  EXPECT_EQ(robust["weights"].size(), 27U);
  EXPECT_EQ(robust["weights"].back(), 0);
  std::string truth_a, truth_b;
  for (int k = 0; k < 12; ++k) {
    truth_a += std::to_string(k) + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
    truth_b += std::to_string(k) + " " + std::to_string(k) + " 3 0 0 0 0 1\n";
  }
  write("first.tum", truth_a);
  write("second.tum", truth_b);
  const Outcome evaluated =
      run_in({"evaluate", "out.g2o", "--truth", "a=first.tum", "b=second.tum", "--json"});
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  EXPECT_LT(json::parse(evaluated.out)["ate_rmse_m"].get<double>(), 1e-3);
  EXPECT_EQ(json::parse(evaluated.out)["coverage"], 1);
  expect_refused({"evaluate", "out.g2o", "--truth", "c=first.tum"}, "robot 'c' is not in the estimate");
  expect_refused({"evaluate", "out.g2o", "--truth", "first.tum"}, "is not ROBOT=FILE");
  expect_refused({"evaluate", "out.g2o"}, "needs a mission with ground truth, or --truth");
}

TEST_F(TeamGraphs, OptimizeReadsALogWhole) {
  json log = team_log();
  log["measurements"]["a"].erase(kPoses + 1);
  log.erase("outlier_factors");
  write("team.jrl", log.dump());
  const Outcome outcome = run_in({"optimize", "team.jrl", "-o", "team.g2o", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(json::parse(outcome.out)["poses"], 2 * kPoses);
  EXPECT_LT(json::parse(outcome.out)["final_cost"].get<double>(), 1e-9);
  EXPECT_NE(read_file(folder.path() / "team.g2o").find("VERTEX_SE3:QUAT " + std::to_string(key('b', 0))),
            std::string::npos);
}

/// Teams of three robots with real odometry and loops, starts unknown, wrong loops labelled.
struct RecordedTeam {
  const char* file;
  double limit_m;  ///< of least squares over all true factors
};

class RecordedTeams : public testing::TestWithParam<RecordedTeam> {};

TEST_P(RecordedTeams, AreSolvedWithoutStarts) {
  RADIOSLAM_RECORDED(log, std::filesystem::path("cosmo") / GetParam().file);
  const TemporaryFolder folder;
  const Outcome outcome = run({"run", log.string(), "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Outcome evaluated = run({"evaluate", "out", log.string(), "--json"}, folder.path());
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  const json metrics = json::parse(evaluated.out);
  EXPECT_EQ(metrics["coverage"], 1);
  EXPECT_LE(metrics["ate_rmse_m"].get<double>(), 1.2 * GetParam().limit_m);
  const json loops = metrics["closures"]["file"];
  const double true_loops = loops["true_accepted"].get<double>() + loops["true_rejected"].get<double>();
  EXPECT_GE(loops["true_accepted"].get<double>(), 0.95 * true_loops);
  EXPECT_LE(loops["accepted"].get<int>() - loops["true_accepted"].get<int>(), 1);
}

INSTANTIATE_TEST_SUITE_P(Cosmo, RecordedTeams,
                         testing::Values(RecordedTeam{"kth_r3_00_d06_d09_d10_wifi.jrl.zst", 1.88},
                                         RecordedTeam{"ntu_r3_02_d02_n04_n13_wifi.jrl.zst", 2.26},
                                         RecordedTeam{"ntu_r3_02_d02_n04_n13_proradio.jrl.zst", 2.32}),
                         [](const auto& test) {
                           const std::string name = test.param.file;
                           return name.substr(0, 3) +
                                  (name.find("wifi") == std::string::npos ? "Radio" : "Wifi");
                         });

}  // namespace
}  // namespace radioslam::cli
