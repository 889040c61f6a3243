#include "radioslam/cli/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace radioslam::cli {
namespace {

struct WalkParams {
  double step_m = 0.7;
  int steps = 10;
  bool backwards = false;
  std::string gait = "walk";

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"step_m", "m", 0.1, 2, "length of a step"}, self.step_m);
    visit(Field{"steps", "", 1, 100, "number of steps"}, self.steps);
    visit(Field{"backwards", "", 0, 1, "whether to look back"}, self.backwards);
    visit(Field{"gait", "", 0, 0, "how to go", "walk|run"}, self.gait);
  }
};

struct TripParams {
  WalkParams there;
  WalkParams back;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("there", self.there);
    visit("back", self.back);
  }
};

Setting option_of(const std::string& key, const std::string& value) {
  return {key, value, "--set " + key + "=" + value, 0};
}

/// The error that with_settings reports for the setting; empty if it is accepted.
std::string refusal_of_setting(const Setting& setting) {
  try {
    with_settings(TripParams{}, {setting});
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Parameters, AreSetBySectionAndName) {
  const auto trip =
      with_settings(TripParams{}, {option_of("back.step_m", "1.5"), option_of("there.steps", "7"),
                                   option_of("there.backwards", "true"), option_of("back.gait", "run")});
  EXPECT_EQ(trip.back.step_m, 1.5);
  EXPECT_EQ(trip.there.step_m, 0.7);
  EXPECT_EQ(trip.there.steps, 7);
  EXPECT_TRUE(trip.there.backwards);
  EXPECT_EQ(trip.back.gait, "run");
}

TEST(Parameters, TheLastSettingWins) {
  EXPECT_EQ(with_settings(WalkParams{}, {option_of("steps", "7"), option_of("steps", "8")}).steps, 8);
}

TEST(Parameters, TheEndsOfTheRangeBelongToIt) {
  EXPECT_EQ(with_settings(WalkParams{}, {option_of("step_m", "2")}).step_m, 2);
  EXPECT_EQ(with_settings(WalkParams{}, {option_of("step_m", "0.1")}).step_m, 0.1);
}

TEST(Parameters, OutOfRangeIsRefusedWithRangeAndUnit) {
  EXPECT_EQ(refusal_of_setting(option_of("there.step_m", "2.5")),
            "--set there.step_m=2.5: '2.5' is not a number from 0.1 to 2 m");
  EXPECT_EQ(refusal_of_setting(option_of("there.steps", "0")),
            "--set there.steps=0: '0' is not a whole number from 1 to 100");
}

TEST(Parameters, MalformedValuesAreRefused) {
  for (const char* text : {"", "x", "1x", "nan", "inf", "-inf", "1e999", " 1", "1,5"}) {
    EXPECT_NE(refusal_of_setting(option_of("there.step_m", text)), "") << text;
  }
  for (const char* text : {"1.5", "99999999999999999999", "x", ""}) {
    EXPECT_NE(refusal_of_setting(option_of("there.steps", text)), "") << text;
  }
  EXPECT_NE(refusal_of_setting(option_of("there.backwards", "maybe")), "");
  EXPECT_EQ(refusal_of_setting(option_of("there.gait", "fly")),
            "--set there.gait=fly: 'fly' is not one of walk, run");
}

TEST(Parameters, AFileIsNamedWithItsLine) {
  EXPECT_EQ(refusal_of_setting({"there.steps", "0", "trip.yaml", 4}),
            "trip.yaml:4: 'there.steps: 0' is not a whole number from 1 to 100");
}

TEST(Parameters, AnUnknownNameIsRefusedWithSuggestions) {
  EXPECT_EQ(
      refusal_of_setting(option_of("there.stpes", "3")),
      "--set there.stpes=3: unknown parameter 'there.stpes'; did you mean there.steps or there.step_m?");
  EXPECT_EQ(refusal_of_setting(option_of("gait", "run")),
            "--set gait=run: unknown parameter 'gait'; did you mean back.gait or there.gait?");
}

TEST(Parameters, EffectiveParametersMarkChanges) {
  TripParams trip;
  trip.back.step_m = 0.8;
  const auto list = effective_parameters(trip);
  ASSERT_EQ(list.size(), 8U);
  EXPECT_EQ(list[0].key, "there.step_m");
  EXPECT_EQ(list[0].value, "0.7");
  EXPECT_EQ(list[0].unit, "m");
  EXPECT_FALSE(list[0].changed);
  EXPECT_EQ(list[4].key, "back.step_m");
  EXPECT_EQ(list[4].value, "0.8");
  EXPECT_TRUE(list[4].changed);
}

TEST(Parameters, TextsReadBackAsTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 123456789.125, std::nextafter(1.0, 2.0)}) {
    const Field field{"x", "", -1e300, 1e300, ""};
    EXPECT_EQ(parse_value<double>(field, option_of("x", value_text(value))), value);
  }
}

TEST(Parameters, TheListShowsUnitRangeDefaultAndDescription) {
  const auto list = describe_parameters<WalkParams>();
  const std::string text = parameter_list_text({list.front()});
  EXPECT_EQ(text, "step_m = 0.7 m   [0.1 to 2]\n    length of a step\n");
  EXPECT_EQ(list[3].range, "walk, run");
}

}  // namespace
}  // namespace radioslam::cli
