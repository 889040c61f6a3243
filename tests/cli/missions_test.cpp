// Missions from end to end: simulated, run, evaluated, damaged, interrupted.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// A short mission of two robots, simulated once.
class Missions : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    const auto outcome =
        run({"simulate", "carpark", "-o", "m", "--seed", "3", "--set", "path_length_m=150"}, shared_->path());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  static void TearDownTestSuite() { delete shared_; }

  void SetUp() override { fs::copy(shared_->path() / "m", mission(), fs::copy_options::recursive); }

  fs::path mission() const { return folder_.path() / "m"; }
  const fs::path& folder() const { return folder_.path(); }
  void edit(const std::string& file, const std::function<std::string(std::string)>& change) const {
    write_file(mission() / file, change(read_file(mission() / file)));
  }

 private:
  inline static TemporaryFolder* shared_ = nullptr;
  TemporaryFolder folder_;
};

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The text with its line `number` (from 1) replaced.
std::string with_line(const std::string& text, std::size_t number, const std::string& line) {
  std::size_t begin = 0;
  for (std::size_t i = 1; i < number; ++i) begin = text.find('\n', begin) + 1;
  return text.substr(0, begin) + line + text.substr(text.find('\n', begin));
}

TEST_F(Missions, RunWritesWhatItPromisesAndEvaluateReadsIt) {
  const auto outcome = run({"run", "m", "-o", "out"}, folder());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(files_in(folder() / "out"),
            (std::vector<std::string>{"a.tum", "access_points.csv", "b.tum", "candidates.csv", "closures.csv",
                                      "dense/a.tum", "dense/b.tum", "graph.g2o", "report.html",
                                      "summary.json", "uncertainty.csv"}));
  const auto summary = nlohmann::json::parse(read_file(folder() / "out/summary.json"));
  for (const char* key : {"robots", "counts", "seconds", "parameters", "team_frame", "metrics"}) {
    EXPECT_TRUE(summary.contains(key)) << key;
  }
  EXPECT_EQ(summary["parameters"]["keyframe.distance_m"], 1);

  const auto evaluated = run({"evaluate", "out", "m", "--json"}, folder());
  ASSERT_EQ(evaluated.status, 0) << evaluated.err;
  const auto json = nlohmann::json::parse(evaluated.out);
  for (const char* key : {"ate_rmse_m", "ate_mean_m", "ate_median_m", "ate_p90_m", "rpe", "coverage",
                          "robots", "candidates", "closures"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  for (const char* key : {"pairs", "true", "kept", "true_kept"})
    EXPECT_TRUE(json["candidates"].contains(key)) << key;
  EXPECT_DOUBLE_EQ(json["ate_rmse_m"], summary["metrics"]["ate_rmse_m"]);
}

TEST_F(Missions, TheTruthChangesNothingInTheEstimate) {
  ASSERT_EQ(run({"run", "m", "-o", "out"}, folder()).status, 0);
  fs::remove(mission() / "robots/a/groundtruth.tum");
  fs::remove(mission() / "robots/b/groundtruth.tum");
  ASSERT_EQ(run({"run", "m", "-o", "blind"}, folder()).status, 0);
  for (const char* file : {"a.tum", "b.tum", "closures.csv", "graph.g2o"}) {
    EXPECT_EQ(read_file(folder() / "out" / file), read_file(folder() / "blind" / file)) << file;
  }
  const auto evaluated = run({"evaluate", "blind", "m"}, folder());
  EXPECT_EQ(evaluated.status, 2);
  EXPECT_NE(evaluated.err.find("groundtruth.tum"), std::string::npos);
}

TEST_F(Missions, TheSameBytesForAnyNumberOfThreads) {
  ASSERT_EQ(run({"run", "m", "-o", "one", "--threads", "1"}, folder()).status, 0);
  ASSERT_EQ(run({"run", "m", "-o", "two", "--threads", "2"}, folder()).status, 0);
  ASSERT_EQ(run({"run", "m", "-o", "three", "--threads", "3"}, folder()).status, 0);
  for (const char* file : {"a.tum", "b.tum", "candidates.csv", "closures.csv", "graph.g2o"}) {
    EXPECT_EQ(read_file(folder() / "one" / file), read_file(folder() / "two" / file)) << file;
    EXPECT_EQ(read_file(folder() / "one" / file), read_file(folder() / "three" / file)) << file;
  }
}

TEST_F(Missions, TheSameSeedGivesTheSameMission) {
  for (const char* name : {"x", "y"}) {
    ASSERT_EQ(run({"simulate", "carpark", "-o", name, "--seed", "3", "--set", "path_length_m=150"}, folder())
                  .status,
              0);
  }
  ASSERT_EQ(files_in(folder() / "x"), files_in(mission()));
  for (const auto& file : files_in(mission())) {
    EXPECT_EQ(read_file(folder() / "x" / file), read_file(folder() / "y" / file)) << file;
    EXPECT_EQ(read_file(folder() / "x" / file), read_file(mission() / file)) << file;
  }
}

TEST_F(Missions, ByteOrderMarkAndCarriageReturnsChangeNothing) {
  ASSERT_EQ(run({"run", "m", "-o", "out"}, folder()).status, 0);
  for (const auto& file : files_in(mission())) {
    edit(file, [](const std::string& text) {
      std::string windows = "\xEF\xBB\xBF";
      for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
      return windows;
    });
  }
  const auto outcome = run({"run", "m", "-o", "windows"}, folder());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* file : {"a.tum", "b.tum", "closures.csv", "graph.g2o"}) {
    EXPECT_EQ(read_file(folder() / "out" / file), read_file(folder() / "windows" / file)) << file;
  }
}

/// One kind of damage to a mission and the place that the error message must name.
struct Damage {
  std::string name;
  std::string file;
  std::function<std::string(std::string)> change;
  std::string place;
};

std::vector<Damage> damages() {
  const std::string odometry = "robots/a/odometry.tum";
  const std::string wifi = "robots/b/wifi.csv";
  return {
      {"torn line", odometry, [](const std::string& t) { return with_line(t, 5, "12.5 1.0"); },
       odometry + ":5:"},
      {"NaN", odometry, [](const std::string& t) { return with_line(t, 4, "1 nan 0 0 0 0 0 1"); },
       odometry + ":4:"},
      {"text", odometry, [](const std::string& t) { return with_line(t, 4, "1 x 0 0 0 0 0 1"); },
       odometry + ":4:"},
      {"backwards", odometry, [](const std::string& t) { return with_line(t, 9, "-1 0 0 0 0 0 0 1"); },
       odometry + ":9:"},
      {"far away", odometry, [](const std::string& t) { return with_line(t, 6, "1 1e9 0 0 0 0 0 1"); },
       odometry + ":6:"},
      {"empty", odometry, [](const std::string&) { return std::string(); }, odometry},
      {"column", wifi, [](const std::string& t) { return replaced(t, "rssi_dbm", "rssi"); }, wifi + ":1:"},
      {"short row", wifi, [](const std::string& t) { return with_line(t, 3, "1.0,aa:bb:cc:dd:ee:ff"); },
       wifi + ":3:"},
      {"unknown key", "mission.yaml",
       [](const std::string& t) { return replaced(t, "dimension:", "dimensoin:"); }, "mission.yaml"},
      {"dimension", "mission.yaml",
       [](const std::string& t) { return replaced(t, "dimension: 2", "dimension: 4"); }, "mission.yaml:3:"},
      {"no yaml", "mission.yaml", [](const std::string&) { return std::string("robots: {a: [\n"); },
       "mission.yaml:"},
      {"unknown robot", "radio/ranges.csv",
       [](const std::string&) { return std::string("t_s,robot_i,robot_j,range_m,sigma_m\n1,a,zoe,5,0.1\n"); },
       "radio/ranges.csv:2:"},
      {"robot without odometry", "mission.yaml",
       [](const std::string& t) { return replaced(t, "robots:\n", "robots:\n  c: {}\n"); },
       "mission.yaml:5:"},
  };
}

TEST_F(Missions, DamagedOnesAreRefusedWithFileAndLineAndLeaveNothing) {
  for (const auto& damage : damages()) {
    fs::remove_all(mission());
    SetUp();
    edit(damage.file, damage.change);
    const auto outcome = run({"run", "m", "-o", "out"}, folder());
    EXPECT_EQ(outcome.status, 2) << damage.name << ": " << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_NE(outcome.err.find("m/" + damage.place), std::string::npos) << damage.name << ": " << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const auto entries = std::distance(fs::directory_iterator(folder()), fs::directory_iterator());
    EXPECT_EQ(entries, 1) << damage.name << " left something";
  }
}

TEST_F(Missions, AFailedRunLeavesTheEarlierOneAlone) {
  ASSERT_EQ(run({"run", "m", "-o", "out"}, folder()).status, 0);
  const auto before = read_file(folder() / "out/a.tum");
  edit("robots/a/odometry.tum", [](const std::string& t) { return with_line(t, 5, "torn"); });
  EXPECT_EQ(run({"run", "m", "-o", "out"}, folder()).status, 2);
  EXPECT_EQ(read_file(folder() / "out/a.tum"), before);
}

TEST_F(Missions, AFolderThatIsNoRunIsNotReplaced) {
  EXPECT_EQ(run({"run", "m", "-o", "m"}, folder()).status, 2);
  EXPECT_TRUE(fs::exists(mission() / "mission.yaml"));
}

TEST_F(Missions, AnInterruptionLeavesNothing) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const auto outcome =
        run({"simulate", "carpark", "-o", "big", "--robots", "100", "--set", "path_length_m=20000"}, folder(),
            Interruption{signal, 0.3});
    EXPECT_EQ(outcome.status, 130);
    EXPECT_EQ(outcome.out, "");
    const auto entries = std::distance(fs::directory_iterator(folder()), fs::directory_iterator());
    EXPECT_EQ(entries, 1) << "something is left beside the mission";
  }
}

