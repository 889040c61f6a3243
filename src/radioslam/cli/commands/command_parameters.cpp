// radioslam parameters: lists the parameters of a command with unit, range and default.
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/parameter_sets.hpp"

namespace radioslam::cli {
namespace {

struct ParametersOptions {
  std::vector<std::string> command{"run"};
  bool all = false;
  bool json = false;
  bool page = false;
};

std::string set_name(const ParametersOptions& options) {
  std::string name;
  for (const std::string& word : options.command) name += (name.empty() ? "" : " ") + word;
  return name;
}

const char* level_name(Field::Level level) { return level == Field::Level::kBasic ? "basic" : "expert"; }

nlohmann::ordered_json parameters_json(const std::vector<ParameterDescription>& parameters) {
  auto object = nlohmann::ordered_json::object();
  for (const auto& parameter : parameters) {
    object[parameter.key] = {{"default", parameter.default_value},
                             {"unit", parameter.unit},
                             {"range", parameter.range},
                             {"meaning", parameter.description},
                             {"level", level_name(parameter.level)}};
  }
  return object;
}

void print_parameters(const std::vector<ParameterDescription>& parameters, const std::string& name,
                      bool all) {
  const auto shown = all ? parameters : basic_parameters(parameters);
  std::cout << parameter_list_text(shown);
  const std::size_t hidden = parameters.size() - shown.size();
  if (hidden > 0) std::cout << "\n" << hidden << " more: radioslam parameters " << name << " --all\n";
}

void list_parameters(const ParametersOptions& options) {
  if (options.page) {
    std::cout << parameters_page();
    return;
  }
  const std::string name = set_name(options);
  const auto parameters = describe_parameters(parameter_set(name).defaults().parameters);
  if (options.json) {
    std::cout << parameters_json(parameters).dump(2) << '\n';
  } else {
    print_parameters(parameters, name, options.all);
  }
}

}  // namespace

void add_parameters(CLI::App& program) {
  const auto options = std::make_shared<ParametersOptions>();
  auto* command =
      program.add_subcommand("parameters", "List the parameters that --set and --config can change");
  command
      ->add_option(
          "COMMAND", options->command,
          "Command (default: run), scenario, kind of import or table, e.g. city, iw, aoa-paths; with "
          "the command before it where several have the same name: simulate kitti")
      ->expected(1, 2);
  command->add_flag("--all", options->all, "List all parameters; without it, long lists show the basic ones");
  command->add_flag("--page", options->page,
                    "Print all parameters of all commands as one page in Markdown, and nothing else");
  add_json_option(*command, options->json);
  command->footer(
      "Examples:\n"
      "  radioslam parameters\n"
      "  radioslam parameters run --all | less\n"
      "  radioslam parameters city --json");
  command->callback([options] { list_parameters(*options); });
}

}  // namespace radioslam::cli
