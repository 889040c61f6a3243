#include "radioslam/io/datasets/wsr_results.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"

namespace radioslam {
namespace {

constexpr const char* kName = "NLOS_Set_A_using_t265_displacement.json";
constexpr const char* kResults = R"({"7": [{
  "a_INFO_Transmitting_robot": {"Name": "tx3"},
  "b_INFO_Receiving_robot": {"groundtruth_start_position": {"x": 1, "y": -2, "z": 0.5}},
  "d_INFO_AOA_profile": {"Top_N_peaks": {"1": {"azimuth_error": -90}, "2": {"azimuth_error": 18}}}}]})";

TEST(WsrResults, AreReadAsTheyAre) {
  const TemporaryFolder folder;
  folder.write(kName, kResults);
  folder.write("summary.json", "not looked at");
  const auto results = read_wsr_results(folder.path());
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].sight, WsrSight::kNoLineOfSight);
  EXPECT_EQ(results[0].motion, WsrMotion::kTrackingCamera);
  EXPECT_EQ(results[0].transmitter, "tx3");
  EXPECT_EQ(results[0].start_m, Eigen::Vector3d(1, -2, 0.5));
  ASSERT_EQ(results[0].errors_rad.size(), 2U);
  EXPECT_NEAR(results[0].errors_rad[0], -std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(results[0].errors_rad[1], std::numbers::pi / 10, 1e-12);
}

TEST(WsrResults, AreThoseOfTheDefaultConfiguration) {
  const TemporaryFolder folder;
  folder.write(std::string("default_configuration/LOS_Set_B_using_groundtruth_displacement.json"), kResults);
  folder.write(std::string("low_res_configuration/") + kName, kResults);
  const auto results = read_wsr_results(folder.path());
  ASSERT_EQ(results.size(), 1U);
  EXPECT_EQ(results[0].motion, WsrMotion::kMotionCapture);
  EXPECT_EQ(results[0].sight, WsrSight::kLineOfSight);
}

TEST(WsrResults, RefuseMalformedFiles) {
  const TemporaryFolder folder;
  expect_refusal([&] { read_wsr_results(folder.path()); }, 0, "contains no file");
  expect_refusal([&] { read_wsr_results(folder.path() / "nowhere"); }, 0, "no such results folder");
  const auto refuses = [&](const char* content, const char* words) {
    folder.write(kName, content);
    expect_refusal([&] { read_wsr_results(folder.path()); }, 1, words);
  };
  refuses("[]", "by number");
  refuses(R"({"1": 2})", "trial '1'");
  refuses(R"({"1": [{}]})", "Name");
  refuses(R"({"1": [3]})", "Name");
  refuses(R"({"1": [{"a_INFO_Transmitting_robot": {"Name": "tx3"},
      "b_INFO_Receiving_robot": {"groundtruth_start_position": {"x": 1, "y": 2, "z": 3}},
      "d_INFO_AOA_profile": {"Top_N_peaks": {}}}]})",
          "azimuth_error");
}

TEST(WsrResults, RecordedOnesHaveThePublishedNumberOfLinks) {
  RADIOSLAM_RECORDED(folder, "wsr/2D-Displacement_output_files");
  std::size_t links = 0;
  for (const auto& result : read_wsr_results(folder))
    if (result.motion == WsrMotion::kMotionCapture) ++links;
  EXPECT_EQ(links, 637U);
}

}  // namespace
}  // namespace radioslam
