// Messages between robots as JSON: what comes back of them, and what is refused.
#include "radioslam/io/rendezvous/robot_message_json.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;

constexpr double kRelative = 1e-8;  ///< of nine digits, with a margin for what is computed from them

RobotStatus example_status() {
  RobotStatus status;
  status.number = 12;
  status.error = 2.0 / 3;
  status.frame = "a";
  status.pose = SE2({3, -4}, 1.5);
  status.sigma_m = 0.25;
  status.call = 3;
  status.call_error = 0.75;
  status.partner = "b";
  status.standing = true;
  status.leans_on = "c";
  status.walked_m = 1.5;
  status.knows = {{"b", {7, 4, 1.0 / 3}}, {"c", {0, std::uint64_t{1} << 60U, 1.7e9 + 0.1}}};
  return status;
}

Json example_json() {
  return Json::parse(message_json({example_status(), std::string("\0\xff any bytes", 12)}).dump());
}

void expect_near(const SE2& read, const SE2& written) {
  EXPECT_LT((read.translation() - written.translation()).norm(), kRelative * 20);
  EXPECT_NEAR(read.angle(), written.angle(), kRelative);
}

TEST(RobotMessageJson, AStatusComesBack) {
  const RobotStatus status = *read_message(example_json()).status, written = example_status();
  EXPECT_EQ(status.number, written.number);
  EXPECT_NEAR(status.error, written.error, kRelative);
  EXPECT_EQ(status.frame, written.frame);
  expect_near(status.pose, written.pose);
  EXPECT_EQ(status.sigma_m, written.sigma_m);
  EXPECT_EQ(status.call, written.call);
  EXPECT_EQ(status.call_error, written.call_error);
  EXPECT_EQ(status.partner, written.partner);
  EXPECT_EQ(status.offer_to, "");
  EXPECT_EQ(status.serving, "");
  EXPECT_TRUE(status.standing);
  EXPECT_EQ(status.leans_on, "c");
  EXPECT_EQ(status.walked_m, 1.5);
  EXPECT_EQ(status.knows, written.knows);
}

TEST(RobotMessageJson, AnyBytesOfRecordsComeBack) {
  for (std::size_t count = 1; count < 600; count += 7) {
    RobotMessage message;
    for (std::size_t k = 0; k < count; ++k) message.records += static_cast<char>(37 * k + count);
    EXPECT_EQ(read_message(Json::parse(message_json(message).dump())).records, message.records);
  }
}

TEST(RobotMessageJson, WhatHasBeenReadIsWrittenTheSame) {
  const Json once = example_json();
  EXPECT_EQ(Json::parse(message_json(read_message(once)).dump()), once);
}

TEST(RobotMessageJson, WithoutStatusOrRecords) {
  const RobotMessage message = read_message(Json::parse(message_json({}).dump()));
  EXPECT_FALSE(message.status);
  EXPECT_TRUE(message.records.empty());
}

void expect_refused(const std::function<void(Json&)>& change, const std::string& words) {
  Json json = example_json();
  change(json);
  expect_refusal([&] { read_message(json); }, 0, words);
}

TEST(RobotMessageJson, MessagesOfOthersAreRefused) {
  expect_refused([](Json& json) { json = "hello"; }, "not an object");
  expect_refused([](Json& json) { json.erase("format"); }, "no 'format'");
  expect_refused([](Json& json) { json["format"] = "radioslam-rendezvous/1"; }, "'format'");
  expect_refused([](Json& json) { json["status"].erase("pose"); }, "no 'pose'");
  expect_refused([](Json& json) { json["status"]["number"] = -1; }, "'number'");
  expect_refused([](Json& json) { json["status"]["knows"]["b"] = 0.5; }, "a version is not a list of 3");
  expect_refused([](Json& json) { json["status"]["knows"]["*"] = {0, 1, 2}; }, "'knows'");
  for (const char* text : {"A", "AA", "AAA", "AA==AA==", "A*==", "AAA=\n", "AB=="})
    expect_refused([&](Json& json) { json["records"] = text; }, "'records'");
}

}  // namespace
}  // namespace radioslam
