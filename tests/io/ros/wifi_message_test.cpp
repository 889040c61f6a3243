#include "radioslam/io/ros/wifi_message.hpp"

#include <gtest/gtest.h>

#include "io/refusal.hpp"
#include "ros_bytes.hpp"

namespace radioslam {
namespace {

constexpr Stamp kRecorded{9'000'000'000};

/// The rows of a message, and that of its topic if it has none.
WifiMessage read(const RosTopic& topic, const std::string& bytes, MessageEncoding encoding) {
  const auto definition = wifi_definition_of(topic);
  if (!definition) return {};
  const RosChannel channel{topic.name, topic.type, encoding, topic.definition};
  return read_wifi_message(*definition, {channel, kRecorded, bytes, "x.bag"});
}

std::string table_of(const WifiMessage& message) {
  const std::string table = format_wifi_rows(message.rows);
  return table.substr(table.find('\n') + 1);
}

RosTopic topic_of(const std::string& type, const std::string& definition, const std::string& name = "/scan") {
  RosTopic topic{name, type, 1};
  topic.definition = definition;
  return topic;
}

const std::string kHeader = "===\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n";

TEST(WifiMessage, ReadsAConnectionAlsoWithoutItsDefinition) {
  RosBytes bytes(MessageEncoding::kCdr);
  bytes.f32(54).u16(20).text("50/70").f32(0.7F).u16(0x10000 - 60).u16(0x10000 - 95);
  bytes.text("net").text("02:AA:00:00:01:00").f64(5.18);
  const auto read_it = read(topic_of("wireless_msgs/Connection", ""), bytes.bytes(), MessageEncoding::kCdr);
  EXPECT_EQ(table_of(read_it), "9,02:aa:00:00:01:00,5180,-60\n");
}

TEST(WifiMessage, ReadsListsOfAccessPointsWithAddressesOfBytes) {
  const RosTopic topic = topic_of(
      "rf_msgs/AccessPoints", "Header header\nStation[] aps\n" + kHeader +
                                  "===\nMSG: rf_msgs/Station\nHeader header\nuint8[6] mac\nint32 channel\n"
                                  "int32 rssi\n");
  RosBytes bytes(MessageEncoding::kRos1);
  bytes.header(7, 500'000'000, "").u32(2);
  for (const unsigned k : {1U, 2U}) {
    bytes.header(0, 0, "");
    for (const unsigned byte : {2U, 0xaaU, 0U, 0U, k, 0U}) bytes.u8(byte);
    bytes.u32(k == 1 ? 11 : 36).u32(k == 1 ? 0x100000000 - 55 : 12);
  }
  const auto message = read(topic, bytes.bytes(), MessageEncoding::kRos1);
  EXPECT_EQ(table_of(message), "7.5,02:aa:00:00:01:00,2462,-55\n");
  EXPECT_EQ(message.invalid, 1U) << "12 is no level in dBm";
}

TEST(WifiMessage, ReadsListsOfAddressesBesideLevels) {
  const RosTopic topic =
      topic_of("wifi_localization/WifiState",
               "Header header\nstring[] macs\nfloat64[] strengths\nstring[] ssids\n" + kHeader);
  RosBytes bytes(MessageEncoding::kRos1);
  bytes.header(3, 0, "").u32(2).text("02:aa:00:00:01:00").text("02:aa:00:00:02:00");
  bytes.u32(2).f64(-40).f64(-70).u32(2).text("a").text("b");
  EXPECT_EQ(table_of(read(topic, bytes.bytes(), MessageEncoding::kRos1)),
            "3,02:aa:00:00:01:00,0,-40\n3,02:aa:00:00:02:00,0,-70\n");
}

TEST(WifiMessage, OtherRadiosAreNotWifi) {
  const std::string beacon = "string address\nint32 rssi\n";
  EXPECT_FALSE(wifi_definition_of(topic_of("ble_msgs/Beacon", beacon)));
  EXPECT_FALSE(wifi_definition_of(topic_of("wireless_msgs/Scan", "string essid\nstring mac\n")));
  EXPECT_TRUE(wifi_definition_of(topic_of("wifi_scan/AddressRSSI", beacon)));
  EXPECT_TRUE(wifi_definition_of(topic_of("my_msgs/Reading", beacon, "/wlan0/readings")));
  const RosTopic topic = topic_of("wifi_scan/AddressRSSI", beacon);
  expect_refusal([&] { read(topic, "\x05", MessageEncoding::kRos1); }, 0, "");
}

}  // namespace
}  // namespace radioslam
