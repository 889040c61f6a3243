// This project's own messages: what is written is read, and both are as ros/radioslam_msgs states them.
#include "radioslam/io/ros/radioslam_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "io/temporary_folder.hpp"
#include "radioslam/base/input_error.hpp"
#include "radioslam/io/ros/ros_definition.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

const fs::path kPackage = fs::path(RADIOSLAM_SOURCE_DIR) / "ros/radioslam_msgs";
constexpr const char* kHeaderDefinition =
    "=====\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";

std::string content(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The definition of a type as recordings have it.
RosDefinition definition(const std::string& type, const std::vector<std::string>& contained = {}) {
  std::string text = content(kPackage / "msg" / (type + ".msg")) + kHeaderDefinition;
  for (const std::string& of : contained)
    text += "=====\nMSG: radioslam_msgs/" + of + '\n' + content(kPackage / "msg" / (of + ".msg"));
  return RosDefinition::parse("radioslam_msgs/" + type, text).value();
}

/// The message's values by name as its definition reads them.
std::map<std::string, RosValue> values(const RosDefinition& definition, const std::string& cdr) {
  const RosChannel channel{"/a", "", MessageEncoding::kCdr};
  std::map<std::string, RosValue> all;
  definition.read({channel, Stamp{}, cdr, "bytes"},
                  [&](const RosValue& value) { all[value.scope + value.name] = value; });
  return all;
}

template <class Read>
auto read(const Read& read_message, const std::string& cdr) {
  const RosChannel channel{"/a", "", MessageEncoding::kCdr};
  return read_message(RosMessage{channel, Stamp{}, cdr, "bytes"});
}

const RosHeader kHeader{{12'000'000'034}, "uwb"};

TEST(RadioslamMessages, RangesAreAsDefined) {
  const RosRangeMeasurement range{kHeader, "front", "b", "rear", 12.5, 0.1};
  const std::string cdr = encode_cdr(range);
  const RosRangeMeasurement again = read(read_range_measurement, cdr);
  EXPECT_EQ(again.header.stamp, kHeader.stamp);
  EXPECT_EQ(again.header.frame, "uwb");
  EXPECT_EQ(again.antenna + again.other + again.other_antenna, "frontbrear");
  EXPECT_EQ(again.range_m, 12.5);
  EXPECT_EQ(again.sigma_m, 0.1);
  auto all = values(definition("RangeMeasurement"), cdr);
  EXPECT_EQ(all.size(), 7U);
  EXPECT_EQ(all["header.stamp"].stamp, kHeader.stamp);
  EXPECT_EQ(all["other"].text, "b");
  EXPECT_EQ(all["range"].number, 12.5);
  EXPECT_EQ(all["sigma"].number, 0.1);
}

TEST(RadioslamMessages, AnglesAreAsDefined) {
  const RosAngleMeasurement angles{kHeader, "b", "", {{0.5, std::nullopt, 0.1, -3}, {1, 0.25, 0.2, -9}}};
  const std::string cdr = encode_cdr(angles);
  const RosAngleMeasurement again = read(read_angle_measurement, cdr);
  ASSERT_EQ(again.paths.size(), 2U);
  EXPECT_FALSE(again.paths[0].elevation_rad);
  EXPECT_EQ(again.paths[1].elevation_rad, 0.25);
  EXPECT_EQ(again.paths[1].power_db, -9);
  auto all = values(definition("AngleMeasurement", {"AnglePath"}), cdr);
  EXPECT_EQ(all["transmitter"].text, "b");
  EXPECT_TRUE(std::isnan(all["paths[0].elevation"].number));
  EXPECT_EQ(all["paths[1].azimuth"].number, 1);
  EXPECT_EQ(all["paths[1].sigma"].number, 0.2);
  EXPECT_EQ(all["paths[1].power"].number, -9);
}

TEST(RadioslamMessages, WifiScansAreAsDefined) {
  const RosWifiScan scan{kHeader, {{"00:16:ea:12:34:56", 2412, -60}, {"00:16:ea:12:34:57", 5180, -70.5F}}};
  const std::string cdr = encode_cdr(scan);
  const RosWifiScan again = read(read_wifi_scan, cdr);
  ASSERT_EQ(again.readings.size(), 2U);
  EXPECT_EQ(again.readings[1].bssid, "00:16:ea:12:34:57");
  EXPECT_EQ(again.readings[1].rssi_dbm, -70.5F);
  auto all = values(definition("WifiScan", {"WifiReading"}), cdr);
  EXPECT_EQ(all["readings[0].bssid"].text, "00:16:ea:12:34:56");
  EXPECT_EQ(all["readings[1].frequency"].number, 5180);
  EXPECT_EQ(all["readings[1].rssi"].number, -70.5);
}

RosCsiPacket packet() {
  RosCsiPacket csi{kHeader, {}, 5.18e9, 20e6, {-1e6, 0, 1e6}};
  csi.packet.clock_us = 77;
  csi.packet.sender = MacAddress{0x0016ea123456};
  csi.packet.counter = 9;
  csi.packet.rssi = {30, 31, 0};
  csi.packet.noise_dbm = -92;
  csi.packet.antennas = 2;
  csi.packet.streams = 1;
  csi.packet.channel.resize(2, 3);
  for (int k = 0; k < 6; ++k)
    csi.packet.channel(k / 3, k % 3) = {static_cast<float>(k), -static_cast<float>(k)};
  return csi;
}

TEST(RadioslamMessages, CsiPacketsAreAsDefined) {
  const std::string cdr = encode_cdr(packet());
  const RosCsiPacket again = read(read_csi_packet, cdr);
  EXPECT_EQ(again.packet.sender, packet().packet.sender);
  EXPECT_FALSE(again.packet.receiver);
  EXPECT_EQ(again.packet.counter, 9U);
  EXPECT_EQ(again.packet.rssi, packet().packet.rssi);
  EXPECT_EQ(again.packet.channel, packet().packet.channel);
  EXPECT_EQ(again.subcarrier_hz, packet().subcarrier_hz);
  auto all = values(definition("CsiPacket"), cdr);
  EXPECT_EQ(all["clock_us"].number, 77);
  EXPECT_EQ(all["has_counter"].number, 1);
  EXPECT_EQ(all["rssi[1]"].number + all["noise_dbm"].number, 31 - 92);
  EXPECT_EQ(all["antennas"].number, 2);
  EXPECT_EQ(all["channel[8]"].number, 4);  // antenna 1, subcarrier 1
  EXPECT_EQ(all["channel[9]"].number, -4);
}

TEST(RadioslamMessages, AChannelOfAnotherSizeIsRefused) {
  RosCsiPacket csi = packet();
  csi.packet.antennas = 3;
  EXPECT_THROW(read(read_csi_packet, encode_cdr(csi)), InputError);
}

TEST(RadioslamMessages, EveryPieceOfOneIsRefused) {
  const std::string cdr = encode_cdr(packet());
  for (std::size_t bytes = 0; bytes < cdr.size(); ++bytes)
    EXPECT_THROW(read(read_csi_packet, cdr.substr(0, bytes)), InputError) << bytes;
}

/// "type name" of the members of a struct in IDL, with types as a .msg has them.
std::vector<std::string> members(const std::string& idl) {
  static const std::map<std::string, std::string> kTypes{
      {"double", "float64"},
      {"float", "float32"},
      {"boolean", "bool"},
      {"std_msgs::msg::Header", "std_msgs/Header"},
      {"sequence<double>", "float64[]"},
      {"sequence<float>", "float32[]"},
      {"sequence<uint8>", "uint8[]"},
      {"int32__3", "int32[3]"},
      {"sequence<radioslam_msgs::msg::AnglePath>", "AnglePath[]"},
      {"sequence<radioslam_msgs::msg::WifiReading>", "WifiReading[]"}};
  std::vector<std::string> found;
  std::istringstream lines(idl);
  bool is_inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("struct ") != std::string::npos) is_inside = true;
    std::istringstream words(line);
    std::string type, name, rest;
    if (!is_inside || !(words >> type >> name) || words >> rest || !name.ends_with(';')) continue;
    const auto known = kTypes.find(type);
    found.push_back((known == kTypes.end() ? type : known->second) + ' ' + name.substr(0, name.size() - 1));
  }
  return found;
}

std::vector<std::string> fields(const std::string& text) {
  std::vector<std::string> found;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::string type, name;
    if (words >> type >> name) found.push_back(type + ' ' + name);
  }
  return found;
}