TEST_F(Missions, SimilarityListsEveryPairOnce) {
  const auto itself =
      run({"similarity", "m/robots/a/wifi.csv", "--measure", "cosine", "-o", "pairs.csv"}, folder());
  ASSERT_EQ(itself.status, 0) << itself.err;
  std::ifstream pairs(folder() / "pairs.csv");
  std::string line;
  std::getline(pairs, line);
  EXPECT_EQ(line, "t_i_s,t_j_s,similarity");
  std::size_t rows = 0;
  while (std::getline(pairs, line)) {
    const double first = std::stod(line);
    const double second = std::stod(line.substr(line.find(',') + 1));
    const double similarity = std::stod(line.substr(line.rfind(',') + 1));
    EXPECT_LT(first, second);
    EXPECT_GE(similarity, 0);
    EXPECT_LE(similarity, 1.000001);
    ++rows;
  }
  EXPECT_GT(rows, 100U);
}

/// The findings of `doctor --json`.
nlohmann::json findings_of(const fs::path& folder) {
  const auto outcome = run({"doctor", "m", "--json"}, folder);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  return nlohmann::json::parse(outcome.out).at("findings");
}

TEST_F(Missions, DoctorHasNoFindingsInASoundMission) {
  EXPECT_EQ(findings_of(folder()), nlohmann::json::array());
  EXPECT_EQ(run({"doctor", "m"}, folder()).out, "m: 0 errors, 0 warnings\n");
}

