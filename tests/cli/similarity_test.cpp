// radioslam similarity: the tables it writes.
#include <gtest/gtest.h>

#include <csignal>
#include <sstream>

#include "cli/process.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// A scan every ten seconds on the path along a row of access points and back.
std::string walk_along_access_points(int scans, std::uint64_t seed) {
  Rng rng(seed);
  std::ostringstream rows;
  rows << "t_s,bssid,frequency_mhz,rssi_dbm\n";
  for (int k = 0; k < scans; ++k) {
    const int place = k % 100 < 50 ? k % 100 : 99 - k % 100;
    for (int ap = std::max(0, place - 5); ap <= place + 5; ++ap)
      rows << 10 * k << ",ap" << ap << ",2412,"
           << -45 - 6 * std::abs(ap - place) - static_cast<int>(rng.below(4)) << '\n';
  }
  return rows.str();
}

class SimilarityCommand : public testing::Test {
 protected:
  SimilarityCommand() {
    write_file(path("a.csv"), walk_along_access_points(130, 1));
    write_file(path("b.csv"), walk_along_access_points(60, 2));
  }
  fs::path path(const std::string& name) const { return folder_.path() / name; }

  /// The rows of the table; also checks the program's output.
  std::vector<std::string> pairs(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "similarity");
    arguments.insert(arguments.end(), {"-o", "pairs.csv"});
    const Outcome outcome = run(arguments, folder_.path());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");  // not a terminal: no progress
    std::vector<std::string> lines;
    std::istringstream table(read_file(path("pairs.csv")));
    for (std::string line; std::getline(table, line);) lines.push_back(line);
    EXPECT_EQ(lines.front(), "t_i_s,t_j_s,similarity");
    lines.erase(lines.begin());
    EXPECT_NE(outcome.out.find(": " + std::to_string(lines.size()) + " pairs of "), std::string::npos);
    return lines;
  }

  TemporaryFolder folder_;
};

double similarity_in(const std::string& row) { return std::stod(row.substr(row.rfind(',') + 1)); }

TEST_F(SimilarityCommand, WithAMinimumWritesTheRowsThatReachIt) {
  for (const char* measure : {"cosine", "gaussian", "detection", "slide", "mended", "sorensen"}) {
    for (const std::vector<std::string>& inputs : {std::vector<std::string>{"a.csv"}, {"a.csv", "b.csv"}}) {
      auto arguments = inputs;
      arguments.insert(arguments.end(), {"--measure", measure});
      auto reaching = pairs(arguments);
      EXPECT_EQ(reaching.size(), inputs.size() == 1 ? 130U * 129 / 2 : 130U * 60) << measure;
      std::erase_if(reaching, [](const auto& row) { return similarity_in(row) < 0.05; });
      arguments.insert(arguments.end(), {"--min", "0.05"});
      EXPECT_EQ(pairs(arguments), reaching) << measure;
      EXPECT_FALSE(reaching.empty()) << measure;
    }
  }
}

TEST_F(SimilarityCommand, OrdersPairsByTimeAndWritesTheSameForAnyNumberOfThreads) {
  const auto alone = pairs({"a.csv", "--measure", "gaussian", "--min", "0.1", "--threads", "1"});
  const auto together = pairs({"a.csv", "--measure", "gaussian", "--min", "0.1", "--threads", "3"});
  EXPECT_EQ(alone, together);
  std::pair<double, double> last{-1, -1};
  for (const std::string& row : alone) {
    const std::pair<double, double> stamps{std::stod(row), std::stod(row.substr(row.find(',') + 1))};
    EXPECT_LT(stamps.first, stamps.second);
    EXPECT_LT(last, stamps);
    last = stamps;
  }
}

TEST_F(SimilarityCommand, AnInterruptionLeavesTheOlderTable) {
  write_file(path("long.csv"), walk_along_access_points(12000, 3));
  write_file(path("pairs.csv"), "older");
  const Outcome outcome = run({"similarity", "long.csv", "--measure", "cosine", "-o", "pairs.csv"},
                              folder_.path(), Interruption{SIGINT, 0.3});
  EXPECT_EQ(outcome.status, 130);
  EXPECT_EQ(read_file(path("pairs.csv")), "older");
  EXPECT_EQ(files_in(folder_.path()), (std::vector<std::string>{"a.csv", "b.csv", "long.csv", "pairs.csv"}));
}

}  // namespace
}  // namespace radioslam::cli
