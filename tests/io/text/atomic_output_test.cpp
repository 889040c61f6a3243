#include "radioslam/io/text/atomic_output.hpp"

#include <system_error>

#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(OutputFolder, AppearsAtOnce) {
  const TemporaryFolder folder;
  OutputFolder output(folder.path() / "out", kRunFolder);
  write_file(output.path() / "summary.json", "{}");
  write_file(output.path() / "deep/er/a.tum", "a");
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  output.commit();
  EXPECT_EQ(folder.read("out/deep/er/a.tum"), "a");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(OutputFolder, ReplacesAnOlderOneAsAWhole) {
  const TemporaryFolder folder;
  folder.write("out/summary.json", "old");
  folder.write("out/stale/file", "old");
  {
    OutputFolder output(folder.path() / "out/", kRunFolder);
    write_file(output.path() / "summary.json", "new");
    EXPECT_EQ(folder.read("out/summary.json"), "old");
    output.commit();
  }
  EXPECT_EQ(folder.read("out/summary.json"), "new");
  EXPECT_FALSE(fs::exists(folder.path() / "out/stale"));
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(OutputFolder, LeavesNothingUnfinished) {
  const TemporaryFolder folder;
  folder.write("out/summary.json", "old");
  try {
    OutputFolder output(folder.path() / "out", kRunFolder);
    write_file(output.path() / "summary.json", "half");
    throw std::runtime_error("something broke");
  } catch (const std::runtime_error&) {
  }
  EXPECT_EQ(folder.read("out/summary.json"), "old");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(OutputFolder, MakesTheFoldersAboveAndTakesThemBack) {
  const TemporaryFolder folder;
  { OutputFolder output(folder.path() / "a/b/out", kRunFolder); }
  EXPECT_EQ(entries(folder.path()), 0u);
  OutputFolder(folder.path() / "a/b/out", kRunFolder).commit();
  EXPECT_TRUE(fs::is_directory(folder.path() / "a/b/out"));
}

TEST(OutputFolder, ReplacesAnEmptyFolderAndOneBehindALink) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "real");
  fs::create_directory_symlink("real", folder.path() / "link");
  OutputFolder output(folder.path() / "link", kRunFolder);
  write_file(output.path() / "summary.json", "new");
  output.commit();
  EXPECT_TRUE(fs::is_symlink(folder.path() / "link"));
  EXPECT_EQ(folder.read("real/summary.json"), "new");
}

TEST(OutputFolder, RefusesWhatIsNotItsToReplace) {
  const TemporaryFolder folder;
  folder.write("precious/data.txt", "x");
  folder.write("mission/mission.yaml", "x");
  folder.write("file", "x");
  const auto open = [&](const char* name) { OutputFolder(folder.path() / name, kRunFolder).commit(); };
  expect_refusal([&] { open("precious"); }, 0, "is not replaced");
  expect_refusal([&] { open("mission"); }, 0, "no summary.json");
  expect_refusal([&] { open("file"); }, 0, "is a file");
  expect_refusal([&] { open("file/below"); }, 0, "cannot be written");
  EXPECT_EQ(folder.read("precious/data.txt"), "x");
  EXPECT_EQ(entries(folder.path()), 3u);
}

TEST(OutputFile, AppearsAtOnceOrNotAtAll) {
  const TemporaryFolder folder;
  folder.write("graph.g2o", "old");
  { OutputFile unused(folder.path() / "graph.g2o"); }
  EXPECT_EQ(folder.read("graph.g2o"), "old");
  OutputFile(folder.path() / "graph.g2o").commit("new");
  EXPECT_EQ(folder.read("graph.g2o"), "new");
  OutputFile(folder.path() / "below/graph.g2o").commit("new");
  EXPECT_EQ(entries(folder.path()), 2u);
}

TEST(OutputFile, TakesPartsAndShowsNoneBeforeTheEnd) {
  const TemporaryFolder folder;
  folder.write("pairs.csv", "old");
  {
    OutputFile output(folder.path() / "pairs.csv");
    output.append("a\n");
    output.append("b\n");
    EXPECT_EQ(folder.read("pairs.csv"), "old");
    output.commit("c\n");
  }
  EXPECT_EQ(folder.read("pairs.csv"), "a\nb\nc\n");
  { OutputFile(folder.path() / "pairs.csv").append("half"); }
  EXPECT_EQ(folder.read("pairs.csv"), "a\nb\nc\n");
  EXPECT_EQ(entries(folder.path()), 1u);
}

TEST(OutputFile, RefusesAFolderAndADevice) {
  const TemporaryFolder folder;
  expect_refusal([&] { OutputFile output(folder.path()); }, 0, "is not a file");
  expect_refusal([&] { OutputFile output("/dev/null"); }, 0, "is not a file");
}

TEST(RemoveUnfinishedOutputs, RemovesThemAndKeepsTheOldOnes) {
  const TemporaryFolder folder;
  folder.write("out/summary.json", "old");
  const auto interrupted = [&] {
    OutputFolder output(folder.path() / "out", kRunFolder);
    OutputFile file(folder.path() / "a/b/graph.g2o");
    write_file(output.path() / "summary.json", "half");
    remove_unfinished_outputs();
    const bool clean = entries(folder.path()) == 1 && folder.read("out/summary.json") == "old";
    bool refused = false;
    try {
      output.commit();
    } catch (const std::system_error&) {
      refused = true;
    }
    std::_Exit(clean && refused ? 0 : 1);
  };
  EXPECT_EXIT(interrupted(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace radioslam
