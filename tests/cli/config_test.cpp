#include "radioslam/cli/config.hpp"

#include <gtest/gtest.h>

namespace radioslam::cli {
namespace {

std::vector<Setting> parse(const std::string& content) { return parse_config({"run.yaml", content}); }

std::string refusal(const std::string& content) {
  try {
    parse(content);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Config, NestedMapsBecomeDottedKeysWithTheirLines) {
  const auto settings = parse("# how to run\nkeyframe:\n  distance_m: 2\n\nradio: {measure: slide}\n");
  ASSERT_EQ(settings.size(), 2U);
  EXPECT_EQ(settings[0].key, "keyframe.distance_m");
  EXPECT_EQ(settings[0].value, "2");
  EXPECT_EQ(settings[0].origin, "run.yaml");
  EXPECT_EQ(settings[0].line, 3U);
  EXPECT_EQ(settings[1].key, "radio.measure");
  EXPECT_EQ(settings[1].line, 5U);
}

TEST(Config, EmptySectionsSetNothing) {
  EXPECT_TRUE(parse("# nothing\n").empty());
  EXPECT_TRUE(parse("keyframe:\n").empty());
}

TEST(Config, AnythingButMapsIsRefused) {
  EXPECT_EQ(refusal("- 1\n- 2\n"), "run.yaml:1: the file must hold 'name: value' lines");
  EXPECT_EQ(refusal("just words\n"), "run.yaml:1: the file must hold 'name: value' lines");
  EXPECT_EQ(refusal("a: 1\nb: [1, 2]\n"), "run.yaml:2: 'b' must hold 'name: value' lines");
}

TEST(Config, TruncatedYamlIsRefusedWithItsLine) {
  EXPECT_EQ(refusal("keyframe:\n  distance_m: [1\n").substr(0, 11), "run.yaml:3:");
  EXPECT_EQ(refusal("a: 1\n\tb: 2\n").substr(0, 11), "run.yaml:2:");
}

TEST(Config, EndlessAliasesAreRefused) {
  EXPECT_NE(refusal("a: &x\n  b: *x\n").find("nested too deep"), std::string::npos);
  EXPECT_EQ(parse("a: &x {b: 1}\nc: *x\n").size(), 2U);
  std::string aliases = "l0: &l0 {a: {}, b: {}, c: {}, d: {}, e: {}, f: {}, g: {}, h: {}}\n";
  for (int level = 1; level < 8; ++level) {
    const std::string name = "l" + std::to_string(level), below = "*l" + std::to_string(level - 1);
    aliases += name + ": &" + name + " {";
    for (const char key : std::string("abcdefgh")) aliases += std::string(1, key) + ": " + below + ", ";
    aliases += "i: {}}\n";
  }
  EXPECT_NE(refusal(aliases).find("more than 10000 entries"), std::string::npos) << refusal(aliases);
}

TEST(Config, AKeyMayAppearOnce) {
  EXPECT_EQ(refusal("a:\n  b: 1\na.b: 2\n"), "run.yaml:3: 'a.b' appears twice, first in line 2");
  EXPECT_EQ(refusal("a: 1\na: 2\n"), "run.yaml:2: 'a' appears twice, first in line 1");
}

TEST(Config, SetOptionsAreSplitAtTheFirstEqualsSign) {
  const auto setting = parse_set_option("a.b=c=d");
  EXPECT_EQ(setting.key, "a.b");
  EXPECT_EQ(setting.value, "c=d");
  EXPECT_THROW(parse_set_option("a.b"), InputError);
  EXPECT_THROW(parse_set_option("=1"), InputError);
}

TEST(Config, OptionsComeAfterTheFile) {
  const auto settings = collect_settings("", {"a=1", "a=2"});
  ASSERT_EQ(settings.size(), 2U);
  EXPECT_EQ(settings[1].value, "2");
  EXPECT_THROW(collect_settings("no-such-file.yaml", {}), InputError);
}

}  // namespace
}  // namespace radioslam::cli
