// The map of a run: written by run and by map, read again by another program.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/process.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// A small hall of 12 x 10 m with known starts in its corner's frame, scanned by two robots for a short
/// while.
class Map : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    temporary_ = new TemporaryFolder;
    ASSERT_EQ(run({"simulate", "hall", "-o", "m", "--seed", "1", "--set", "lidar_beams=16",
                   "lidar_azimuth_steps=180", "lidar_rotation_hz=2", "hall_x_m=12", "hall_y_m=10",
                   "path_length_m=12", "links=20"},
                  folder())
                  .status,
              0);
    const auto outcome = run({"run", "m", "-o", "out", "--set", "map.pcd=true"}, folder());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  static void TearDownTestSuite() {
    delete temporary_;
    temporary_ = nullptr;
  }
  static const fs::path& folder() { return temporary_->path(); }

  /// What another program reads in the files of a map; nothing where the library to compare with is missing.
  static nlohmann::json read_by_python(const fs::path& from, const std::string& name,
                                       const std::string& library = "") {
    constexpr int kMissing = 77;
    const std::string debian = "/usr/bin/python3";
    const std::string command = (fs::exists(debian) ? debian : "python3") + " " + RADIOSLAM_SOURCE_DIR +
                                "/tests/cli/read_map.py " + from.string() + " " + name + " " + library;
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    const int status = WEXITSTATUS(pclose(pipe));
    if (!library.empty() && status == kMissing) return {};
    EXPECT_EQ(status, 0) << command;
    return nlohmann::json::parse(text.substr(std::min(text.find('{'), text.size())), nullptr, false);
  }

  /// Name of the files of the first robot's map.
  static std::string first_map() {
    const auto summary = nlohmann::json::parse(read_file(folder() / "out/summary.json"));
    return summary["team_frame"]["components"].size() == 1 ? "map" : "map-a";
  }

 private:
  static inline TemporaryFolder* temporary_ = nullptr;
};

TEST_F(Map, IsReadByAnotherProgramWithTheSizeOfTheHall) {
  const auto map = read_by_python(folder() / "out", first_map());
  EXPECT_EQ(map["robots"]["0"], "a");
  EXPECT_GT(map["points"], 5000);
  EXPECT_EQ(map["names"][3], "nx");
  // The diagonal of a hall of 12 x 10 m, whatever its heading in the frame of the first robot.
  const auto& e = map["extent"];
  const double x = e[1].get<double>() - e[0].get<double>(), y = e[3].get<double>() - e[2].get<double>();
  EXPECT_GT(std::min(x, y), 9.5);
  EXPECT_LT(std::hypot(x, y), std::hypot(12, 10) * 1.45);
  // From the floor up to the highest beam at the end of its 10 m: 0.6 m + 10 m sin(15 deg).
  EXPECT_NEAR(e[5].get<double>() - e[4].get<double>(), 3.19, 0.1);
  for (int axis = 0; axis < 4; ++axis)  // the walls of the grid are those of the points
    EXPECT_NEAR(map["occupied"][static_cast<std::size_t>(axis)].get<double>(),
                e[static_cast<std::size_t>(axis)].get<double>(), 0.3);
  EXPECT_GT(map["cells"]["free"], 5000);
}

TEST_F(Map, IsReadTheSameByOpen3dPclAndPillowWhereTheyAreInstalled) {
  std::string missing;
  for (const std::string library : {"open3d", "pcl", "pillow"})
    if (read_by_python(folder() / "out", first_map(), library).is_null()) missing += " " + library;
  if (!missing.empty()) GTEST_SKIP() << "not installed:" << missing;
}

