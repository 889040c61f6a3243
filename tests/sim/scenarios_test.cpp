#include "radioslam/sim/scenarios/scenarios.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace radioslam {
namespace {

TEST(Scenarios, AreFoundByName) {
  const Scenario* carpark = find_scenario("carpark");
  ASSERT_NE(carpark, nullptr);
  EXPECT_FALSE(carpark->description.empty());
  EXPECT_EQ(find_scenario("nowhere"), nullptr);
}

/// Every default is within its range, and no two parameters of a scenario have the same name.
TEST(Scenarios, HaveSoundDefaults) {
  for (const auto& scenario : scenarios()) {
    std::set<std::string_view> names;
    visit_scenario_fields(scenario.defaults, [&](const Field& field, const auto& value) {
      EXPECT_TRUE(names.insert(field.name).second) << field.name;
      EXPECT_FALSE(field.description.empty()) << field.name;
      if constexpr (std::is_arithmetic_v<std::decay_t<decltype(value)>>) {
        EXPECT_GE(static_cast<double>(value), field.minimum) << field.name;
        EXPECT_LE(static_cast<double>(value), field.maximum) << field.name;
      }
    });
    EXPECT_GT(names.size(), 10U);
  }
}

/// One parameter at a time at an end of its range, unless that only makes the mission long.
TEST(Scenarios, RunAtTheEndsOfTheirRanges) {
  const std::set<std::string_view> long_at_the_end{"robots",        "path_length_m",   "odometry_rate_hz",
                                                   "access_points", "shadowing_waves", "phones",
                                                   "scan_rate_hz",  "draws",           "truth_rate_hz"};
  ScenarioParams small = find_scenario("carpark")->defaults;
  auto& carpark = std::get<CarparkParams>(small);
  carpark.drive.path_length_m = 30;
  carpark.odometry.draws = 2;
  carpark.transmitters.access_points = 3;
  visit_scenario_fields(small, [&](const Field& field, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value>) {
      const Value before = value;
      for (const double end : {field.minimum, field.maximum}) {
        if (end == field.maximum && long_at_the_end.contains(field.name)) continue;
        value = static_cast<Value>(end);
        const auto [mission, truth] = simulate(small, 4);
        for (std::size_t r = 0; r < mission.robots.size(); ++r)
          for (const auto& [stamp, pose] : truth.robots[r].poses)
            ASSERT_TRUE(pose.translation().allFinite()) << field.name << " = " << end;
      }
      value = before;
    }
  });
}

TEST(Scenarios, RunWithWhatWasSet) {
  ScenarioParams params = find_scenario("carpark")->defaults;
  visit_scenario_fields(params, [](const Field& field, auto& value) {
    using Value = std::decay_t<decltype(value)>;
    if constexpr (std::is_arithmetic_v<Value>) {
      if (field.name == "robots") value = static_cast<Value>(1);
      if (field.name == "path_length_m") value = static_cast<Value>(20);
    }
  });
  const auto [mission, truth] = simulate(params, 3);
  EXPECT_EQ(mission.name, "carpark-3");
  EXPECT_EQ(mission.robots.size(), 1U);
  EXPECT_NEAR(mission.robots[0].odometry.back().stamp.seconds(), 50, 1e-9);
}

}  // namespace
}  // namespace radioslam
