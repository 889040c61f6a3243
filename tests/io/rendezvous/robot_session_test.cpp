// A robot driven by lines: what it answers, what a bad line does to it, and two robots that talk.
#include "radioslam/io/rendezvous/robot_session.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "io/refusal.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;
using Lines = std::vector<std::string>;

constexpr const char* kStart = R"({"start": {"t_s": 1, "pose": null, "q_db": 20, "kappa": 2, "delta": 0.5}})";
constexpr const char* kStep =
    R"({"odometry": {"t_s": 2, "T_previous_body": [1, 0, 0.5], "sigma_m": 0.1, "sigma_rad": 0}})";

Json parsed(const std::string& line) { return Json::parse(line); }

/// The only key of a line.
std::string kind_of(const std::string& line) { return parsed(line).begin().key(); }

Lines kinds_of(const Lines& lines) {
  Lines kinds;
  for (const std::string& line : lines) kinds.push_back(kind_of(line));
  return kinds;
}

/// A run with every kind of event; all times from the second line on are 2 or later.
const Lines kRun{
    kStart,
    kStep,
    R"({"seen": {"t_s": 2, "robot": "b", "T_i_j": [3, 1, 0], "sigma_m": 0.1, "sigma_rad": 0.02}})",
    R"({"packet": {"t_s": 2.5, "from": "b", "esnr_db": 25,
        "paths": [{"azimuth_rad": 0.3, "sigma_rad": 0.05, "power_db": -60}]}})",
    R"({"obstacle": {"t_s": 2.5, "azimuth_rad": 0, "distance_m": 1}})",
    R"({"tick": {"t_s": 3}})",
    R"({"tick": {"t_s": 3, "talk": true}})",
    R"({"odometry": {"t_s": 4, "T_previous_body": [2, 0, 0], "sigma_m": 5, "sigma_rad": 0.1}})",
    R"({"tick": {"t_s": 4}})",
    R"({"finish": {}})"};

const Lines kBadLines{
    "hello",
    "[]",
    "{}",
    "\xff",
    R"({"tick": {"t_s": 9}} {})",
    R"({"dance": {}})",
    R"({"tick": {"t_s": 9}, "finish": {}})",
    R"({"tick": 9})",
    R"({"tick": {}})",
    R"({"tick": {"t_s": "9"}})",
    R"({"tick": {"t_s": null}})",
    R"({"tick": {"t_s": NaN}})",
    R"({"tick": {"t_s": 1e999}})",
    R"({"tick": {"t_s": 1e12}})",
    R"({"tick": {"t_s": 0.5}})",
    R"({"tick": {"t_s": 9, "talk": 1}})",
    R"({"tick": {"t_s": 9, "tlak": true}})",
    R"({"tick": {"t_s": 9, "Talk": true}})",
    R"({"packet": {"t_s": 9, "from": "b", "esnr_db": 25, "paths": [], "mesage": {}}})",
    R"({"packet": {"t_s": 9, "from": "b", "esnr_db": 25, "paths": [{"azimuth_rad": 0, "sigma_rad": 1, "power_db": 0, "powerdb": 1}]}})",
    kStart,
    R"({"odometry": {"t_s": 9, "T_previous_body": [1, 0], "sigma_m": 0.1, "sigma_rad": 0.1}})",
    R"({"odometry": {"t_s": 9, "T_previous_body": [1, 0, 2e9], "sigma_m": 0.1, "sigma_rad": 0.1}})",
    R"({"odometry": {"t_s": 9, "T_previous_body": [1, 0, 0], "sigma_m": -0.1, "sigma_rad": 0.1}})",
    R"({"odometry": {"t_s": 9, "T_previous_body": [1, 0, 0], "sigma_m": 0.1}})",
    R"({"seen": {"t_s": 9, "robot": "b", "T_i_j": [3, 1, 0], "sigma_m": -1, "sigma_rad": 0.1}})",
    R"({"seen": {"t_s": 9, "robot": "", "T_i_j": [3, 1, 0], "sigma_m": 0.1, "sigma_rad": 0.1}})",
    R"({"seen": {"t_s": 9, "robot": 7, "T_i_j": [3, 1, 0], "sigma_m": 0.1, "sigma_rad": 0.1}})",
    R"({"packet": {"t_s": 9, "from": "*", "esnr_db": 25, "paths": []}})",
    R"({"packet": {"t_s": 9, "from": "b", "esnr_db": 25}})",
    R"({"packet": {"t_s": 9, "from": "b", "esnr_db": 25, "paths": [{"azimuth_rad": 0.3}]}})",
    R"({"packet": {"t_s": 9, "from": "b", "esnr_db": 25, "paths": [], "message": {"hello": 1}}})",
    R"({"obstacle": {"t_s": 9, "azimuth_rad": 0, "distance_m": -1}})",
    std::string(kLongestLine_bytes + 1, ' ')};

void expect_error(const Lines& answer, std::size_t line, const std::string& what) {
  ASSERT_EQ(kinds_of(answer), Lines{"error"}) << what.substr(0, 200);
  const Json error = parsed(answer[0])["error"];
  EXPECT_EQ(error["line"], line);
  EXPECT_FALSE(error["reason"].get<std::string>().empty());
}

