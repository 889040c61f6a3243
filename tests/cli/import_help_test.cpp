// Help pages of `radioslam import`.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "cli/process.hpp"
#include "radioslam/cli/import/import_kinds.hpp"

namespace radioslam::cli {
namespace {

std::string help_of(const std::vector<std::string>& arguments) {
  const TemporaryFolder folder;
  std::vector<std::string> call{"import"};
  call.insert(call.end(), arguments.begin(), arguments.end());
  call.emplace_back("--help");
  const Outcome outcome = run(call, folder.path());
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  return outcome.out;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

bool takes(const ImportKind& kind, ImportOption option) {
  return std::find(kind.options.begin(), kind.options.end(), option) != kind.options.end();
}

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 1) {
    end = text.find('\n', begin);
    longest = std::max(longest, (end == std::string::npos ? text.size() : end) - begin);
  }
  return longest;
}

TEST(ImportHelp, ListsEveryKindInOneLine) {
  const std::string page = help_of({});
  for (const ImportKind& kind : import_kinds()) {
    const std::string line_begin = std::string("\n  ") + kind.name + " ";
    ASSERT_TRUE(contains(page, line_begin)) << kind.name;
    const std::string line = page.substr(page.find(line_begin) + 1);
    EXPECT_TRUE(contains(line.substr(0, line.find('\n')), kind.summary)) << kind.name;
  }
}

TEST(ImportHelp, EveryKindHasAPageWithAnExample) {
  for (const ImportKind& kind : import_kinds()) {
    const std::string page = help_of({kind.name});
    EXPECT_TRUE(contains(page, kind.notes)) << kind.name;
    EXPECT_TRUE(contains(page, std::string("  radioslam import ") + kind.name + " ")) << kind.name;
    EXPECT_LE(longest_line(kind.notes), 105U) << kind.name;
  }
}

TEST(ImportHelp, APageShowsTheOptionsOfItsKindAndNoOthers) {
  for (const ImportKind& kind : import_kinds()) {
    const std::string page = help_of({kind.name});
    EXPECT_TRUE(contains(page, "--output")) << kind.name;
    EXPECT_EQ(contains(page, "  --robot"),
              takes(kind, ImportOption::kRobot) || takes(kind, ImportOption::kRobots));
    EXPECT_EQ(contains(page, "  --name"), takes(kind, ImportOption::kName)) << kind.name;
    EXPECT_EQ(contains(page, "  --fields"), takes(kind, ImportOption::kFields)) << kind.name;
    EXPECT_EQ(contains(page, "  --file-times"), takes(kind, ImportOption::kTime)) << kind.name;
    EXPECT_EQ(contains(page, "  --poses"), takes(kind, ImportOption::kPoses)) << kind.name;
    EXPECT_EQ(contains(page, "  --list"), takes(kind, ImportOption::kTopics)) << kind.name;
    EXPECT_EQ(contains(page, "  --set"), takes(kind, ImportOption::kParameters)) << kind.name;
  }
}

TEST(ImportHelp, TheParametersThatAPageMentionsExist) {
  const TemporaryFolder folder;
  for (const ImportKind& kind : import_kinds()) {
    if (!takes(kind, ImportOption::kParameters)) continue;
    EXPECT_EQ(run({"parameters", kind.name}, folder.path()).status, 0) << kind.name;
  }
}

TEST(ImportHelp, IsFoundWithUnderscoresAndAmongOtherArguments) {
  EXPECT_EQ(help_of({"iw_ftm"}), help_of({"iw-ftm"}));
  EXPECT_EQ(help_of({"-o", "mission", "kitti", "drive"}), help_of({"kitti"}));
  EXPECT_EQ(help_of({"unknown"}), help_of({}));
}

TEST(ImportHelp, OptionsOfOtherKindsAreRefused) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::vector<std::string>& arguments) {
    const Outcome outcome = run(arguments, folder.path());
    EXPECT_EQ(outcome.status, 2);
    return outcome.err;
  };
  EXPECT_EQ(refusal({"import", "iw", "log", "-o", "m", "--poses", "p"}),
            "radioslam: import iw: takes no --poses\n");
  EXPECT_EQ(refusal({"import", "wifine", "x", "-o", "m", "--set", "a=1"}),
            "radioslam: import wifine: takes no parameters\n");
  EXPECT_EQ(refusal({"import", "kitti", "x", "-o", "m", "--scans", "/points"}),
            "radioslam: import kitti: takes no ROS topics\n");
  EXPECT_EQ(refusal({"import", "pcap", "x", "-o", "m", "--robot", "a", "--robot", "b"}),
            "radioslam: import pcap: takes no second --robot\n");
}

}  // namespace
}  // namespace radioslam::cli
