// `evaluate` on incomplete runs, and `run` on robots it cannot place.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

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
  EXPECT_TRUE(json["candidates"]["found"].is_null());
  EXPECT_EQ(json["candidates"]["pairs"], 27);

  auto summary = nlohmann::json::parse(read_file(folder() / "out/summary.json"));
  summary["counts"]["candidates"] = 0;
  write("summary.json", summary.dump());
  EXPECT_EQ(evaluated()["candidates"]["kept"], 0);

  write("candidates.csv", "robot_i,t_i_s,robot_j,t_j_s,distance_m,mahalanobis\na,1,b,1,5,1\n");
  EXPECT_EQ(evaluated()["candidates"]["kept"], 1);
}

/// All robots are at x = 0, 2 and 4 m, with LiDARs of 30 m.
TEST_F(Evaluate, TruePairsShareWhatTheRunAskedFor) {
  EXPECT_EQ(evaluated()["candidates"]["true"], 27);
  auto summary = nlohmann::json::parse(read_file(folder() / "out/summary.json"));
  ASSERT_EQ(summary["parameters"]["overlap.min_shared_view"], 0);
  summary["parameters"]["overlap.min_shared_view"] = 0.9;
  write("summary.json", summary.dump());
  EXPECT_EQ(evaluated()["candidates"]["true"], 21) << "up to 2.4 m apart";
  const auto within_a_metre = evaluate({"--radius", "1", "--json"});
  EXPECT_EQ(nlohmann::json::parse(within_a_metre.out)["candidates"]["true"], 9) << "a radius overrides it";
  summary["parameters"].erase("overlap.min_shared_view");
  write("summary.json", summary.dump());
  EXPECT_EQ(evaluated()["candidates"]["true"], 27) << "a folder of an earlier version";
}

/// The fields of a table's rows.
std::vector<std::vector<std::string>> rows_of(const fs::path& path) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream text(read_file(path));
  std::string line;
  std::getline(text, line);
  while (std::getline(text, line)) {
    auto& row = rows.emplace_back();
    std::istringstream fields(line + ",");
    for (std::string field; std::getline(fields, field, ',');) row.push_back(field);
  }
  return rows;
}

/// Recomputed from the label and the weights alone: the hall's angles have a label each, and their closures
/// are in the same order as they are all covered.
nlohmann::json counts_of_paths(const fs::path& mission, const fs::path& out) {
  const auto labels = rows_of(mission / "radio/direct_paths.csv");
  std::size_t k = 0;
  std::map<std::string, int> counts{{"accepted", 0},      {"rejected", 0},     {"true_accepted", 0},
                                    {"true_rejected", 0}, {"direct_found", 0}, {"wrong_path", 0},
                                    {"none_direct", 0}};
  for (const auto& row : rows_of(out / "closures.csv")) {
    if (row[4] != "aoa") continue;
    std::istringstream field(row[8]);
    const std::vector<double> weights{std::istream_iterator<double>(field), {}};
    const auto likeliest = std::max_element(weights.begin(), weights.end()) - weights.begin();
    const long direct = std::stol(labels.at(k++)[3]);
    ++counts[row[5]];
    counts["true_" + row[5]] += likeliest == direct;
    if (row[5] == "accepted")
      ++counts[likeliest == direct ? "direct_found" : direct < 0 ? "none_direct" : "wrong_path"];
  }
  EXPECT_EQ(k, labels.size());
  return counts;
}

TEST(EvaluateAngles, CountsThePathsThatTheRunAcceptedByTheirLabels) {
  const TemporaryFolder folder;
  int wrong = 0, none = 0;
  for (const char* seed : {"2", "3", "4"}) {
    ASSERT_EQ(run({"simulate", "hall", "-o", "m", "--seed", seed}, folder.path()).status, 0);
    ASSERT_EQ(run({"run", "m", "-o", "out"}, folder.path()).status, 0);
    const auto outcome = run({"evaluate", "out", "m", "--json"}, folder.path());
    const auto counts = nlohmann::json::parse(outcome.out)["closures"]["aoa"];
    EXPECT_EQ(counts, counts_of_paths(folder.path() / "m", folder.path() / "out")) << "seed " << seed;
    const auto summary = nlohmann::json::parse(read_file(folder.path() / "out/summary.json"));
    EXPECT_EQ(summary["metrics"]["closures"]["aoa"], counts) << "seed " << seed;
    wrong += counts["wrong_path"].get<int>();
    none += counts["none_direct"].get<int>();
  }
  EXPECT_GT(wrong, 0);  // else the test would not tell the accepted path from any path
  EXPECT_GT(none, 0);
}

