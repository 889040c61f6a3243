// Each fault of a journal gives one line that names the file, and loses nothing.
#include <gtest/gtest.h>
#include <sched.h>
#include <sqlite3.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <random>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/journal/journal.hpp"

namespace radioslam {
namespace {

using Records = std::map<std::uint64_t, std::string>;

std::vector<std::string> contents(std::uint64_t first, std::size_t count) {
  std::vector<std::string> records;
  for (std::uint64_t k = first; k < first + count; ++k)
    records.push_back("record " + std::to_string(k) + std::string(k * 37 % 900, '.'));
  return records;
}

void append(Journal& journal, std::size_t count) {
  JournalChange change;
  change.first_own = journal.own_records();
  change.own = contents(change.first_own, count);
  journal.commit(change);
}

/// All records are those that `append` has written.
void expect_known_contents(const Journal& journal) {
  const auto expected = contents(0, journal.own_records());
  const auto logs = journal.logs();
  if (expected.empty()) return;
  ASSERT_EQ(logs.size(), 1u);
  for (std::size_t k = 0; k < expected.size(); ++k) ASSERT_EQ(logs[0].second.records.at(k), expected[k]);
}

class JournalFaults : public testing::Test {
 protected:
  /// A journal of robot a with 200 records.
  void make() const {
    Journal journal(file_, "a", 7);
    append(journal, 200);
  }
  /// One line that names the file.
  std::string refusal_of_opening(const std::string& robot = "a") const {
    const std::string line = refusal([&] { Journal(file_, robot, 8); });
    EXPECT_TRUE(line.starts_with(file_.string() + ": ")) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    return line;
  }
  void expect_whole() const {
    const Journal journal(file_, "a", 8);
    EXPECT_EQ(journal.life(), 7u);
    EXPECT_EQ(journal.own_records(), 200u);
    expect_known_contents(journal);
  }
  void execute(const std::string& statement) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(file_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, statement.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << statement;
    sqlite3_close(database);
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "a.journal";
};

TEST_F(JournalFaults, OfAnotherRobot) {
  make();
  EXPECT_NE(refusal_of_opening("b").find("this is the journal of robot a, not of b"), std::string::npos);
  expect_whole();
}

TEST_F(JournalFaults, OfAnotherVersion) {
  make();
  execute("PRAGMA user_version = 2");
  EXPECT_NE(refusal_of_opening().find("the journal has version 2, this program uses version 1"),
            std::string::npos);
  execute("PRAGMA user_version = 1");
  expect_whole();
}

TEST_F(JournalFaults, ADatabaseForSomethingElseIsLeftAsItIs) {
  execute("CREATE TABLE topics(id)");
  const std::string before = folder_.read("a.journal");
  EXPECT_NE(refusal_of_opening().find("this is no journal, but a database for something else"),
            std::string::npos);
  EXPECT_TRUE(folder_.read("a.journal") == before);
}

TEST_F(JournalFaults, AFileThatIsNoDatabaseIsLeftAsItIs) {
  for (const std::string& text : {std::string("xy"), std::string("t_s,x\n1,2\n"), std::string(5000, '\7')}) {
    folder_.write("a.journal", text);
    EXPECT_NE(refusal_of_opening().find("file is not a database"), std::string::npos);
    EXPECT_TRUE(folder_.read("a.journal") == text);
  }
}

TEST_F(JournalFaults, NoFolder) {
  const std::string line = refusal([&] { Journal(folder_.path() / "none" / "a.journal", "a", 7); });
  EXPECT_NE(line.find("unable to open database file (No such file or directory)"), std::string::npos) << line;
}

TEST_F(JournalFaults, OpenedTwiceAtOnce) {
  Journal first(file_, "a", 7);
  EXPECT_NE(refusal_of_opening().find("it is in use by another process"), std::string::npos);
  append(first, 200);
  const pid_t child = ::fork();  // another process, which has no connection of its own yet
  if (child == 0) {
    try {
      const Journal second(file_, "a", 8);
    } catch (const InputError& error) {
      ::_exit(error.reason().find("in use") != std::string::npos ? 0 : 1);
    }
    ::_exit(2);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  append(first, 0);
  first = Journal(folder_.path() / "other.journal", "a", 7);
  expect_whole();
}

TEST_F(JournalFaults, CutAnywhereItIsRefused) {
  make();
  const std::string whole = folder_.read("a.journal");
  ASSERT_GT(whole.size(), 20u * 4096);
  // SQLite takes a single byte for an empty file.
  for (std::size_t size = 2; size < whole.size(); size += size < 200 ? 7 : 1531) {
    folder_.write("a.journal", whole.substr(0, size));
    refusal_of_opening();
    EXPECT_EQ(std::filesystem::file_size(file_), size);
  }
  folder_.write("a.journal", whole);
  expect_whole();
}

TEST_F(JournalFaults, AChangedByteIsRefusedOrChangesNothing) {
  make();
  const std::string whole = folder_.read("a.journal");
  std::mt19937 random(1);
  std::size_t refused = 0;
  for (int k = 0; k < 400; ++k) {
    std::string bytes = whole;
    const std::size_t at = std::uniform_int_distribution<std::size_t>(0, whole.size() - 1)(random);
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (k % 8)));
    folder_.write("a.journal", bytes);
    try {
      const Journal journal(file_, "a", 8);
      ASSERT_EQ(journal.own_records(), 200u) << "byte " << at;
      ASSERT_EQ(journal.life(), 7u);
      expect_known_contents(journal);
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 200u);
}

/// After a kill, the last commits are in the write-ahead log.
TEST_F(JournalFaults, ADamagedLogOfAKilledRobotCostsATailAndNeverChangesARecord) {
  const pid_t child = ::fork();
  if (child == 0) {
    Journal journal(file_, "a", 7);
    for (int k = 0; k < 40; ++k) append(journal, 5);
    ::kill(::getpid(), SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  const std::string main = folder_.read("a.journal"), log = folder_.read("a.journal-wal");
  ASSERT_GT(log.size(), 40u * 4096);
  std::mt19937 random(1);
  const auto any_place = [&] {
    return std::uniform_int_distribution<std::size_t>(0, log.size() - 1)(random);
  };
  for (int k = 0; k < 100; ++k) {
    std::string bytes = log.substr(0, k % 2 == 0 ? log.size() : any_place());
    if (k % 2 == 0) bytes[any_place()] ^= 0x10;
    folder_.write("a.journal", main);
    folder_.write("a.journal-wal", bytes);
    try {
      const Journal journal(file_, "a", 8);
      ASSERT_LE(journal.own_records(), 200u);
      ASSERT_TRUE(journal.is_new() || journal.life() == 7);
      expect_known_contents(journal);
    } catch (const InputError& error) {
      ASSERT_EQ(error.file(), file_.string());
    }
  }
  folder_.write("a.journal", main);
  folder_.write("a.journal-wal", log);
  expect_whole();
}

/// Appends until it fails, with the line of the failure, then as before.
void fill_up(const std::filesystem::path& file, const std::string& words,
             const std::function<void()>& make_room) {
  Journal journal(file, "a", 7);
  append(journal, 20);
  std::string line;
  while (line.empty() && journal.own_records() < 100'000) {
    try {
      append(journal, 20);
    } catch (const InputError& error) {
      line = error.what();
    }
  }
  EXPECT_NE(line.find(words), std::string::npos) << line;
  const std::uint64_t kept = journal.own_records();
  EXPECT_EQ(kept % 20, 0u);
  expect_known_contents(journal);
  make_room();
  append(journal, 20);
  EXPECT_EQ(journal.own_records(), kept + 20);
  expect_known_contents(journal);
}

TEST_F(JournalFaults, AFileThatMayNotGrowKeepsWhatItHas) {
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{300'000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  fill_up(file_, file_.string() + ": the journal cannot be used: disk I/O error",
          [&] { ::setrlimit(RLIMIT_FSIZE, &before); });
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  const Journal again(file_, "a", 8);
  EXPECT_EQ(again.life(), 7u);
  expect_known_contents(again);
}

TEST_F(JournalFaults, AFullDiskKeepsWhatItHas) {
  // In a process with mounts of its own, so that nobody else sees the small disk.
  const pid_t child = ::fork();
  if (child == 0) {
    const bool may_mount = ::unshare(CLONE_NEWNS) == 0 || ::unshare(CLONE_NEWUSER | CLONE_NEWNS) == 0;
    if (!may_mount || ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        ::mount("tmpfs", folder_.path().c_str(), "tmpfs", 0, "size=512k") != 0)
      ::_exit(77);
    folder_.write("ballast", std::string(100'000, 'x'));
    fill_up(file_, file_.string() + ": the journal cannot be used: database or disk is full",
            [&] { std::filesystem::remove(folder_.path() / "ballast"); });
    const Journal again(file_, "a", 8);
    EXPECT_EQ(again.life(), 7u);
    expect_known_contents(again);
    ::_exit(HasFailure() ? 1 : 0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "no small disk can be mounted here";
  EXPECT_EQ(status, 0);
}

}  // namespace
}  // namespace radioslam
