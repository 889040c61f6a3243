// The command of the program radioslam-reproduce: published tables and the project's own studies.
#pragma once

#include <CLI/App.hpp>

namespace radioslam::cli {

/// Registers `reproduce TABLE` with its options and its action.
void add_tables(CLI::App& program);

}  // namespace radioslam::cli
