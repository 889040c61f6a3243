// radioslam import: converts recordings of other tools and data sets to a mission folder or a table of one.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/import/import_help.hpp"
#include "radioslam/cli/import/import_kinds.hpp"
#include "radioslam/cli/import/import_options.hpp"
#include "radioslam/cli/suggestion.hpp"

namespace radioslam::cli {
namespace {

[[noreturn]] void refuse_kind(const std::string& name) {
  std::vector<std::string> names;
  for (const ImportKind& kind : import_kinds()) names.emplace_back(kind.name);
  throw InputError("import " + name, 0, "unknown kind of source" + did_you_mean(name, names));
}

void import_recordings(ImportOptions options) {
  std::replace(options.kind.begin(), options.kind.end(), '_', '-');
  if (!options.robots.empty()) options.robot = options.robots.front();
  if (options.output.empty() && !options.list) throw CLI::RequiredError("--output");
  const ImportKind* kind = find_import_kind(options.kind);
  if (kind == nullptr) refuse_kind(options.kind);
  refuse_other_options(options, kind->options);
  kind->import(options);
}

}  // namespace

void add_import(CLI::App& program) {
  const auto options = std::make_shared<ImportOptions>();
  auto* command = program.add_subcommand(
      "import", "Convert recordings of other tools and data sets to a mission, or to a table of one");
  command->add_option("KIND", options->kind, "Kind of source, see below")->required();
  add_all_import_options(*command, *options);
  set_import_help(*command, *options);
  command->callback([options] { import_recordings(*options); });
}

}  // namespace radioslam::cli
