// A robot that is killed at any instant: what it has called committed is there, and no number has two
// contents.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <random>
#include <thread>

#include "io/temporary_folder.hpp"
#include "radioslam/io/journal/journal.hpp"

namespace radioslam {
namespace {

constexpr int kKills = 20;
constexpr std::size_t kBatch = 5;

std::string content(int run, std::uint64_t number) {
  return "record " + std::to_string(number) + " of run " + std::to_string(run) +
         std::string(number * 37 % 900, '.');
}

/// Goes on with the journal until killed; says the number of records after each commit.
[[noreturn]] void append_until_killed(const std::filesystem::path& file, int run, int report) {
  try {
    Journal journal(file, "a", 7);
    for (;;) {
      JournalChange change;
      change.first_own = journal.own_records();
      for (std::uint64_t k = 0; k < kBatch; ++k) change.own.push_back(content(run, change.first_own + k));
      change.kept.push_back({"b", 1, change.first_own, change.own});
      change.state["count"] = std::to_string(change.first_own + kBatch);
      journal.commit(change);
      const std::uint64_t committed = journal.own_records();
      if (::write(report, &committed, sizeof(committed)) != sizeof(committed)) ::_exit(3);
    }
  } catch (const std::exception& error) {
    static_cast<void>(!::write(2, error.what(), std::string_view(error.what()).size()));
    ::_exit(2);
  }
}

/// Starts a robot, kills it that long after its first commit; the number of records it called committed.
std::uint64_t run_and_kill(const std::filesystem::path& file, int run, std::chrono::microseconds life) {
  std::array<int, 2> pipe{};
  EXPECT_EQ(::pipe(pipe.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) append_until_killed(file, run, pipe[1]);
  ::close(pipe[1]);
  std::uint64_t committed = 0, said = 0;
  if (::read(pipe[0], &said, sizeof(said)) == sizeof(said)) committed = said;
  std::this_thread::sleep_for(life);
  ::kill(child, SIGKILL);
  while (::read(pipe[0], &said, sizeof(said)) == sizeof(said)) committed = said;
  ::close(pipe[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status)) << "the robot ended by itself, status " << WEXITSTATUS(status);
  return committed;
}

TEST(JournalKill, WhatWasCommittedIsThereAndNoNumberHasTwoContents) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.journal";
  std::mt19937 random(1);
  std::map<std::uint64_t, std::string> seen;  // as any other robot may have received it
  for (int run = 0; run < kKills; ++run) {
    const std::chrono::microseconds life(std::uniform_int_distribution<>(0, 30'000)(random));
    const std::uint64_t before = seen.size(), committed = run_and_kill(file, run, life);
    ASSERT_GT(committed, before) << "run " << run;
    for (std::uint64_t k = before; k < committed; ++k) seen[k] = content(run, k);

    const Journal journal(file, "a", 8);
    ASSERT_EQ(journal.life(), 7u);
    const auto logs = journal.logs();
    ASSERT_EQ(logs.size(), 2u);
    const auto& own = logs[0].second.records;
    ASSERT_EQ(own, logs[1].second.records);
    ASSERT_EQ(journal.state("count"), std::to_string(own.size()));
    ASSERT_GE(own.size(), committed);
    // A commit may have been on the disk before the robot could say so, never more than one.
    ASSERT_LE(own.size(), committed + kBatch);
    for (const auto& [number, record] : seen) ASSERT_EQ(own.at(number), record) << "run " << run;
    seen = own;
  }
}

}  // namespace
}  // namespace radioslam
