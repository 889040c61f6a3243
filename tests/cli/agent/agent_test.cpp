// radioslam agent, and radioslam team over DDS: processes that find each other end where a run ends, go on
// after they were killed, and conclude when they are asked to.
#include <gtest/gtest.h>
#include <netinet/in.h>
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

/// Of an agent, or of a team.
void expect_complete(const fs::path& result) {
  for (const char* file : {"summary.json", "report.html", "traffic.csv", "agents.csv", "events.csv"})
    EXPECT_TRUE(fs::exists(result / file)) << result / file;
  EXPECT_NE(fs::exists(result / "known.csv"), fs::exists(result / "agents")) << result;
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

/// A connection to a port of this machine that asks for this path and reads what comes first.
class Asked {
 public:
  Asked(int port, const std::string& path) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const std::string words = "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof(to)), 0);
    EXPECT_EQ(::send(socket_, words.data(), words.size(), MSG_NOSIGNAL), static_cast<ssize_t>(words.size()));
  }
  ~Asked() { ::close(socket_); }
  Asked(const Asked&) = delete;
  Asked& operator=(const Asked&) = delete;

  /// Until this has come, or the connection ends.
  std::string read_until(const std::string& words) {
    char block[4096];
    for (ssize_t got = 0;
         read_.find(words) == std::string::npos && (got = ::recv(socket_, block, sizeof(block), 0)) > 0;)
      read_.append(block, static_cast<std::size_t>(got));
    return read_;
  }

 private:
  int socket_;
  std::string read_;
};

/// A port of this machine that nobody else gets meanwhile; listened at or not.
struct HeldPort {
  explicit HeldPort(bool listens) : socket(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(at);
    EXPECT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&at), size), 0);
    const bool is_ready = !listens || ::listen(socket, 1) == 0;
    EXPECT_TRUE(is_ready);
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&at), &size);
    port = ntohs(at.sin_port);
  }
  ~HeldPort() { ::close(socket); }
  HeldPort(const HeldPort&) = delete;
  HeldPort& operator=(const HeldPort&) = delete;

  int socket, port = 0;
};

TEST(Agents, ConcludeThoughTheirPageIsOpen) {
  const auto& folder = short_drive();
  const TemporaryFolder place;
  fs::create_symlink(folder.path() / "town", place.path() / "town");
  int port = 0;
  { port = HeldPort(false).port; }
  std::vector<std::string> words = agent("a", now());
  words.insert(words.end(), {"--live", std::to_string(port)});
  Started a(words, place.path());
  ASSERT_TRUE(a.says("robot a is shown at http://127.0.0.1:" + std::to_string(port) + "/"));
  Asked page(port, "/"), events(port, "/events"), idle(port, "/events");
  EXPECT_NE(page.read_until("</html>").find("Robot a"), std::string::npos);
  const std::string whole = events.read_until("\"whole\":true");
  EXPECT_NE(whole.find("data: {\"t\":"), std::string::npos) << whole.substr(0, 1000);
  a.signal(SIGTERM);
  EXPECT_NE(events.read_until("event: end").find("event: end"), std::string::npos);
  const Outcome outcome = a.wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expect_complete(place.path() / "of-a");
}

TEST(Agents, WrongOptionsAreNamed) {
  const auto& folder = short_drive();
  const HeldPort held(true);
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong{
      {{"agent", "--robot", "z", "--log", "town"}, "no robot 'z'"},
      {{"agent", "--robot", "a", "--log", "town", "--start", "soon"}, "no time in seconds"},
      {{"agent", "--robot", "a", "--log", "nowhere"}, "nowhere"},
      {{"agent", "--robot", "a", "--log", "town", "--live", "x"}, "'x' is no PORT"},
      {{"agent", "--robot", "a", "--log", "town", "--live", "0.0.0.0:0", "--live-token", "a b"},
       "a token consists"},
      {{"agent", "--robot", "a", "--log", "town", "--live", std::to_string(held.port)},
       "another program has that port"},
      {{"team", "town", "--loss", "0.1", "--live", "8080"}, "--live is for --transport dds alone"},
      {{"team", "town", "--transport", "dds", "--live", "0"}, "a team needs a port"},
      {{"team", "town", "--transport", "dds", "--live", std::to_string(held.port)},
       "another program has that port"},
      {{"team", "town", "--loss", "0.1", "--rate", "2"}, "for --transport dds alone"},
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
