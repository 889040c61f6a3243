#include "radioslam/cli/former_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <utility>

#include "radioslam/cli/parameter_sets.hpp"

namespace radioslam::cli {
namespace {

Setting option(std::string_view key, std::string value) {
  return {std::string(key), std::move(value), "--set", 0};
}

bool has_key(const std::vector<ParameterRef>& parameters, std::string_view key) {
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const ParameterRef& parameter) { return parameter.key == key; });
}

/// Every parameter as "key = value".
std::set<std::string> values_of(const std::vector<ParameterRef>& parameters) {
  std::set<std::string> values;
  for (const auto& parameter : effective_parameters(parameters, parameters))
    values.insert(parameter.key + " = " + parameter.value);
  return values;
}

std::string other_value(const Field&, bool value) { return value_text(!value); }
std::string other_value(const Field& field, double value) {
  return value_text(value == field.minimum ? field.maximum : field.minimum);
}
std::string other_value(const Field& field, int value) {
  return value_text(static_cast<int>(value == field.minimum ? field.maximum : field.minimum));
}
std::string other_value(const Field& field, const std::string& value) {
  const std::string first(field.choices.substr(0, field.choices.find('|')));
  return first == value ? std::string(field.choices.substr(field.choices.rfind('|') + 1)) : first;
}

/// A value that the parameter allows and does not have.
std::string other_value(const std::vector<ParameterRef>& parameters, std::string_view key) {
  const auto parameter = std::find_if(parameters.begin(), parameters.end(),
                                      [&](const ParameterRef& candidate) { return candidate.key == key; });
  return std::visit([&](const auto* value) { return other_value(parameter->field, *value); },
                    parameter->value);
}

/// The sets of parameters that there are.
std::vector<DefaultParameters> all_defaults() {
  std::vector<DefaultParameters> defaults;
  for (const ParameterSet& set : parameter_sets())
    if (set.defaults != nullptr) defaults.push_back(set.defaults());
  return defaults;
}

class FormerKeys : public testing::TestWithParam<FormerKey> {};

TEST_P(FormerKeys, SetTheParameterOfToday) {
  const auto [former, current] = GetParam();
  std::size_t commands = 0;
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    const DefaultParameters before = set.defaults(), by_former = set.defaults(), by_current = set.defaults();
    if (!has_key(before.parameters, current)) continue;
    const std::string value = other_value(before.parameters, current);
    apply_settings(by_former.parameters, {option(former, value)});
    apply_settings(by_current.parameters, {option(current, value)});
    EXPECT_NE(values_of(by_former.parameters), values_of(before.parameters)) << set.call;
    EXPECT_EQ(values_of(by_former.parameters), values_of(by_current.parameters)) << set.call;
    ++commands;
  }
  EXPECT_GT(commands, 0U) << "no command has " << current;
}

std::string test_name(const testing::TestParamInfo<FormerKey>& info) {
  std::string name = std::to_string(info.index) + "_" + std::string(info.param.former);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, FormerKeys,
                         testing::ValuesIn(all_former_keys().begin(), all_former_keys().end()), test_name);

/// scan_map.max_distance_spacings after the settings of a run.
std::string distance_after(const std::vector<Setting>& settings) {
  const auto run = parameter_set("run").defaults();
  apply_settings(run.parameters, settings);
  for (const auto& parameter : effective_parameters(run.parameters, run.parameters))
    if (parameter.key == "scan_map.max_distance_spacings") return parameter.value;
  return {};
}

TEST(FormerKey, IsNoKeyOfTodayInTheSameCommand) {
  for (const DefaultParameters& command : all_defaults())
    for (const auto& [former, current] : all_former_keys())
      EXPECT_FALSE(has_key(command.parameters, former) && has_key(command.parameters, current)) << former;
}

TEST(FormerKey, MeansOneParameterOfACommand) {
  for (const DefaultParameters& command : all_defaults()) {
    for (const FormerKey& key : all_former_keys()) {
      const auto keys = current_keys(key.former);
      const auto is_here = [&](std::string_view current) { return has_key(command.parameters, current); };
      EXPECT_LE(std::count_if(keys.begin(), keys.end(), is_here), 1) << key.former;
    }
  }
}

TEST(FormerKey, TheLastOfBothNamesWins) {
  const Setting former = option("scan_map.reach_spacings", "4");
  const Setting current = option("scan_map.max_distance_spacings", "5");
  EXPECT_EQ(distance_after({former, current}), "5");
  EXPECT_EQ(distance_after({current, former}), "4");
}

TEST(FormerKey, IsFoundInBothDirections) {
  EXPECT_EQ(current_keys("radio.trusted_way_m"), std::vector<std::string_view>{"radio.max_trusted_path_m"});
  EXPECT_TRUE(current_keys("keyframe.distance_m").empty());
  EXPECT_EQ(former_keys("min_sigma_m"), std::vector<std::string>{"least_sigma_m"});
}

TEST(FormerKey, OfAnotherCommandIsUnknown) {
  const auto carpark = parameter_set("carpark").defaults();
  EXPECT_THROW(apply_settings(carpark.parameters, {option("scan_map.reach_spacings", "4")}), InputError);
}

TEST(FormerKey, ARefusedValueIsReportedUnderTheNameAsWritten) {
  const auto run = parameter_set("run").defaults();
  try {
    apply_settings(run.parameters, {{"scan_map.reach_spacings", "-1", "run.yaml", 3}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'scan_map.reach_spacings: -1'"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace radioslam::cli
