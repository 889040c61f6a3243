#include "radioslam/base/suggestion.hpp"

#include <gtest/gtest.h>

namespace radioslam {
namespace {

TEST(Suggestion, DistanceCountsInsertionsDeletionsSubstitutionsAndSwaps) {
  EXPECT_EQ(edit_distance("run", "run"), 0U);
  EXPECT_EQ(edit_distance("rnu", "run"), 1U);
  EXPECT_EQ(edit_distance("ru", "run"), 1U);
  EXPECT_EQ(edit_distance("rune", "run"), 1U);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
}

TEST(Suggestion, NamesTheNearestFirst) {
  const std::vector<std::string> names{"optimize", "run", "evaluate", "simulate"};
  EXPECT_EQ(nearest_names("optimise", names), std::vector<std::string>{"optimize"});
  EXPECT_EQ(did_you_mean("evalute", names), "; did you mean evaluate?");
  EXPECT_EQ(did_you_mean("frobnicate", names), "");
}

TEST(Suggestion, NothingInCommonIsNoSuggestion) { EXPECT_TRUE(nearest_names("ab", {"xy", "cd"}).empty()); }

TEST(Suggestion, AtMostThree) {
  EXPECT_EQ(did_you_mean("aa", {"ab", "ac", "ad", "ae"}), "; did you mean ab, ac or ad?");
}

}  // namespace
}  // namespace radioslam
