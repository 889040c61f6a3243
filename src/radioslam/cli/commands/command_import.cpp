// radioslam import: converts recordings of other tools and data sets to a mission folder or a table of one.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iomanip>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/import/import_kinds.hpp"
#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {
namespace {

// Help pages of `radioslam import`: one that lists all kinds of source, and one for each kind.

std::string list_of_kinds() {
  constexpr int kNameWidth = 18;
  std::ostringstream list;
  list << "Kinds of source:\n";
  for (const ImportKind& kind : import_kinds())
    list << "  " << std::left << std::setw(kNameWidth) << kind.name << kind.summary << '\n';
  list << "\n`radioslam import KIND --help` describes a kind with its options and an example.\n\n"
          "Examples:\n";
  for (const char* name : {"rosbag", "kitti", "iw"})
    list << "  " << find_import_kind(name)->examples.back() << '\n';
  std::string text = list.str();
  text.pop_back();
  return text;
}

std::string footer_of(const ImportKind& kind) {
  std::string footer = kind.notes;
  for (const ImportOption option : kind.options)
    if (option == ImportOption::kParameters)
      footer += std::string("\n\n`radioslam parameters ") + kind.name +
                "` lists the parameters for --set and --config.";
  footer += kind.examples.size() == 1 ? "\n\nExample:" : "\n\nExamples:";
  for (const std::string& example : kind.examples) footer += "\n  " + example;
  return footer;
}

/// The page of `radioslam import KIND --help`: what the kind reads, its options, notes and examples.
std::string help_page(const ImportKind& kind, std::size_t column_width) {
  ImportOptions unused;
  CLI::App page(std::string("Import ") + kind.summary, std::string("radioslam import ") + kind.name);
  page.get_formatter()->column_width(column_width);
  add_common_options(page, unused);
  for (const ImportOption option : kind.options) add_import_option(page, unused, option);
  page.footer(footer_of(kind));
  return page.help();
}

/// Prints the page of the kind on the command line, or the command's own page without a known kind.
class ImportFormatter : public CLI::Formatter {
 public:
  explicit ImportFormatter(const ImportOptions& options) : options_(options) {}

  std::string make_help(const CLI::App* command, std::string name, CLI::AppFormatMode mode) const override {
    if (const ImportKind* kind = find_import_kind(options_.kind)) return help_page(*kind, column_width_);
    return CLI::Formatter::make_help(command, std::move(name), mode);
  }

 private:
  const ImportOptions& options_;
};

/// Gives `command` both help pages; `options.kind`, which must outlive it, selects one of them.
void set_import_help(CLI::App& command, const ImportOptions& options) {
  const auto formatter = std::make_shared<ImportFormatter>(options);
  formatter->column_width(command.get_formatter()->get_column_width());
  command.formatter(formatter);
  command.footer(list_of_kinds());
}

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
