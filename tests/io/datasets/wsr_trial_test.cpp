#include "radioslam/io/datasets/wsr_trial.hpp"

#include <gtest/gtest.h>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

std::string one_packet(std::uint32_t counter) {
  CsiCapture capture;
  capture.subcarrier_hz = grouped_subcarriers_hz(ChannelWidth::k20MHz);
  capture.bandwidth_hz = 20e6;
  CsiPacket& packet = capture.packets.emplace_back();
  packet.stamp = {1'600'000'000'000'000'000};
  packet.sender = MacAddress{0x00216A3F175A};
  packet.counter = counter;
  packet.antennas = packet.streams = 1;
  packet.channel = Eigen::MatrixXcf::Ones(1, 30);
  return write_intel5300(capture);
}

constexpr const char* kPositions =
    R"({"channel": {"value": 108}, "true_tx_positions": {"value": {
        "tx2": {"position": {"x": 1, "y": 2.5, "z": -3}}, "tx3": {"position": {"x": 1, "y": 2}}}}})";

/// A folder with one trial.
class WsrTrialFolder : public testing::Test {
 protected:
  void SetUp() override {
    write("csi_rx_a.dat", one_packet(1));
    write("csi_tx2_a.dat", one_packet(2));
    write("rx_trajectory_a_.csv", "10.5,0.000000,1,2,3,\n11.25,0.0,2,3,4,\n");
    write("groundtruth_positions.json", kPositions);
  }
  void write(const std::string& name, std::string_view content) const { folder.write(trial / name, content); }
  std::vector<WsrTrialFiles> find() const { return find_wsr_trials(folder.path()); }
  WsrTrial read() const { return read_wsr_trial(find().at(0)); }

  const fs::path trial = fs::path("LOS_Set_A") / "place";
  TemporaryFolder folder;
};

