#include "radioslam/base/scratch_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "radioslam/base/input_error.hpp"

namespace radioslam {
namespace {

std::string read(const ScratchFile& file, std::uint64_t begin, std::size_t size) {
  std::string bytes(size, '\0');
  file.read(begin, bytes);
  return bytes;
}

std::string refusal_of_append(ScratchFile& file, std::string_view bytes) {
  try {
    file.append(bytes);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// $TMPDIR while it lives.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const char* folder) { ::setenv("TMPDIR", folder, 1); }
  ~TemporaryFolder() { ::unsetenv("TMPDIR"); }
};

/// No file grows beyond so many bytes while it lives: what a full disk is to a program.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit now{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &now);
  }
  ~FullDisk() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

TEST(ScratchFile, GivesBackWhatWasAppended) {
  ScratchFile file("");
  EXPECT_EQ(file.append("cloud"), 0U);
  EXPECT_EQ(file.append(std::string("\0store", 6)), 5U);
  EXPECT_EQ(read(file, 0, 5), "cloud");
  EXPECT_EQ(read(file, 5, 6), std::string("\0store", 6));
  EXPECT_EQ(read(file, 3, 3), std::string("ud\0", 3));
}

TEST(ScratchFile, HasNoName) {
  const std::string folder = ::testing::TempDir() + "scratch_file_test";
  std::filesystem::create_directories(folder);
  const TemporaryFolder temporary(folder.c_str());
  ScratchFile file("");
  file.append("cloud");
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  EXPECT_EQ(read(file, 0, 5), "cloud");
}

TEST(ScratchFile, NamesAFolderThatDoesNotExist) {
  const TemporaryFolder temporary("/does/not/exist");
  ScratchFile file("try another one");
  EXPECT_EQ(refusal_of_append(file, "cloud"),
            "/does/not/exist: a temporary file cannot be made: No such file or directory; try another one");
}

TEST(ScratchFile, SaysThatTheDiskIsFull) {
  const TemporaryFolder temporary(::testing::TempDir().c_str());
  ScratchFile file("more room helps");
  EXPECT_EQ(file.append("before"), 0U);
  {
    const FullDisk full(8);
    const std::string refusal = refusal_of_append(file, "too much");
    EXPECT_NE(refusal.find("a temporary file cannot be written: "), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("more room helps"), std::string::npos) << refusal;
  }
  EXPECT_EQ(read(file, 0, 6), "before");
}

}  // namespace
}  // namespace radioslam