TEST_F(Missions, RunRefusesWhatDoctorCallsAnError) {
  edit("robots/a/odometry.tum", [](const std::string& text) {
    std::istringstream rows(text);
    std::string changed;
    double t, x, y, z, qx, qy, qz, qw;
    while (rows >> t >> x >> y >> z >> qx >> qy >> qz >> qw) {
      std::ostringstream row;
      row.precision(12);
      row << t << ' ' << 1000 * x << ' ' << 1000 * y << " 0 " << qx << ' ' << qy << ' ' << qz << ' ' << qw
          << '\n';
      changed += row.str();
    }
    return changed;
  });
  const auto findings = findings_of(folder());
  ASSERT_GE(findings.size(), 1U);
  EXPECT_EQ(findings[0].at("kind"), "unit");
  EXPECT_EQ(findings[0].at("severity"), "error");
  EXPECT_EQ(findings[0].at("robot"), "a");
  EXPECT_EQ(findings[0].at("file"), "robots/a/odometry.tum");
  const auto outcome = run({"run", "m", "-o", "out"}, folder());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
  EXPECT_NE(outcome.err.find("odometry.tum: the robot moves at"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder() / "out"));
}

TEST_F(Missions, RunNotesWhatDoctorWarnsOf) {
  edit("robots/a/wifi.csv", [](const std::string& text) {
    return std::regex_replace(text, std::regex(",([0-9]{4}),"), ",5.$1,");
  });
  const auto findings = findings_of(folder());
  ASSERT_EQ(findings.size(), 1U) << findings;
  EXPECT_EQ(findings[0].at("kind"), "unit");
  EXPECT_EQ(findings[0].at("severity"), "warning");
  const auto noted = run({"run", "m", "-o", "out"}, folder());
  EXPECT_EQ(noted.status, 0) << noted.err;
  EXPECT_NE(noted.out.find("note: robots/a/wifi.csv: the median of frequency_mhz"), std::string::npos)
      << noted.out;
  const auto unchecked = run({"run", "m", "-o", "out", "--unchecked"}, folder());
  EXPECT_EQ(unchecked.out.find("frequency_mhz"), std::string::npos);
}

TEST_F(Missions, DoctorReportsWhatReadersRefuse) {
  edit("mission.yaml", [](const std::string& text) { return text + "\n"; });
  fs::create_directories(mission() / "radio");
  write_file(mission() / "radio/ranges.csv", "t_s,robot_i,robot_j,range_m,sigma_m\n5,a,B,3,0.1\n");
  const auto findings = findings_of(folder());
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].at("kind"), "spelling");
  EXPECT_EQ(findings[0].at("robot"), "b");
  EXPECT_EQ(findings[0].at("file"), "radio/ranges.csv");
  EXPECT_NE(findings[0].at("advice").get<std::string>().find("did you mean b"), std::string::npos)
      << findings;
  EXPECT_EQ(run({"run", "m", "-o", "out"}, folder()).status, 2);
}

TEST_F(Missions, AnglesInDegreesAreAnError) {
  fs::create_directories(mission() / "radio");
  std::string rows = "t_s,receiver,transmitter,path,azimuth_rad,elevation_rad,sigma_rad,power_db\n";
  for (int k = 0; k < 40; ++k)
    rows += std::to_string(5 + k) + ",a,b,0," + std::to_string(9 * k - 180) + ",,0.1,0\n";
  write_file(mission() / "radio/aoa.csv", rows);
  const auto findings = findings_of(folder());
  ASSERT_GE(findings.size(), 1U);
  EXPECT_EQ(findings[0].at("kind"), "unit");
  EXPECT_EQ(findings[0].at("file"), "radio/aoa.csv");
}

TEST_F(Missions, DoctorRefusesAFolderThatIsNoMission) {
  const auto outcome = run({"doctor", "."}, folder());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("mission.yaml"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace radioslam::cli
