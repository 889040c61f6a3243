// Messages between robots as JSON: what comes back of them, and what is refused.
#include "radioslam/io/rendezvous/robot_message_json.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;

constexpr double kRelative = 1e-8;  ///< of nine digits, with a margin for what is computed from them

/// The covariance of a way that ends at (x, y) after its heading has changed.
SE2::Jacobian covariance_of_way(double sigma_m, double sigma_rad, double x_m, double y_m) {
  SE2::Jacobian factor = SE2::Jacobian::Zero();
  factor.row(0) << sigma_m, 0, 0;
  factor.row(1) << 0, sigma_m, 0;
  factor.row(2) << -y_m * sigma_rad, x_m * sigma_rad, sigma_rad;
  return factor.transpose() * factor;
}

SharedPart example_part() {
  SharedPart part;
  part.robot = "a";
  part.version = 7;
  part.start = SE2({1.25, -2}, 0.5);
  part.nodes.push_back({0, 0.1, std::nextafter(1.0 / 3, 0), {}});
  part.nodes.push_back({41,
                        1.0 / 3,
                        2.0 / 3,
                        {SE2({12.3456789012, 1e-7}, -3.0), covariance_of_way(0.3, 0.02, 12.3, 4.56789)}});
  part.observations.push_back({41, "c", 0.1 + 0.2, SE2({-4.5, 2.0 / 3}, 1), 0.1, 0.02, {-1.5, 1}});
  part.observations.push_back({0, "b", 0.2, SE2({5, 6}, 0), 0.1, 0.02, {}});
  part.evidence.push_back({"c", 2.0 / 7, {3.5, 0.25}});
  return part;
}

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
  status.knows = {{"b", 4}, {"c", std::uint64_t{1} << 60U}};
  return status;
}

Json example_json() {
  RobotMessage message{example_status(), {std::make_shared<const SharedPart>(example_part())}};
  return Json::parse(message_json(message).dump());
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

TEST(RobotMessageJson, APartComesBackWithExactTimes) {
  const SharedPart written = example_part();
  const RobotMessage message = read_message(example_json());
  ASSERT_EQ(message.parts.size(), 1U);
  const SharedPart& part = *message.parts[0];
  EXPECT_EQ(part.robot, "a");
  EXPECT_EQ(part.version, 7U);
  expect_near(*part.start, *written.start);
  ASSERT_EQ(part.nodes.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(part.nodes[k].number, written.nodes[k].number);
    EXPECT_EQ(part.nodes[k].t_s, written.nodes[k].t_s);
    EXPECT_EQ(part.nodes[k].until_s, written.nodes[k].until_s);
    expect_near(part.nodes[k].from_before.pose, written.nodes[k].from_before.pose);
  }
  ASSERT_EQ(part.observations.size(), 2U);
  EXPECT_EQ(part.observations[0].robot, "c");
  EXPECT_EQ(part.observations[1].robot, "b");
  EXPECT_EQ(part.observations[0].node, 41U);
  EXPECT_EQ(part.observations[0].t_s, written.observations[0].t_s);
  EXPECT_EQ(part.observations[0].evidence.log_odds, -1.5);
  expect_near(part.observations[0].T_i_j, written.observations[0].T_i_j);
  ASSERT_EQ(part.evidence.size(), 1U);
  EXPECT_EQ(part.evidence[0].by, "c");
  EXPECT_EQ(part.evidence[0].t_s, written.evidence[0].t_s);
  EXPECT_EQ(part.evidence[0].angles.scale, 0.25);
}

/// Nine digits of the covariance's entries would not be enough for its inverse.
TEST(RobotMessageJson, RoundingKeepsInformation) {
  const SE2::Jacobian written = covariance_of_way(1e-3, 0.1, 20.0 / 3, 40.0 / 7);
  SharedPart part = example_part();
  part.nodes[1].from_before.covariance = written;
  const RobotMessage message{{}, {std::make_shared<const SharedPart>(part)}};
  const RobotMessage back = read_message(Json::parse(message_json(message).dump()));
  const SE2::Jacobian read = back.parts[0]->nodes[1].from_before.covariance;
  EXPECT_LT((read - written).norm(), kRelative * written.norm());
  EXPECT_LT((read.inverse() - written.inverse()).norm(), 1e-4 * written.inverse().norm());
}

TEST(RobotMessageJson, WhatHasBeenReadIsWrittenTheSame) {
  const Json once = example_json();
  EXPECT_EQ(Json::parse(message_json(read_message(once)).dump()), once);
}

TEST(RobotMessageJson, WithoutStatusOrParts) {
  const RobotMessage message = read_message(Json::parse(message_json({}).dump()));
  EXPECT_FALSE(message.status);
  EXPECT_TRUE(message.parts.empty());
}

void expect_refused(const std::function<void(Json&)>& change, const std::string& words) {
  Json json = example_json();
  change(json);
  expect_refusal([&] { read_message(json); }, 0, words);
}

TEST(RobotMessageJson, MessagesOfOthersAreRefused) {
  expect_refused([](Json& json) { json = "hello"; }, "not an object");
  expect_refused([](Json& json) { json.erase("format"); }, "no 'format'");
  expect_refused([](Json& json) { json["format"] = "radioslam-rendezvous/2"; }, "'format'");
  expect_refused([](Json& json) { json["status"].erase("pose"); }, "no 'pose'");
  expect_refused([](Json& json) { json["status"]["number"] = -1; }, "'number'");
  expect_refused([](Json& json) { json["status"]["knows"]["b"] = 0.5; }, "'knows'");
}

TEST(RobotMessageJson, PartsThatFitNoGraphAreRefused) {
  const auto refuse = [](const std::function<void(Json&)>& change, const std::string& words) {
    expect_refused([&](Json& json) { change(json["parts"][0]); }, words);
  };
  refuse([](Json& part) { part["nodes"] = Json::array(); }, "not well-formed");
  refuse([](Json& part) { part["nodes"][1][0] = 0U; }, "not well-formed");
  refuse([](Json& part) { part["nodes"][1][6] = 0; }, "not well-formed");
  refuse([](Json& part) { part["nodes"][1].erase(11); }, "a list of 12");
  refuse([](Json& part) { part["nodes"][1][3] = 2e9; }, "value 4 of a node");
  refuse([](Json& part) { part["observations"][0][0] = 5U; }, "not well-formed");
  refuse([](Json& part) { part["observations"][0][1] = 2U; }, "value 2 of an observation");
  refuse([](Json& part) { part["observations"][0][6] = 0; }, "not well-formed");
  refuse([](Json& part) { part["others"][0] = "*"; }, "'others'");
  refuse([](Json& part) { part["nodes"] = Json::array_t(101); }, "a list of up to 100");
  refuse([](Json& part) { part["observations"] = Json::array_t(151); }, "a list of up to 150");
  refuse([](Json& part) { part["others"] = Json::array(); }, "does not name");
}

}  // namespace
}  // namespace radioslam
