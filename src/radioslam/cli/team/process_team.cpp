#include "radioslam/cli/team/process_team.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <system_error>
#include <thread>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/cli/ending.hpp"
#include "radioslam/cli/team/journal_store.hpp"
#include "radioslam/cli/team/live_options.hpp"
#include "radioslam/cli/team/team_output.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t kLastDomain = 90;  // whose ports are below those that the kernel gives away
constexpr double kLead_s = 1;              // from the start of the programs to that of the mission
constexpr std::chrono::milliseconds kPoll{20};
constexpr std::uint32_t kLeastPerHost = 10;

/// A DDS domain, held by a socket of its name as long as this process lives.
std::uint32_t free_domain() {
  for (std::uint32_t domain = kLastDomain; domain > 0; --domain) {
    const std::string name = "radioslam team in domain " + std::to_string(domain);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path + 1, sizeof(address.sun_path) - 1);
    const int held = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (::bind(held, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return domain;
    ::close(held);
  }
  throw InputError("--domain", 0, "every domain has a team of this machine already");
}

std::vector<std::string> arguments_of(const ProcessTeamSetup& setup, std::uint32_t domain,
                                      const std::string& start, const std::string& robot,
                                      const fs::path& folder) {
  const auto robots = static_cast<std::uint32_t>(setup.robots.size());
  std::vector<std::string> words{"radioslam-agent",
                                 "--robot",
                                 robot,
                                 "--log",
                                 setup.mission,
                                 "--rate",
                                 format_number(setup.rate),
                                 "--start",
                                 start,
                                 "--domain",
                                 std::to_string(domain),
                                 "--peer",
                                 "127.0.0.1",
                                 "--interface",
                                 "127.0.0.1",
                                 "--robots-per-host",
                                 std::to_string(std::max(kLeastPerHost, robots + 1)),
                                 "--journal",
                                 (folder / "journals" / (robot + ".journal")).string(),
                                 "--output",
                                 (folder / "agents" / robot).string()};
  if (setup.live) {
    const auto place = std::find(setup.robots.begin(), setup.robots.end(), robot) - setup.robots.begin();
    LiveAddress page = *setup.live;
    page.port += static_cast<int>(place);
    words.insert(words.end(), {"--live", to_string(page)});
  }
  words.insert(words.end(), setup.options.begin(), setup.options.end());
  return words;
}

/// In a group of its own, so that a terminal's interrupt comes from this process alone; it does not outlive
/// it.
pid_t start(const fs::path& program, std::vector<std::string> words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t parent = ::getpid(), child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "an agent cannot be started");
  if (child > 0) return child;
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  const int nowhere = ::open("/dev/null", O_RDWR);
  ::dup2(nowhere, STDIN_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  ::execv(program.c_str(), pointers.data());
  ::_exit(127);
}

std::string ended_how(int status) {
  if (WIFSIGNALED(status)) return "was ended by signal " + std::to_string(WTERMSIG(status));
  if (WEXITSTATUS(status) == 127) return "could not be started";
  return "ended with status " + std::to_string(WEXITSTATUS(status));
}

/// Waits for all; how each one ended.
std::map<std::string, int> wait_for(std::map<pid_t, std::string> agents) {
  std::map<std::string, int> statuses;
  bool is_asked = false;
  while (!agents.empty()) {
    if (is_to_conclude() && !std::exchange(is_asked, true))
      for (const auto& [process, robot] : agents) ::kill(process, SIGTERM);
    for (auto agent = agents.begin(); agent != agents.end();) {
      int status = 0;
      if (::waitpid(agent->first, &status, WNOHANG) == 0) {
        ++agent;
        continue;
      }
      statuses[agent->second] = status;
      agent = agents.erase(agent);
    }
    std::this_thread::sleep_for(kPoll);
  }
  return statuses;
}

}  // namespace

ProcessTeamRun run_processes(const ProcessTeamSetup& setup, const fs::path& folder) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "radioslam-agent";
  if (!fs::exists(program))
    throw InputError("team", 0,
                     "needs the program " + program.string() +
                         ", which is built by itself: cmake --build build/release --target radioslam_agent");
  for (const char* part : {"agents", "journals"}) fs::create_directories(folder / part);
  const std::uint32_t domain = setup.domain ? *setup.domain : free_domain();
  const auto now = std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  const std::string begin = format_number(now + kLead_s);
  if (!setup.live_token.empty()) ::setenv(kLiveTokenVariable, setup.live_token.c_str(), 1);
  conclude_on_signal();
  std::map<pid_t, std::string> agents;
  for (const std::string& robot : setup.robots)
    agents[start(program, arguments_of(setup, domain, begin, robot, folder))] = robot;

  ProcessTeamRun team;
  for (const auto& [robot, status] : wait_for(std::move(agents))) {
    if (status != 0) {
      team.failed.push_back("the agent of robot " + robot + ' ' + ended_how(status));
      continue;
    }
    const JournalStore store(folder / "journals" / (robot + ".journal"), robot, 0);
    const AgentMemory memory = store.memory();
    const KnownLogs logs(robot, setup.dimension, memory.life, memory.logs);
    team.run.logs[robot] = logs.whole();
    team.run.extents[robot] = logs.extents();
    read_tables(folder / "agents" / robot, setup.begin, team.run);
  }
  for (const auto& [robot, event] : team.run.events) team.run.end = std::max(team.run.end, event.at);
  fs::remove_all(folder / "journals");
  return team;
}

}  // namespace radioslam::cli
