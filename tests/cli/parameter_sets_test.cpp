#include "radioslam/cli/parameter_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "cli/process.hpp"
#include "radioslam/cli/import/import_kinds.hpp"
#include "radioslam/sim/scenarios/scenarios.hpp"

namespace radioslam::cli {
namespace {

constexpr std::size_t kMaxHelpLength = 160;

std::string refusal_of_set(const std::string& name) {
  try {
    parameter_set(name);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string first_word(const std::string& text) {
  std::string word;
  for (const char c : text) {
    if (std::isalpha(static_cast<unsigned char>(c)) == 0) break;
    word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return word;
}

/// Whether the text can be read without the lines around it.
bool stands_alone(const std::string& help) {
  const std::vector<std::string> links{"likewise", "nor", "and", "or", "of", "them"};
  const std::string word = first_word(help);
  if (word.empty() || std::find(links.begin(), links.end(), word) != links.end()) return false;
  if (word == "in" && first_word(help.substr(std::min(help.size(), std::size_t{3}))) == "them") return false;
  return help.find("; ours") == std::string::npos && help.find("the seed's") == std::string::npos;
}

TEST(ParameterSets, EveryHelpTextStandsAlone) {
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    for (const auto& parameter : describe_parameters(set.defaults().parameters)) {
      EXPECT_TRUE(stands_alone(parameter.description)) << set.call << ": " << parameter.key;
      EXPECT_LE(parameter.description.size(), kMaxHelpLength) << set.call << ": " << parameter.key;
    }
  }
}

TEST(ParameterSets, NoKeyAppearsTwice) {
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    std::vector<std::string> keys;
    for (const ParameterRef& parameter : set.defaults().parameters) keys.push_back(parameter.key);
    std::sort(keys.begin(), keys.end());
    EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end()) << set.call;
  }
}

TEST(ParameterSets, EveryDefaultIsAllowed) {
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    const auto defaults = set.defaults();
    for (const auto& parameter : describe_parameters(defaults.parameters)) {
      const Setting setting{parameter.key, parameter.default_value, "default", 0};
      EXPECT_NO_THROW(apply_settings(defaults.parameters, {setting})) << set.call << ": " << parameter.key;
    }
  }
}

TEST(ParameterSets, LongOnesHaveAFewBasicParameters) {
  for (const ParameterSet& set : parameter_sets()) {
    if (set.defaults == nullptr) continue;
    const auto parameters = describe_parameters(set.defaults().parameters);
    const auto basic = std::count_if(parameters.begin(), parameters.end(), [](const auto& parameter) {
      return parameter.level == Field::Level::kBasic;
    });
    if (parameters.size() <= 20) continue;
    EXPECT_GE(basic, 8) << set.call;
    EXPECT_LE(basic, set.name() == "run" || set.name() == "prune" ? 50 : 15) << set.call;
  }
}

TEST(ParameterSets, CoverScenariosImportsAndTables) {
  for (const Scenario& scenario : scenarios())
    EXPECT_EQ(parameter_set("simulate " + std::string(scenario.name)).name(), scenario.name);
  for (const ImportKind& kind : import_kinds()) {
    const auto taken = std::find(kind.options.begin(), kind.options.end(), ImportOption::kParameters);
    const std::string refused = refusal_of_set(std::string("import ") + kind.name);
    EXPECT_EQ(taken == kind.options.end(), refused.ends_with("this import has no parameters")) << kind.name;
    EXPECT_EQ(taken != kind.options.end(), refused.empty()) << kind.name << ": " << refused;
  }
  const TemporaryFolder folder;
  std::istringstream tables(run({"reproduce"}, folder.path()).out);
  int found = 0;
  for (std::string line; std::getline(tables, line);) {
    if (!line.starts_with("  ")) continue;
    const std::string refused = refusal_of_set("reproduce " + line.substr(2, line.find(':') - 2));
    EXPECT_TRUE(refused.empty() || refused.ends_with("this table has no parameters")) << refused;
    ++found;
  }
  EXPECT_EQ(found, 14);
}

TEST(ParameterSets, AreFoundByCallAndByName) {
  EXPECT_EQ(parameter_set("city").call, "simulate city");
  EXPECT_EQ(parameter_set("aoa").call, "aoa");
  EXPECT_EQ(parameter_set("reproduce aoa").call, "reproduce aoa");
  EXPECT_EQ(parameter_set("kitti").call, "simulate kitti");
  EXPECT_EQ(refusal_of_set("import kitti"), "parameters import kitti: this import has no parameters");
  EXPECT_EQ(refusal_of_set("evaluate"), "parameters evaluate: this command has no parameters");
  EXPECT_EQ(refusal_of_set("overlap-growth"), "parameters overlap-growth: this table has no parameters");
  EXPECT_EQ(
      refusal_of_set("citty"),
      "parameters citty: unknown command, scenario, kind of import or table; did you mean city or kitti?");
}

TEST(ParameterSets, ATableHasItsOwnDefaults) {
  const auto own = describe_parameters(parameter_set("wi-closure-kitti").defaults().parameters);
  const auto scenario = describe_parameters(parameter_set("kitti").defaults().parameters);
  ASSERT_EQ(own.size(), scenario.size());
  bool differs = false;
  for (std::size_t k = 0; k < own.size(); ++k) {
    EXPECT_EQ(own[k].key, scenario[k].key);
    differs = differs || own[k].default_value != scenario[k].default_value;
  }
  EXPECT_TRUE(differs);
}

TEST(ParameterSets, OnesThatAreAlikeHaveTheSameNames) {
  for (const ParameterSet& set : parameter_sets()) {
    if (set.like.empty()) continue;
    const auto own = set.defaults().parameters,
               other = parameter_set(std::string(set.like)).defaults().parameters;
    ASSERT_EQ(own.size(), other.size()) << set.call;
    for (std::size_t k = 0; k < own.size(); ++k) EXPECT_EQ(own[k].key, other[k].key) << set.call;
  }
}

}  // namespace
}  // namespace radioslam::cli
