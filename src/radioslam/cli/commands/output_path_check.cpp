#include "radioslam/cli/commands/output_path_check.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "radioslam/base/input_error.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

/// The path with symbolic links resolved, or only normalised if that is not permitted.
fs::path place_of(const std::string& path) {
  std::error_code error;
  const fs::path place = fs::weakly_canonical(fs::absolute(path), error);
  if (error) return fs::absolute(path).lexically_normal();
  return place.has_filename() ? place : place.parent_path();
}

bool is_at_or_in(const fs::path& place, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), place.begin(), place.end()).first == folder.end();
}

}  // namespace

void refuse_replacing_inputs(const std::string& output, const std::vector<std::string>& inputs) {
  if (output.empty()) return;
  const fs::path target = place_of(output);
  for (const std::string& input : inputs) {
    if (input.empty() || !is_at_or_in(place_of(input), target)) continue;
    throw InputError(output, 0,
                     place_of(input) == target ? "is also an input: it would be replaced"
                                               : "would be replaced, but contains the input " + input);
  }
}

}  // namespace radioslam::cli
