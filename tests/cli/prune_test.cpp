// radioslam prune, and factor graphs as input instead of missions.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

/// A small town, simulated once.
class Prune : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new TemporaryFolder;
    const auto outcome =
        run({"simulate", "city", "-o", "m", "--seed", "3", "--set", "path_length_m=500", "min_contact_s=8",
             "blocks_x=3", "blocks_y=3", "odometry_rate_hz=2.5", "links=20"},
            folder());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static const std::filesystem::path& folder() { return folder_->path(); }
  /// The search with fewer alignment hypotheses, for speed.
  static Outcome prune(const std::string& out, const std::vector<std::string>& more) {
    std::vector<std::string> words{"prune",
                                   "m",
                                   "-o",
                                   out,
                                   "--set",
                                   "alignment.references=3",
                                   "alignment.tried_places=12",
                                   "alignment.refined_places=4"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words, folder());
  }

 private:
  inline static TemporaryFolder* folder_ = nullptr;
};

std::size_t rows(const std::string& csv) {
  return static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')) - 1;
}

TEST_F(Prune, PrintsOneJsonObjectWithItsCounts) {
  const auto outcome = prune("json", {"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  const auto json = nlohmann::json::parse(outcome.out);
  for (const char* key : {"pairs", "candidates", "distances_evaluated", "seconds"})
    ASSERT_TRUE(json.contains(key)) << key;
  EXPECT_TRUE(json["seconds"].contains("overlap"));
  const auto files = files_in(folder() / "json");
  EXPECT_TRUE(std::count(files.begin(), files.end(), "candidates.csv"));
  const std::string csv = read_file(folder() / "json/candidates.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis");
  EXPECT_EQ(json["candidates"], rows(csv));
  const auto keyframes = [&](const char* file) {
    const std::string tum = read_file(folder() / "json" / file);
    return static_cast<std::size_t>(std::count(tum.begin(), tum.end(), '\n')) -
           static_cast<std::size_t>(std::count(tum.begin(), tum.end(), '#'));
  };
  EXPECT_EQ(json["pairs"], keyframes("a.tum") * keyframes("b.tum"));
  EXPECT_LT(json["distances_evaluated"], json["pairs"]);
}

TEST_F(Prune, ExhaustiveGivesTheSameBytesInBothModes) {
  for (const std::string mode : {"joint", "link"}) {
    ASSERT_EQ(prune("tree", {"--mode", mode}).status, 0);
    const auto all = prune("all", {"--mode", mode, "--exhaustive", "--json"});
    ASSERT_EQ(all.status, 0) << all.err;
    const std::string csv = read_file(folder() / "tree/candidates.csv");
    EXPECT_GT(rows(csv), 50U) << mode;
    EXPECT_EQ(csv, read_file(folder() / "all/candidates.csv")) << mode;
    const auto json = nlohmann::json::parse(all.out);
    EXPECT_GE(json["distances_evaluated"], json["pairs"]) << mode;
  }
}

TEST_F(Prune, DistributedGivesTheSameBytesInBothModesAndSaysWhatItSends) {
  for (const std::string mode : {"joint", "link"}) {
    ASSERT_EQ(prune("tree", {"--mode", mode}).status, 0);
    const auto outcome = prune("parties", {"--mode", mode, "--distributed", "--json"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(read_file(folder() / "parties/candidates.csv"), read_file(folder() / "tree/candidates.csv"))
        << mode;
    const auto json = nlohmann::json::parse(outcome.out);
    const auto summary = nlohmann::json::parse(read_file(folder() / "parties/summary.json"));
    EXPECT_EQ(json["bytes"], summary["bytes"]);
    EXPECT_GT(json["rounds"], 1);
    for (const char* robot : {"a", "b"}) {
      ASSERT_EQ(json["bytes"][robot].size(), 5U) << mode;
      EXPECT_GT(json["bytes"][robot]["estimate"], 0);
      EXPECT_GT(json["log_bytes"][robot], 0);
    }
    for (const char* kind : {"requests", "pairs"}) {
      EXPECT_GT(json["bytes"]["a"][kind], 0) << "the robot listed first asks";
      EXPECT_EQ(json["bytes"]["b"][kind], 0);
    }
    for (const char* kind : {"boxes", "poses"}) {
      EXPECT_GT(json["bytes"]["b"][kind], 0) << "and the other one answers";
      EXPECT_EQ(json["bytes"]["a"][kind], 0);
    }
  }
  const auto logged = run({"run", "m", "-o", "logged", "--log", "logs", "--set", "alignment.references=3",
                           "alignment.tried_places=12", "alignment.refined_places=4"},
                          folder());
  ASSERT_EQ(logged.status, 0) << logged.err;
  const auto summary = nlohmann::json::parse(read_file(folder() / "parties/summary.json"));
  for (const char* robot : {"a", "b"})
    EXPECT_EQ(summary["log_bytes"][robot],
              std::filesystem::file_size(folder() / "logs" / (std::string(robot) + ".rslog")));
}

TEST_F(Prune, ListsAllWhereRunListsTheMostProbable) {
  const std::vector<std::string> ten{"--set", "overlap.max_listed_candidates=10"};
  ASSERT_EQ(prune("all", {}).status, 0);
  ASSERT_EQ(prune("pruned", ten).status, 0);
  const std::string all = read_file(folder() / "all/candidates.csv");
  EXPECT_GT(rows(all), 50U);
  EXPECT_EQ(read_file(folder() / "pruned/candidates.csv"), all);
  const auto counts = nlohmann::json::parse(read_file(folder() / "pruned/summary.json"))["counts"];
  EXPECT_EQ(counts["candidates"], rows(all));
  EXPECT_EQ(counts["candidates_listed"], rows(all));

  const auto ran =
      run({"run", "m", "-o", "ran", "--set", "alignment.references=3", "alignment.tried_places=12",
           "alignment.refined_places=4", "overlap.max_listed_candidates=10"},
          folder());
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("note: candidates.csv lists the most probable 10 of "), std::string::npos)
      << ran.out;
  EXPECT_EQ(rows(read_file(folder() / "ran/candidates.csv")), 10U);
  const auto evaluated = run({"evaluate", "ran", "m", "--json"}, folder());
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  const auto json = nlohmann::json::parse(evaluated.out);
  EXPECT_EQ(json["candidates"]["kept"], 10);
  EXPECT_EQ(json["candidates"]["listed"], 10);
  EXPECT_EQ(json["candidates"]["found"], rows(all));
  ASSERT_EQ(json["notes"].size(), 1U);
  EXPECT_NE(json["notes"][0].get<std::string>().find("lists the most probable 10 of"), std::string::npos);
}

TEST_F(Prune, AnUnknownModeIsRefused) {
  const auto outcome = prune("none", {"--mode", "both"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("--mode"), std::string::npos) << outcome.err;
  EXPECT_FALSE(std::filesystem::exists(folder() / "none"));
}

/// Two robots that drive 6 m along x, 4 m apart, and range each other and a landmark at every pose, exactly.
std::string two_robots_graph() {
  std::string vertices, edges;
  const auto number = [](double x) { return std::to_string(x); };
  for (int k = 0; k <= 6; ++k) {
    const std::string t = number(k), name = std::to_string(k);
    // A drives along x; B starts at (1, 4) and bears 0.5 rad to the left.
    const double ax = k, bx = 1 + k * std::cos(0.5), by = 4 + k * std::sin(0.5);
    vertices += "VERTEX_SE2 " + t + " A" + name + " " + number(ax) + " 0 0\n";
    vertices += "VERTEX_SE2 " + t + " B" + name + " " + number(bx) + " " + number(by) + " 0.5\n";
    edges +=
        "EDGE_RANGE " + t + " A" + name + " B" + name + " " + number(std::hypot(bx - ax, by)) + " 0.01\n";
    edges += "EDGE_RANGE " + t + " A" + name + " L0 " + number(std::hypot(3 - ax, 2)) + " 0.01\n";
    edges += "EDGE_RANGE " + t + " B" + name + " L0 " + number(std::hypot(3 - bx, 2 - by)) + " 0.01\n";
    if (k == 0) continue;
    const std::string before = std::to_string(k - 1);
    for (const char* robot : {"A", "B"})
      edges +=
          "EDGE_SE2 " + t + " " + robot + before + " " + robot + name + " 1 0 0 0.0001 0 0 0.0001 0 0.0001\n";
  }
  return vertices + "VERTEX_XY L0 3 2\n" + edges;
}

TEST(Graphs, RunAndEvaluateAcceptThemInsteadOfMissions) {
  const TemporaryFolder folder;
  write_file(folder.path() / "team.pyfg", two_robots_graph());
  const auto outcome = run({"run", "team.pyfg", "-o", "out"}, folder.path());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto files = files_in(folder.path() / "out");
  for (const char* file : {"A.tum", "B.tum", "graph.g2o", "summary.json", "closures.csv", "report.html"})
    EXPECT_TRUE(std::count(files.begin(), files.end(), file)) << file;
  const auto summary = nlohmann::json::parse(read_file(folder.path() / "out/summary.json"));
  EXPECT_EQ(summary["team_frame"]["components"].size(), 1U) << summary["team_frame"];

  const auto evaluated = run({"evaluate", "out", "team.pyfg", "--json"}, folder.path());
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  const auto json = nlohmann::json::parse(evaluated.out);
  EXPECT_EQ(json["coverage"], 1);
  // Straight trajectories have a mirror solution; one of the two hypotheses is the true one.
  double best = json["ate_rmse_m"];
  if (std::filesystem::exists(folder.path() / "out/hypotheses/1")) {
    const auto other = run({"evaluate", "out/hypotheses/1", "team.pyfg", "--json"}, folder.path());
    ASSERT_EQ(other.status, 0) << other.err;
    best = std::min(best, nlohmann::json::parse(other.out)["ate_rmse_m"].get<double>());
  }
  EXPECT_LT(best, 0.05);
}

TEST(Graphs, ATruncatedOneIsRefusedWithItsLine) {
  const TemporaryFolder folder;
  write_file(folder.path() / "team.pyfg", two_robots_graph() + "EDGE_RANGE 1 A0 B0\n");
  const auto outcome = run({"run", "team.pyfg", "-o", "out"}, folder.path());
  EXPECT_EQ(outcome.status, 2);
  const auto graph = two_robots_graph();
  const auto line = std::count(graph.begin(), graph.end(), '\n') + 1;
  EXPECT_NE(outcome.err.find("team.pyfg:" + std::to_string(line) + ":"), std::string::npos) << outcome.err;
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"team.pyfg"});
}

}  // namespace
}  // namespace radioslam::cli
