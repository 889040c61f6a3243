#pragma once

#include <CLI/App.hpp>

namespace radioslam::cli {

/// Registers `agent` with its options and its action.
void add_agent_options(CLI::App& program);

}  // namespace radioslam::cli
