// Former names of parameters, which configurations written for version 0.1 use. They are accepted for one
// minor version.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace radioslam::cli {

/// A parameter's name in version 0.1 and now.
struct FormerKey {
  std::string_view former;
  std::string_view current;
};

/// Every name that has changed.
std::span<const FormerKey> all_former_keys();

/// What the parameters called `former` are called now; the same name can stand for different parameters of
/// different commands. Empty where there was no such name.
std::vector<std::string_view> current_keys(std::string_view former);

/// The former names of `current`.
std::vector<std::string> former_keys(std::string_view current);

}  // namespace radioslam::cli
