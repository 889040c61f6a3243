// Robots as processes of their own, one of which is killed.
#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <mutex>

#include "io/dds/dds_test_domain.hpp"
#include "radioslam/io/dds/team_channel.hpp"

namespace radioslam {
namespace {

constexpr const char* kDomainVariable = "RADIOSLAM_TEST_DOMAIN";

/// The other robot: answers each message to the one who sent it, until it is killed.
TEST(TeamProcess, DISABLED_Echo) {
  const char* domain = std::getenv(kDomainVariable);
  if (domain == nullptr) GTEST_SKIP() << "is started by the tests below";
  DdsConfig config = test_config();
  config.domain = static_cast<std::uint32_t>(std::stoul(domain));
  DdsDomain joined(config);
  std::mutex mutex;
  std::vector<TeamMessage> received;
  TeamChannel channel(joined, "echo", [&](TeamMessage message) {
    const std::lock_guard lock(mutex);
    received.push_back(std::move(message));
  });
  for (;;) {
    std::vector<TeamMessage> now;
    {
      const std::lock_guard lock(mutex);
      now.swap(received);
    }
    for (const TeamMessage& message : now)
      while (!channel.send(message.from, message.kind, message.octets))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

pid_t start_echo() {
  ::setenv(kDomainVariable, std::to_string(test_domain()).c_str(), 1);
  const pid_t child = ::fork();
  if (child == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const char* shards : {"GTEST_TOTAL_SHARDS", "GTEST_SHARD_INDEX"}) ::unsetenv(shards);
    ::execl("/proc/self/exe", "io_dds_tests", "--gtest_also_run_disabled_tests", "--gtest_brief=1",
            "--gtest_filter=TeamProcess.DISABLED_Echo", nullptr);
    ::_exit(127);
  }
  ::unsetenv(kDomainVariable);
  return child;
}

void kill_echo(pid_t child) {
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the other robot ended by itself, status " << WEXITSTATUS(status);
}

TEST(TeamProcess, ARobotThatIsKilledStopsNobodyAndComesBack) {
  DdsDomain domain(test_config());
  std::atomic<std::size_t> answers = 0;
  TeamChannel channel(domain, "a", [&](const TeamMessage& message) {
    if (message.from == "echo" && message.octets.size() == 20'000) ++answers;
  });
  const std::string octets(20'000, 'x');
  for (int life = 0; life < 2; ++life) {
    const pid_t echo = start_echo();
    const std::size_t before = answers;
    std::size_t asked = 0;
    ASSERT_TRUE(
        becomes_true([&] { return (asked += channel.send("echo", 1, octets)) > 0 && answers > before; }));
    kill_echo(echo);
    // Nobody knows yet that it is gone. Sending goes on as before.
    double longest_s = 0;
    for (int k = 0; k < 300; ++k) {
      const auto start = std::chrono::steady_clock::now();
      EXPECT_TRUE(channel.send("", 1, octets)) << k;
      EXPECT_TRUE(channel.send("echo", 1, octets)) << k;
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      longest_s = std::max(longest_s, taken.count());
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    EXPECT_LT(longest_s, 5);  // it never waits for the one that is gone
  }
}

}  // namespace
}  // namespace radioslam
