// The kinds of source that `radioslam import` reads, with the text of their help pages.
#pragma once

#include <string>
#include <vector>

#include "radioslam/cli/import/import_options.hpp"

namespace radioslam::cli {

/// One kind of source.
struct ImportKind {
  const char* name;
  const char* summary;  ///< one line of the list of kinds
  void (*import)(const ImportOptions&);
  std::vector<ImportOption> options;  ///< taken besides the common ones
  std::string notes;                  ///< what is read and how, for the help page
  std::vector<std::string> examples;  ///< at least one command line
};

const std::vector<ImportKind>& import_kinds();

/// The kind of this name, with '_' accepted for '-'; null if there is none.
const ImportKind* find_import_kind(std::string name);

}  // namespace radioslam::cli
