// Help pages of `radioslam import`: one that lists all kinds of source, and one for each kind.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "radioslam/cli/import/import_kinds.hpp"

namespace radioslam::cli {

/// The page of `radioslam import KIND --help`: what the kind reads, its options, notes and examples.
std::string help_page(const ImportKind& kind, std::size_t column_width);

/// Gives `command` both help pages; `options.kind`, which must outlive it, selects one of them.
void set_import_help(CLI::App& command, const ImportOptions& options);

}  // namespace radioslam::cli