TEST(EvaluateMirrored, RunAndEvaluateNoteAMirroredTruth) {
  const TemporaryFolder folder;
  write_file(folder.path() / "m/mission.yaml", "format: radioslam-mission/1\nrobots:\n  a: {}\n");
  const auto corner = [&](const std::string& sign) {
    return "0 0 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 4 0 0 0 0 0 1\n3 4 " + sign + "2 0 0 0 0 1\n4 4 " + sign +
           "4 0 0 0 0 1\n";
  };
  const auto robot = folder.path() / "m/robots/a";
  write_file(robot / "odometry.tum", corner(""));
  for (const char* sign : {"", "-"}) {
    write_file(robot / "groundtruth.tum", corner(sign));
    const auto ran = run({"run", "m", "-o", "out", "--unchecked"}, folder.path());
    ASSERT_EQ(ran.status, 0) << ran.err;
    const auto outcome = run({"evaluate", "out", "m", "--json"}, folder.path());
    const std::size_t notes = *sign == '-' ? 1 : 0;
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["notes"].size(), notes) << outcome.out;
    EXPECT_EQ(ran.out.find("only as a mirror image") != std::string::npos, notes == 1) << ran.out;
  }
}

/// Positions of access points place a team of unknown starts in their frame; a wrong one is named, and both
/// are compared with where the run locates the access points.
TEST(EvaluateAccessPoints, KnownPositionsAreUsedAndCompared) {
  const TemporaryFolder folder;
  ASSERT_EQ(run({"simulate", "carpark", "-o", "m", "--seed", "3", "--set", "path_length_m=400",
                 "known_start=false", "phones=2", "known_access_points=25"},
                folder.path())
                .status,
            0);
  const auto evaluated = [&] {
    const Outcome ran = run({"run", "m", "-o", "out"}, folder.path());
    EXPECT_EQ(ran.status, 0) << ran.err;
    const Outcome outcome = run({"evaluate", "out", "m", "--json"}, folder.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return std::pair(ran.out, nlohmann::json::parse(outcome.out));
  };
  const auto [notes, right] = evaluated();
  EXPECT_NE(notes.find(" access points at the positions of radio/anchors.csv give "), std::string::npos)
      << notes;
  EXPECT_LT(right["ate_rmse_m"].get<double>(), 1);
  EXPECT_GE(right["access_points"]["known"].get<int>(), 15);
  EXPECT_GE(right["access_points"]["located"].get<int>(), 8);
  EXPECT_LT(right["access_points"]["median_m"].get<double>(), 6);
  // The poses are in the frame of the positions, not of the first robot's start.
  const std::string start = read_file(folder.path() / "out/a.tum"),
                    truth = read_file(folder.path() / "m/robots/a/groundtruth.tum");
  double t = 0, x = 0, y = 0, true_x = 0, true_y = 0;
  std::istringstream(start) >> t >> x >> y;
  std::istringstream(truth) >> t >> true_x >> true_y;
  EXPECT_LT(std::hypot(x - true_x, y - true_y), 8);

  std::string anchors = read_file(folder.path() / "m/radio/anchors.csv");
  const std::size_t row = anchors.find('\n') + 1, comma = anchors.find(',', row);
  anchors.replace(comma, anchors.find('\n', row) - comma, ",10,50,2.8,0.5");
  write_file(folder.path() / "m/radio/anchors.csv", anchors);
  const auto wrong = evaluated().second;
  EXPECT_LT(wrong["ate_rmse_m"].get<double>(), 1.5);
}

}  // namespace
}  // namespace radioslam::cli