Lines run(const Lines& input) {
  RobotSession session("a", {});
  Lines output;
  for (const std::string& line : input)
    for (const std::string& answer : session.line(line)) output.push_back(answer);
  return output;
}

TEST(RobotSession, AnswersTicksAndTheEnd) {
  RobotSession session("a", {});
  std::vector<Lines> kinds;
  for (const std::string& line : kRun) kinds.push_back(kinds_of(session.line(line)));
  for (const std::size_t quiet : {0U, 1U, 2U, 3U, 4U, 7U}) EXPECT_TRUE(kinds[quiet].empty());
  EXPECT_EQ(kinds[5].back(), "state");
  EXPECT_EQ(kinds[5].front(), "send");
  EXPECT_NE(kinds[5][kinds[5].size() - 2], "send");  // the movement
  EXPECT_EQ(kinds[6].back(), "state");
  for (std::size_t k = 0; k + 1 < kinds[6].size(); ++k) EXPECT_EQ(kinds[6][k], "send");
  EXPECT_EQ(kinds[9], Lines{"frame"});  // of the keys frame, measurements, trajectory
  EXPECT_TRUE(session.finished());
  EXPECT_TRUE(session.end().empty());
}

TEST(RobotSession, TheTrajectoryHasARowPerNode) {
  const Json end = parsed(run(kRun).back());
  ASSERT_EQ(end["trajectory"].size(), 3U);
  EXPECT_EQ(end["trajectory"][0], Json::parse("[1.0, 0.0, 0.0, 0.0]"));
  const std::vector<double> second{2, 1, 0, 0.5};  // as a record has it, in 32 bits
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(end["trajectory"][1][k].get<double>(), second[k], 1e-6);
  EXPECT_EQ(end["frame"], "a");
  ASSERT_EQ(end["measurements"].size(), 1U);
  EXPECT_EQ(end["measurements"][0]["robot"], "b");
  EXPECT_EQ(end["measurements"][0]["t_s"], 2.0);
}

TEST(RobotSession, TheEndOfTheInputFinishes) {
  RobotSession session("a", {}), unstarted("a", {});
  for (auto line = kRun.begin(); line + 1 != kRun.end(); ++line) session.line(*line);
  EXPECT_EQ(session.end(), Lines{run(kRun).back()});
  EXPECT_TRUE(session.finished());
  EXPECT_TRUE(unstarted.end().empty());
}

TEST(RobotSession, AMisspeltMemberIsNamedAndOthersOfADriverAreNotRead) {
  const auto reason = [](const std::string& line) {
    RobotSession session("a", {});
    const Lines answer = session.line(line);
    return answer.empty() ? std::string() : parsed(answer[0])["error"]["reason"].get<std::string>();
  };
  EXPECT_EQ(reason(R"({"start": {"t_s": 1, "kapa": 2}})"),
            "'kapa' of start is not known; did you mean kappa?");
  EXPECT_EQ(reason(R"({"start": {"t_s": 1, "q_dB": 2}})"),
            "'q_dB' of start is not known; did you mean q_db?");
  EXPECT_EQ(reason(R"({"start": {"t_s": 1, "maxStepM": 2}})"),
            "'maxStepM' of start is not known; did you mean max_step_m?");
  EXPECT_EQ(reason(R"({"strat": {"t_s": 1}})"), "unknown event 'strat'; did you mean start?");
  EXPECT_EQ(reason(R"({"start": {"t_s": 1, "frame_id": "map", "seq": 4, "x_m": 0}})"), "");
}

TEST(RobotSession, BadLinesChangeNothing) {
  RobotSession session("a", {});
  Lines output;
  std::size_t number = 0;
  for (const std::string& good : kRun) {
    for (const std::string& answer : session.line(good)) output.push_back(answer);
    ++number;
    for (const std::string& bad : kBadLines) expect_error(session.line(bad), ++number, bad);
  }
  EXPECT_EQ(output, run(kRun));
}

