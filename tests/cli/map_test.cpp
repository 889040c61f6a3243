// The map of a run: written by run and by map, read again by another program.
#include <gtest/gtest.h>

#include <cstdio>
#include <nlohmann/json.hpp>

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

  /// What another program reads in the files of a map.
  static nlohmann::json read_by_python(const fs::path& from, const std::string& name) {
    const std::string command = std::string("python3 ") + RADIOSLAM_SOURCE_DIR + "/tests/cli/read_map.py " +
                                from.string() + " " + name;
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
    EXPECT_EQ(pclose(pipe), 0) << command;
    return nlohmann::json::parse(text, nullptr, false);
  }

 private:
  static inline TemporaryFolder* temporary_ = nullptr;
};

TEST_F(Map, IsReadByAnotherProgramWithTheSizeOfTheHall) {
  const auto summary = nlohmann::json::parse(read_file(folder() / "out/summary.json"));
  const bool is_one = summary["team_frame"]["components"].size() == 1;
  const auto map = read_by_python(folder() / "out", is_one ? "map" : "map-a");
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
