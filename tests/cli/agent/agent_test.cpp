// radioslam agent, and radioslam team over DDS: processes that find each other end where a run ends, go on
// after they were killed, and conclude when they are asked to.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "cli/process.hpp"
#include "cli/short_drive.hpp"
#include "io/dds/dds_test_domain.hpp"
#include "radioslam/io/journal/journal.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// The files of a result that do not depend on how long it took.
constexpr const char* kResults[] = {"a.tum", "b.tum", "closures.csv", "graph.g2o"};

/// A robot of a team that is started by hand; the drive takes 18 s.
std::vector<std::string> agent(const std::string& robot, const std::string& start) {
  return {"agent",
          "--robot",
          robot,
          "--log",
          "town",
          "--rate",
          "4",
          "--start",
          start,
          "--domain",
          std::to_string(test_domain()),
          "--peer",
          "127.0.0.1",
          "--interface",
          "127.0.0.1",
          "--journal",
          robot + ".journal",
          "-o",
          "of-" + robot};
}

std::string now() {
  return format_number(
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count());
}

void expect_complete(const fs::path& result) {
  for (const char* file :
       {"summary.json", "report.html", "traffic.csv", "agents.csv", "known.csv", "events.csv"})
    EXPECT_TRUE(fs::exists(result / file)) << result / file;
}

/// Of a temporary name, as outputs have until they are complete.
std::vector<std::string> unfinished(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().find("of-") == std::string::npos || entry.path().extension() != "")
      names.push_back(entry.path().filename().string());
  std::erase_if(names, [](const std::string& name) {
    return name == "town" || name == "whole" || name.find(".journal") != std::string::npos;
  });
  return names;
}

TEST(Agents, EndWhereARunEnds) {
  const auto& folder = short_drive();
  const Outcome team =
      run({"team", "town", "--transport", "dds", "--rate", "20", "-o", "processes"}, folder.path());
  ASSERT_EQ(team.status, 0) << team.err;
  const fs::path out = folder.path() / "processes";
  for (const fs::path& result : {out, out / "agents/a", out / "agents/b"}) expect_complete(result);
  EXPECT_FALSE(fs::exists(out / "journals"));
  for (const char* file : kResults) {
    EXPECT_EQ(read_file(out / "agents/a" / file), read_file(out / "agents/b" / file)) << file;
    EXPECT_EQ(read_file(out / "agents/a" / file), read_file(out / file)) << file;
  }
  EXPECT_LE(error_of(out / "summary.json"), 1.05 * error_of(folder.path() / "whole/summary.json") + 0.02);
}

TEST(Agents, OneThatIsKilledAndStartedAgainGoesOn) {
  const auto& folder = short_drive();
  const TemporaryFolder place;
  fs::create_symlink(folder.path() / "town", place.path() / "town");
  const std::string start = now();
  Started b(agent("b", start), place.path());
  {
    Started a(agent("a", start), place.path());
    ASSERT_TRUE(a.says("hears robot b"));
    ASSERT_TRUE(b.says("hears robot a"));
    std::this_thread::sleep_for(std::chrono::seconds(1));
    a.signal(SIGKILL);
    EXPECT_EQ(a.wait().status, 128 + SIGKILL);
  }
  EXPECT_FALSE(fs::exists(place.path() / "of-a"));
  Started again(agent("a", start), place.path());
  EXPECT_TRUE(again.says("is started again"));
  const Outcome of_a = again.wait(), of_b = b.wait();
  ASSERT_EQ(of_a.status, 0) << of_a.err;
  ASSERT_EQ(of_b.status, 0) << of_b.err;
  EXPECT_EQ((of_a.out + of_b.out).find("refuses"), std::string::npos) << of_a.out << of_b.out;
  for (const char* file : kResults)
    EXPECT_EQ(read_file(place.path() / "of-a" / file), read_file(place.path() / "of-b" / file)) << file;

  const Journal own(place.path() / "a.journal", "a", 0), heard(place.path() / "b.journal", "b", 0);
  const auto logs = own.logs(), same = heard.logs();
  ASSERT_EQ(logs.size(), 2U);  // one life of each robot
  ASSERT_EQ(same.size(), 2U);
  for (std::size_t k = 0; k < logs.size(); ++k) {
    EXPECT_EQ(logs[k].first, same[k].first);
    EXPECT_EQ(logs[k].second.life, same[k].second.life);
    EXPECT_EQ(logs[k].second.records, same[k].second.records);
  }
}