TEST_F(Map, TheWallsOfTheHallAreWhereTheyStand) {
  // True poses in the frame of the hall, whose walls are x = 0 and 12, y = 0 and 10; the quarter with the
  // walls x = 12 and y = 0.
  for (const std::string robot : {"a", "b"})
    for (const char* path : {"true", "true/dense"}) {
      fs::create_directories(folder() / path);
      fs::copy(folder() / "m/robots" / robot / "groundtruth.tum", folder() / path / (robot + ".tum"));
    }
  const auto outcome = run({"map", "true", "m", "--pcd", "--crop", "6,13,-1,4"}, folder());
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto map = read_by_python(folder() / "true", "map");
  const auto near_wall = [&](const std::string& state, double x0, double x1, double y0, double y1) {
    return static_cast<int>(
        std::count_if(map["centres"][state].begin(), map["centres"][state].end(),
                      [&](const auto& at) { return x0 < at[0] && at[0] < x1 && y0 < at[1] && at[1] < y1; }));
  };
  EXPECT_GT(near_wall("occupied", 6, 12, -0.11, 0.11), 50);  // of 60 cells of 0.1 m
  EXPECT_GT(near_wall("occupied", 11.89, 12.11, 0, 4), 33);  // of 40
  EXPECT_EQ(near_wall("occupied", 6, 13, -1, -0.15), 0);     // behind them
  EXPECT_EQ(near_wall("occupied", 12.15, 13, -1, 4), 0);
  EXPECT_GT(near_wall("free", 6.5, 11.5, 0.5, 3.5), 1200);  // of 1500
}

TEST_F(Map, IsTheSameFromTheRunsFolderAndFollowsItsOptions) {
  ASSERT_EQ(run({"map", "out", "m", "-o", "again", "--pcd"}, folder()).status, 0);
  for (const auto& entry : fs::directory_iterator(folder() / "again"))
    EXPECT_EQ(read_file(entry.path()), read_file(folder() / "out" / entry.path().filename())) << entry.path();
  const auto coarse =
      run({"map", "out", "m", "-o", "coarse", "--voxel", "0.5", "--crop", "-2,2,-2,2", "--json"}, folder());
  ASSERT_EQ(coarse.status, 0) << coarse.err;
  const auto json = nlohmann::json::parse(coarse.out);
  EXPECT_EQ(json["maps"][0]["voxel_m"], 0.5);
  EXPECT_LT(json["maps"][0]["points"], 2000);
}

TEST_F(Map, EachHypothesisOfATeamInWhichNothingIsSureHasItsOwn) {
  // Ranges alone, between two straight paths without a common view: mirror images are as likely.
  ASSERT_EQ(
      run({"simulate", "hall", "-o", "mirrored", "--seed", "1", "--set", "matches_true=0", "matches_false=0",
           "angle_ends=none", "links=12", "lidar_beams=1", "lidar_azimuth_steps=180", "lidar_rotation_hz=2",
           "hall_x_m=100", "hall_y_m=90", "pillar_spacing_m=20", "path_length_m=12", "lidar_range_m=12"},
          folder())
          .status,
      0);
  ASSERT_EQ(run({"run", "mirrored", "-o", "unsure"}, folder()).status, 0);
  ASSERT_EQ(run({"map", "unsure", "mirrored", "-o", "unsure-again"}, folder()).status, 0);
  const auto summary = nlohmann::json::parse(read_file(folder() / "unsure/summary.json"));
  const std::size_t hypotheses = summary["team_frame"]["hypotheses"].size();
  ASSERT_GT(hypotheses, 1);
  std::set<std::string> maps;
  for (std::size_t k = 0; k < hypotheses; ++k) {
    const fs::path part = k == 0 ? fs::path() : fs::path("hypotheses") / std::to_string(k);
    for (const char* file : {"map.ply", "map.pgm", "map.yaml"})
      EXPECT_EQ(read_file(folder() / "unsure" / part / file),
                read_file(folder() / "unsure-again" / part / file));
    maps.insert(read_file(folder() / "unsure" / part / "map.ply"));
  }
  EXPECT_EQ(maps.size(), hypotheses);
}

TEST_F(Map, RefusesWhatItCannotMapInOneLine) {
  const auto refuse = [&](const std::vector<std::string>& call, const std::string& reason) {
    const auto outcome = run(call, folder());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  };
  refuse({"map", "none", "m"}, "none: no such run folder");
  refuse({"map", "out", "m", "--crop", "1,2,3"}, "has 3 numbers, not 4 or 6");
  refuse({"map", "out", "m", "--crop", "2,1,0,1"}, "contains nothing");
  refuse({"map", "out", "m", "--voxel", "0"}, "is not a number from");
  fs::create_directories(folder() / "bare");
  fs::copy(folder() / "out/a.tum", folder() / "bare/a.tum");
  refuse({"map", "bare", "m"}, "has no continuous trajectory");
}

}  // namespace
}  // namespace radioslam::cli
