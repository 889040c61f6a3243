#include "radioslam/study/study_table.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace radioslam {
namespace {

TEST(NumberText, GroupsThousands) {
  EXPECT_EQ(number_text(1099101, 0), "1,099,101");
  EXPECT_EQ(number_text(999, 0), "999");
  EXPECT_EQ(number_text(-1234.5, 1), "-1,234.5");
  EXPECT_EQ(number_text(-123, 0), "-123");
  EXPECT_EQ(number_text(0.0561, 3), "0.056");
  EXPECT_EQ(number_text(std::nullopt, 0), "–");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN(), 0), "–");
}

TEST(PercentText, IsOfOneHundred) {
  EXPECT_EQ(percent_text(0.65494, 1), "65.5 %");
  EXPECT_EQ(percent_text(std::nullopt, 1), "–");
}

TEST(MedianOf, IsTheMiddle) {
  EXPECT_EQ(median_of({3, 1, 2}), 2);
  EXPECT_EQ(median_of({4, 1, 2, 3}), 2.5);
  EXPECT_FALSE(median_of({}));
}

TEST(TableText, AlignsColumnsByWhatIsSeen) {
  const StudyTable table{
      "Title", "Lead.", {"one", "two"}, {{"label", {"–", "22,222"}}, {"é", {"1", "–"}}}, {}};
  std::istringstream lines(table_text(table));
  std::string line, seen;
  for (int skipped = 0; skipped < 3; ++skipped) std::getline(lines, line);
  std::getline(lines, line);
  EXPECT_EQ(line, "       one     two");
  std::getline(lines, line);
  EXPECT_EQ(line, "label    –  22,222");
  std::getline(lines, line);
  EXPECT_EQ(line, "é        1       –");
}

TEST(TableText, WrapsNotesByWords) {
  StudyTable table{"Title", "Lead.", {}, {}, {}};
  std::string note;
  for (int word = 0; word < 60; ++word) note += "word ";
  table.notes = {note};
  std::istringstream lines(table_text(table));
  std::string line;
  std::size_t words = 0;
  while (std::getline(lines, line)) {
    EXPECT_LE(line.size(), 110U);
    for (auto at = line.find("word"); at != std::string::npos; at = line.find("word", at + 1)) ++words;
  }
  EXPECT_EQ(words, 60U);
}

TEST(TableCsv, QuotesItsTexts) {
  const StudyTable table{"T", "L", {"a,b"}, {{"say \"x\"", {"1,000"}}}, {}};
  EXPECT_EQ(table_csv(table), "\"what\",\"a,b\"\n\"say 'x'\",\"1,000\"\n");
}

TEST(StudyTable, SeedsWithoutAValueDoNotCount) {
  const std::vector<std::optional<double>> seeds{5, std::nullopt, 1, 2};
  const auto value = [](const std::optional<double>& seed) { return seed; };
  EXPECT_EQ(median_over(seeds, value), 2);
  EXPECT_FALSE(median_over(std::vector<std::optional<double>>{std::nullopt}, value));
}

TEST(StudyTable, SeedsAreNamed) {
  EXPECT_EQ(seeds_text(3, 1), "Seed 3");
  EXPECT_EQ(seeds_text(3, 5), "Medians of 5 seeds from 3 on");
}

}  // namespace
}  // namespace radioslam