TEST(Agents, ConcludeWhenAskedTo) {
  const auto& folder = short_drive();
  const TemporaryFolder place;
  fs::create_symlink(folder.path() / "town", place.path() / "town");
  const std::string start = now();
  Started a(agent("a", start), place.path()), b(agent("b", start), place.path());
  ASSERT_TRUE(a.says("hears robot b"));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  a.signal(SIGTERM);
  b.signal(SIGINT);
  for (Started* agent : {&a, &b}) {
    const Outcome outcome = agent->wait();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  }
  for (const char* result : {"of-a", "of-b"}) expect_complete(place.path() / result);
}

TEST(Agents, ASecondSignalLeavesNothingTorn) {
  const auto& folder = short_drive();
  const TemporaryFolder place;
  fs::create_symlink(folder.path() / "town", place.path() / "town");
  Started a(agent("a", now()), place.path());
  ASSERT_TRUE(a.says("robot a"));
  std::this_thread::sleep_for(std::chrono::seconds(1));
  a.signal(SIGTERM);
  ASSERT_TRUE(a.says("is asked"));
  a.signal(SIGTERM);
  const Outcome outcome = a.wait();
  if (outcome.status == 0) {  // it was over before
    expect_complete(place.path() / "of-a");
  } else {
    EXPECT_EQ(outcome.status, 130) << outcome.err;
    EXPECT_FALSE(fs::exists(place.path() / "of-a"));
  }
  EXPECT_TRUE(unfinished(place.path()).empty()) << unfinished(place.path()).front();
}

TEST(Agents, ATeamThatIsAskedToEndHasItsOutputs) {
  const auto& folder = short_drive();
  Started team({"team", "town", "--transport", "dds", "--rate", "4", "-o", "asked"}, folder.path());
  const auto agents = team.children(2);
  ASSERT_EQ(agents.size(), 2U);
  std::this_thread::sleep_for(std::chrono::seconds(3));
  team.signal(SIGTERM);
  const Outcome outcome = team.wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* result : {"asked", "asked/agents/a", "asked/agents/b"})
    expect_complete(folder.path() / result);
}

TEST(Agents, ATeamNamesTheOneThatDied) {
  const auto& folder = short_drive();
  Started team({"team", "town", "--transport", "dds", "--rate", "20", "-o", "bereaved"}, folder.path());
  const auto agents = team.children(2);
  ASSERT_EQ(agents.size(), 2U);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  kill(agents.back(), SIGKILL);
  const Outcome outcome = team.wait();
  EXPECT_NE(outcome.status, 0);
  EXPECT_NE(outcome.err.find("the agent of robot b was ended by signal 9"), std::string::npos) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  expect_complete(folder.path() / "bereaved");
  expect_complete(folder.path() / "bereaved/agents/a");
}

TEST(Agents, WrongOptionsAreNamed) {
  const auto& folder = short_drive();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"agent", "--robot", "z", "--log", "town"}, "no robot 'z'"},
      {{"agent", "--robot", "a", "--log", "town", "--start", "soon"}, "no time in seconds"},
      {{"agent", "--robot", "a", "--log", "nowhere"}, "nowhere"},
      {{"team", "town", "--rate", "2"}, "for --transport dds alone"},
      {{"team", "town", "--transport", "dds", "--loss", "0.5"}, "for --transport in-process alone"}};
  for (const auto& [call, what] : wrong) {
    std::vector<std::string> arguments = call;
    arguments.insert(arguments.end(), {"-o", "nothing"});
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2) << what;
    EXPECT_NE(outcome.err.find(what), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder.path() / "nothing"));
  }
}

}  // namespace
}  // namespace radioslam::cli