TEST_F(WsrTrialFolder, IsReadAsItIs) {
  write("odom_rx_trajectory_a_.csv", "10,250000000.0,1,2,0,0,0,0.6,0.8,0,0,0,0,0,0,\n");
  const WsrTrial read_back = read();
  EXPECT_EQ(read_back.name, "place_a");
  EXPECT_EQ(read_back.sight, WsrSight::kLineOfSight);
  EXPECT_EQ(read_back.carrier_hz, 5.54e9);
  EXPECT_EQ(read_back.receiver.packets.at(0).counter, 1U);
  ASSERT_EQ(read_back.transmitters.size(), 1U);
  EXPECT_EQ(read_back.transmitters[0].name, "tx2");
  EXPECT_EQ(read_back.transmitters[0].address, MacAddress{0x00216A3F175A});
  EXPECT_EQ(read_back.transmitters[0].position_m, Eigen::Vector3d(1, 2.5, -3));
  EXPECT_EQ(read_back.transmitters[0].heard.packets.at(0).counter, 2U);
  ASSERT_EQ(read_back.motion_capture.size(), 2U);
  EXPECT_EQ(read_back.motion_capture[0].stamp.ns, 10'500'000'000);
  EXPECT_EQ(read_back.motion_capture[1].pose.translation(), Eigen::Vector3d(2, 3, 4));
  EXPECT_FALSE(read_back.tracking_camera);
  ASSERT_TRUE(read_back.wheel_odometry);
  EXPECT_EQ(read_back.wheel_odometry->front().stamp.ns, 10'250'000'000);
  EXPECT_NEAR(read_back.wheel_odometry->front().pose.yaw(), 2 * std::atan2(0.6, 0.8), 1e-12);
}

TEST_F(WsrTrialFolder, TrialsOfOneFolderAreDistinguishedByTime) {
  write("csi_rx_b.dat", one_packet(3));
  write("csi_tx2_b.dat", one_packet(4));
  write("rx_trajectory_b_.csv", "20,0,1,2,3\n");
  const auto trials = find();
  ASSERT_EQ(trials.size(), 2U);
  EXPECT_EQ(trials[1].name, "place_b");
  EXPECT_EQ(read_wsr_trial(trials[1]).motion_capture.front().stamp.ns, 20'000'000'000);
}

TEST_F(WsrTrialFolder, AFolderAfterItsSetDecidesWhatWasInSight) {
  fs::rename(folder.path() / "LOS_Set_A", folder.path() / "NLOS_Set_A");
  EXPECT_EQ(find().at(0).sight, WsrSight::kNoLineOfSight);
  fs::rename(folder.path() / "NLOS_Set_A", folder.path() / "Set_A");
  expect_refusal([&] { find(); }, 0, "starts with LOS or NLOS");
}

TEST_F(WsrTrialFolder, RefusesWhatIsNotComplete) {
  write("rx_trajectory_c.csv", "1,0,1,2,3\n");
  expect_refusal([&] { find(); }, 0, "a second file of the same kind");
  fs::remove(folder.path() / trial / "rx_trajectory_c.csv");
  fs::remove(folder.path() / trial / "csi_tx2_a.dat");
  expect_refusal([&] { find(); }, 0, "no matching csi_tx2, csi_tx3 or csi_tx4");
  fs::remove(folder.path() / trial / "rx_trajectory_a_.csv");
  expect_refusal([&] { find(); }, 0, "no matching rx_trajectory*.csv");
  fs::remove(folder.path() / trial / "csi_rx_a.dat");
  expect_refusal([&] { find(); }, 0, "contains no folder with both");
  expect_refusal([&] { find_wsr_trials(folder.path() / "nowhere"); }, 0, "no such folder");
}

TEST_F(WsrTrialFolder, RefusesMalformedRowsByLine) {
  const auto refuses = [&](const std::string& rows, std::size_t line, const std::string& words) {
    write("rx_trajectory_a_.csv", rows);
    expect_refusal([&] { read(); }, line, words);
  };
  refuses("1,0,1,2\n", 1, "4 fields");
  refuses("1,0,1,2,3,\n1,0,1,2,3,\n", 2, "the time does not increase");
  refuses("1,0,1,x,3,\n", 1, "y");
  refuses("1,2e9,1,2,3,\n", 1, "nsec");
  refuses("1,0,1,2,3,0,0,0,0.5\n", 1, "quaternion");
  refuses("# nothing\n", 1, "no poses");
}

TEST_F(WsrTrialFolder, LeavesOutAFewRowsOutOfOrder) {
  std::string rows = "9,0,1,2,3,\n";
  for (int k = 0; k < 20; ++k) rows += "1," + std::to_string(k) + "e6," + std::to_string(k) + ",2,3,\n";
  write("rx_trajectory_a_.csv", rows);
  const WsrTrial trial_read = read();
  EXPECT_EQ(trial_read.motion_capture.size(), 20U);
  EXPECT_EQ(trial_read.motion_capture.front().pose.translation().x(), 0);
  ASSERT_EQ(trial_read.warnings.size(), 1U);
  EXPECT_NE(trial_read.warnings[0].find("1 row is left out; the first:"), std::string::npos);
  EXPECT_NE(trial_read.warnings[0].find("rx_trajectory_a_.csv:1: the time does not increase"),
            std::string::npos);
}

TEST_F(WsrTrialFolder, RefusesIncompletePositions) {
  write("csi_tx3_a.dat", one_packet(5));
  expect_refusal([&] { read(); }, 1, "no valid position of 'tx3'");
  write("groundtruth_positions.json", R"({"channel": {"value": 15}})");
  expect_refusal([&] { read(); }, 1, "channel");
  write("groundtruth_positions.json", R"([1])");
  expect_refusal([&] { read(); }, 1, "channel");
  write("groundtruth_positions.json", "{");
  refusal([&] { read(); });
}

TEST(WsrTrial, RecordedOnesAreRead) {
  RADIOSLAM_RECORDED(dataset, "wsr/raw");
  const auto trials = find_wsr_trials(dataset);
  ASSERT_FALSE(trials.empty());
  const WsrTrial trial = read_wsr_trial(trials.front());
  EXPECT_EQ(trial.transmitters.size(), 3U);
  EXPECT_GT(trial.receiver.packets.size(), 4000U);
  EXPECT_GT(trial.motion_capture.size(), 500U);
}

}  // namespace
}  // namespace radioslam