/// They would take thirty times their bytes.
TEST(RobotSession, LinesOfVeryManyShortValuesAreRefusedBeforeTheyAreRead) {
  RobotSession robot("a", {});
  for (const char* value : {"0,", "[],", "{},", "\"\","}) {
    std::string line = "[";
    while (line.size() < 500'000) line += value;
    const Lines answer = robot.line(line + "0]");
    ASSERT_EQ(answer.size(), 1U);
    EXPECT_NE(answer[0].find("too many values"), std::string::npos) << answer[0].substr(0, 200);
  }
  EXPECT_NE(robot.line("\"" + std::string(500'000, ',') + "\"")[0].find("not an object"), std::string::npos);
  EXPECT_NE(robot.line(std::string(500'000, '['))[0].find("too many values"), std::string::npos);
}

TEST(RobotSession, NothingComesBeforeTheStart) {
  RobotSession session("a", {});
  std::size_t number = 0;
  for (std::size_t k = 1; k < kRun.size(); ++k) expect_error(session.line(kRun[k]), ++number, kRun[k]);
  EXPECT_TRUE(session.line(kStart).empty());
}

TEST(RobotSession, BlankLinesCount) {
  RobotSession session("a", {});
  for (const char* blank : {"", " \t", "\r"}) EXPECT_TRUE(session.line(blank).empty());
  expect_error(session.line("x"), 4, "x");
  EXPECT_TRUE(session.line(std::string(kStart) + "\r").empty());
}

TEST(RobotSession, NamesThatMeanNoRobotAreRefused) {
  for (const std::string& name : {std::string(), std::string("*"), std::string(200, 'a')})
    EXPECT_THROW(RobotSession(name, {}), InputError) << name;
}

// ---- two robots -----------------------------------------------------------------------------------------

/// Carries what each robot sends to the other, a round later.
class Pair {
 public:
  Pair() { both(R"({"start": {"t_s": 0}})"); }

  void both(const std::string& line) {
    for (const std::string name : {"a", "b"}) robots_.at(name).line(line);
  }
  Lines line(const std::string& name, const std::string& line) { return robots_.at(name).line(line); }

  void round(double t_s, const Json& tick) {
    for (const std::string name : {"a", "b"}) deliver(name, t_s);
    for (const std::string name : {"a", "b"})
      for (const std::string& answer : line(name, tick.dump())) note(name, parsed(answer));
  }

  Json state(const std::string& name) { return states_[name]; }
  int data_messages_of(const std::string& name) { return data_messages_[name]; }

 private:
  /// The arrivals at either robot lie where the other is, in `TwoRobots`.
  void deliver(const std::string& to, double t_s) {
    const double azimuth_rad = to == "a" ? 0 : std::numbers::pi / 2;
    Json packet{{"t_s", t_s}, {"from", to == "a" ? "b" : "a"}, {"esnr_db", 40}};
    packet["paths"] = {{{"azimuth_rad", azimuth_rad}, {"sigma_rad", 0.05}, {"power_db", -50}}};
    line(to, Json{{"packet", packet}}.dump());
    for (Json& message : inbox_[to]) {
      packet["message"] = std::move(message);
      EXPECT_TRUE(line(to, Json{{"packet", packet}}.dump()).empty());
    }
    inbox_[to].clear();
  }

  void note(const std::string& from, Json answer) {
    if (answer.contains("state")) states_[from] = answer["state"];
    if (!answer.contains("send")) return;
    if (answer["send"]["kind"] == "data") ++data_messages_[from];
    inbox_[from == "a" ? "b" : "a"].push_back(answer["send"]["message"]);
  }

  std::map<std::string, RobotSession> robots_ = [] {
    std::map<std::string, RobotSession> robots;
    for (const char* name : {"a", "b"}) robots.try_emplace(name, std::string(name), RendezvousParams{});
    return robots;
  }();
  std::map<std::string, std::vector<Json>> inbox_;
  std::map<std::string, Json> states_;
  std::map<std::string, int> data_messages_;
};

/// a is one metre ahead of its start and sees b three metres ahead and turned to the left; b is half a metre
/// from its start and sees nothing.
TEST(TwoRobots, WhatOneSeesPutsBothIntoOneFrame) {
  Pair pair;
  pair.line("a",
            R"({"odometry": {"t_s": 1, "T_previous_body": [1, 0, 0], "sigma_m": 0.01, "sigma_rad": 0.01}})");
  pair.line(
      "b", R"({"odometry": {"t_s": 1, "T_previous_body": [0.5, 0, 0], "sigma_m": 0.01, "sigma_rad": 0.01}})");
  pair.line("a", R"({"seen": {"t_s": 1, "robot": "b", "T_i_j": [3, 0, 1.5707963267948966], "sigma_m": 0.1,
                     "sigma_rad": 0.02}})");
  pair.round(1, {{"tick", {{"t_s", 1}}}});
  EXPECT_EQ(pair.state("b")["team"], Json::parse(R"(["b"])"));
  for (int k = 0; k < 6; ++k) pair.round(1, {{"tick", {{"t_s", 1}, {"talk", true}}}});
  pair.round(1, {{"tick", {{"t_s", 1}}}});
  for (const char* name : {"a", "b"}) {
    EXPECT_GE(pair.data_messages_of(name), 1);
    EXPECT_EQ(pair.state(name)["team"], Json::parse(R"(["a", "b"])"));
    EXPECT_EQ(pair.state(name)["serving"], nullptr);
  }

  const Json of_a = parsed(pair.line("a", R"({"finish": {}})").at(0));
  const Json of_b = parsed(pair.line("b", R"({"finish": {}})").at(0));
  EXPECT_EQ(of_a["frame"], "a");
  EXPECT_EQ(of_b["frame"], "a");
  EXPECT_GT(of_a["measurements"][0]["weight"], 0.9);
  const std::vector<double> expected{1, 4, 0, std::numbers::pi / 2};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(of_b["trajectory"][1][k].get<double>(), expected[k], 1e-6);
  EXPECT_NEAR(of_b["trajectory"][0][2].get<double>(), -0.5, 1e-6);
}

}  // namespace
}  // namespace radioslam
