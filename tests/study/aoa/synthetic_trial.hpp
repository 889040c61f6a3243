// A synthetic trial in the layout of the WSR data set, simulated in the open.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "radioslam/geometry/so3.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/sim/sensors/csi_exchange.hpp"

namespace radioslam::sample {

struct StandingRadio {
  const char* name;
  std::uint64_t address;
  Eigen::Vector3d position_m;
};

inline constexpr double kTrialStart_s = 1'600'000'000;
inline const Eigen::Vector3d kAntennaFromBase_m(0, 0.16, 0);
inline const std::array<StandingRadio, 2> kStandingRadios{
    {{"tx2", 0x00216A3F175A, {5, 1, 0}}, {"tx4", 0x00216AB26EFA, {-2, 4, 0}}}};

/// The antenna on an arc of 0.9 m in six seconds, facing along it.
inline SE3 antenna_at(double t_s) {
  const double angle = 1.5 * t_s / 6, radius_m = 0.6;
  return SE3({radius_m * std::cos(angle), radius_m * std::sin(angle), 0},
             so3_exp({0, 0, angle + std::numbers::pi / 2}));
}

enum class PoseRow { kPlace, kPose };

/// Lines of sec, nsec, x, y, z[, qx, qy, qz, qw] with a trailing comma.
inline std::string trajectory_rows(const Eigen::Vector3d& point_in_body_m, PoseRow row) {
  std::string out;
  for (int k = 0; k <= 6 * 50; ++k) {
    const SE3 T_map_antenna = antenna_at(k / 50.0);
    const Eigen::Vector3d p = T_map_antenna * point_in_body_m;
    const std::int64_t ns = std::int64_t{20'000'000} * k;
    out += std::to_string(static_cast<std::int64_t>(kTrialStart_s) + ns / 1'000'000'000) + ".000000," +
           std::to_string(ns % 1'000'000'000) + ".000000";
    for (int axis = 0; axis < 3; ++axis) append_number(out += ',', p[axis]);
    if (row == PoseRow::kPose)
      for (const double q : T_map_antenna.rotation().coeffs()) append_number(out += ',', q);
    out += ",\n";
  }
  return out;
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
}

/// Positions of the radios in the data set's format.
inline std::string positions_json() {
  std::string out = R"({"channel": {"desc": "", "value": 108}, "true_tx_positions": {"value": {)";
  for (const StandingRadio& radio : kStandingRadios) {
    const auto& p = radio.position_m;
    out += std::string(&radio == kStandingRadios.data() ? "" : ", ") + "\"" + radio.name +
           "\": {\"position\": {\"x\": " + format_number(p.x()) + ", \"y\": " + format_number(p.y()) +
           ", \"z\": " + format_number(p.z()) + "}}";
  }
  return out + "}}}";
}

/// Captures of every exchange, and the trajectories by motion capture, camera and wheels.
inline void write_trial(const std::filesystem::path& folder, const std::string& time) {
  CsiCardParams cards;
  const CsiMedium air{room_paths({}, {}), CsiBand::intel5300(5.54e9), cards};
  constexpr double kEnd_s = 7;
  const Rng rng(7);
  const CsiRadio moving{MacAddress{0x00216A5389D2}, {{0, 0, 0}}, antenna_at, CsiCard(cards, kEnd_s, Rng(1))};
  std::vector<SentPacket> asked;
  for (int k = 0; k < 700; ++k) asked.push_back({0.2 + 0.008 * k, static_cast<std::uint32_t>(k)});
  const auto stamped = [](std::vector<ReceivedPacket> heard, const CsiMedium& in, const Rng& host) {
    CsiCapture capture = record_as_sent(std::move(heard), in, host);
    for (CsiPacket& packet : capture.packets) packet.stamp.ns += Stamp::from_seconds(kTrialStart_s).ns;
    return capture;
  };
  std::vector<ReceivedPacket> answers;
  for (const StandingRadio& radio : kStandingRadios) {
    const SE3 T_map_radio(radio.position_m, Eigen::Quaterniond::Identity());
    const CsiRadio standing{MacAddress{radio.address},
                            {{0, 0, 0}},
                            [=](double /*t_s*/) { return T_map_radio; },
                            CsiCard(cards, kEnd_s, Rng(radio.address))};
    ReceivedPackets heard = exchange_packets(moving, standing, asked, air, rng.split(radio.name));
    answers.insert(answers.end(), heard.by_asker.begin(), heard.by_asker.end());
    write_bytes(folder / ("csi_" + std::string(radio.name) + time + ".dat"),
                write_intel5300(stamped(std::move(heard.by_answerer), air, rng.split("host"))));
  }
  write_bytes(folder / ("csi_rx" + time + ".dat"),
              write_intel5300(stamped(std::move(answers), air, rng.split("moving host"))));
  write_bytes(folder / ("rx_trajectory" + time + "_.csv"),
              trajectory_rows(Eigen::Vector3d::Zero(), PoseRow::kPlace));
  write_bytes(folder / ("t265_rx_trajectory" + time + "_.csv"),
              trajectory_rows(Eigen::Vector3d::Zero(), PoseRow::kPose));
  write_bytes(folder / ("odom_rx_trajectory" + time + "_.csv"),
              trajectory_rows(-kAntennaFromBase_m, PoseRow::kPose));
  write_bytes(folder / "groundtruth_positions.json", positions_json());
}

/// The authors' results of one link, in degrees; the trial starts at the first motion capture position.
inline std::string results_json(const std::string& transmitter, const std::vector<double>& errors_deg,
                                const Eigen::Vector3d& start_m) {
  std::string peaks;
  for (std::size_t p = 0; p < errors_deg.size(); ++p)
    peaks += (p > 0 ? ", \"" : "\"") + std::to_string(p + 1) +
             "\": {\"azimuth_error\": " + format_number(errors_deg[p]) + "}";
  return R"({"a_INFO_Transmitting_robot": {"Name": ")" + transmitter +
         R"("}, "b_INFO_Receiving_robot": {"groundtruth_start_position": {"x": )" +
         format_number(start_m.x()) + R"(, "y": )" + format_number(start_m.y()) + R"(, "z": )" +
         format_number(start_m.z()) + R"(}}, "d_INFO_AOA_profile": {"Top_N_peaks": {)" + peaks + "}}}";
}

}  // namespace radioslam::sample