/// rosidl_adapter, which every build of a ROS 2 workspace runs, takes the package's messages as they are
/// meant.
TEST(RadioslamMessages, AreTakenByRosidlAdapter) {
  const std::string python = "/usr/bin/python3 -c 'import rosidl_adapter.msg' 2>/dev/null";
  if (std::system(python.c_str()) != 0)
    GTEST_SKIP() << "rosidl_adapter is not here; Debian's packages python3-rosidl and python3-empy have it";
  const TemporaryFolder folder;
  std::size_t types = 0;
  for (const auto& entry : fs::directory_iterator(kPackage / "msg")) {
    const std::string name = entry.path().stem().string();
    const std::string convert =
        "/usr/bin/python3 -c 'import pathlib; from rosidl_adapter.msg import convert_msg_to_idl; "
        "convert_msg_to_idl(pathlib.Path(\"" +
        kPackage.string() + "\"), \"radioslam_msgs\", pathlib.Path(\"msg/" + name +
        ".msg\"), pathlib.Path(\"" + folder.path().string() + "\"))' >/dev/null";
    ASSERT_EQ(std::system(convert.c_str()), 0) << name;
    EXPECT_EQ(members(content(folder.path() / (name + ".idl"))), fields(content(entry.path()))) << name;
    ++types;
  }
  EXPECT_EQ(types, 7U);
}

/// CMakeLists.txt lists every message, and no other.
TEST(RadioslamMessages, AreAllInThePackage) {
  const std::string cmake = content(kPackage / "CMakeLists.txt");
  for (const auto& entry : fs::directory_iterator(kPackage / "msg"))
    EXPECT_NE(cmake.find("msg/" + entry.path().filename().string()), std::string::npos) << entry.path();
}

}  // namespace
}  // namespace radioslam
