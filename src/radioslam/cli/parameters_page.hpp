// The page docs/parameters.md: every parameter of every command, as tables in Markdown.
#pragma once

#include <string>

namespace radioslam::cli {

/// For each call of the program its basic parameters, then all of them by section; at the end the names of
/// version 0.1.
std::string parameters_page();

}  // namespace radioslam::cli
