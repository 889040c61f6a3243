// `evaluate` on incomplete runs, and `run` on robots it cannot place.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kWalk = "0 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 4 0 0 0 0 0 1\n";

/// Two robots with known starts and a third, c, without any measurement that relates it to them.
class Evaluate : public testing::Test {
 protected:
  Evaluate() {
    write_file(folder() / "m/mission.yaml",
               "format: radioslam-mission/1\nrobots:\n  a: {initial_pose: [0, 0, 0, 0]}\n"
               "  b: {initial_pose: [0, 5, 0, 0]}\n  c: {}\n");
    for (const char* robot : {"a", "b", "c"})
      for (const char* file : {"odometry.tum", "groundtruth.tum"})
        write_file(folder() / "m/robots" / robot / file, kWalk);
    ran_ = run({"run", "m", "-o", "out"}, folder());
    EXPECT_EQ(ran_.status, 0) << ran_.err;
  }

  const fs::path& folder() const { return folder_.path(); }
  const Outcome& ran() const { return ran_; }

  Outcome evaluate(std::vector<std::string> options = {}) const {
    std::vector<std::string> arguments = {"evaluate", "out", "m"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    return run(arguments, folder());
  }
  nlohmann::json evaluated() const {
    const auto outcome = evaluate({"--json"});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return nlohmann::json::parse(outcome.out);
  }
  void write(const std::string& file, const std::string& content) const {
    write_file(folder() / "out" / file, content);
  }

 private:
  TemporaryFolder folder_;
  Outcome ran_;
};

TEST_F(Evaluate, RunReportsItsErrorWithTheCoverage) {
  EXPECT_NE(ran().out.find(" m rmse over 66.6 % of the true poses\n"), std::string::npos) << ran().out;
  write_file(folder() / "m/mission.yaml",
             "format: radioslam-mission/1\nrobots:\n  a: {initial_pose: [0, 0, 0, 0]}\n"
             "  b: {initial_pose: [0, 5, 0, 0]}\n  c: {initial_pose: [0, 9, 0, 0]}\n");
  const auto whole = run({"run", "m", "-o", "out"}, folder());
  EXPECT_NE(whole.out.find(" m rmse\n"), std::string::npos) << whole.out;
}

TEST_F(Evaluate, NamesRobotsThatCouldNotBePlaced) {
  EXPECT_NE(ran().out.find("note: robot c is not placed"), std::string::npos) << ran().out;
  EXPECT_EQ(ran().out.find("robot b is not placed"), std::string::npos) << ran().out;
  const auto text = evaluate().out;
  EXPECT_NE(text.find("note: robot c is not placed: it counts as not covered\n"), std::string::npos) << text;
  const auto json = evaluated();
  EXPECT_EQ(json["notes"].size(), 1U);
  EXPECT_EQ(json["robots"]["c"]["coverage"], 0);
}

TEST_F(Evaluate, NotesAMissingSummary) {
  fs::remove(folder() / "out/summary.json");
  const auto outcome = evaluate();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("note: out has no summary.json"), std::string::npos) << outcome.out;
}

TEST_F(Evaluate, RefusesPairsAtStampsThatAreNoKeyframes) {
  const std::string closures = "robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason\n";
  const std::string candidates = "robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis\n";
  write("closures.csv", closures + "a,1,b,2,range,accepted,1,\na,1,b,1.5,range,accepted,1,\n");
  const auto outcome = evaluate();
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("closures.csv:3: robot 'b' has no keyframe at 1.5"), std::string::npos)
      << outcome.err;
  write("closures.csv", closures + "a,1,b,2.000,range,accepted,1,\n");
  write("candidates.csv", candidates + "a,3,b,2,1,1\n");
  const auto again = evaluate();
  EXPECT_EQ(again.status, 2);
  EXPECT_NE(again.err.find("candidates.csv:2: robot 'a' has no keyframe at 3"), std::string::npos)
      << again.err;
}

TEST_F(Evaluate, DistinguishesNoCandidatesFromNoSearch) {
  auto json = evaluated();
  EXPECT_TRUE(json["candidates"]["kept"].is_null());
  EXPECT_TRUE(json["candidates"]["true_kept"].is_null());
  EXPECT_EQ(json["candidates"]["pairs"], 27);

  auto summary = nlohmann::json::parse(read_file(folder() / "out/summary.json"));
  summary["counts"]["candidates"] = 0;
  write("summary.json", summary.dump());
  EXPECT_EQ(evaluated()["candidates"]["kept"], 0);

  write("candidates.csv", "robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis\na,1,b,1,5,1\n");
  EXPECT_EQ(evaluated()["candidates"]["kept"], 1);
}

}  // namespace
}  // namespace radioslam::cli
