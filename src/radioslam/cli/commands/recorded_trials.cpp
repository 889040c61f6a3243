#include "radioslam/cli/commands/recorded_trials.hpp"

#include <filesystem>
#include <optional>

#include "radioslam/base/input_error.hpp"

namespace radioslam::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kFoldersAbove = 2;

std::optional<fs::path> results_beside(const std::string& dataset) {
  fs::path place = fs::weakly_canonical(fs::absolute(dataset));
  for (int above = 0; above <= kFoldersAbove; ++above) {
    if (fs::path results = place / "2D-Displacement_output_files"; fs::is_directory(results)) return results;
    place = place.parent_path();
  }
  return std::nullopt;
}

}  // namespace

RecordedTrials find_trials(const std::string& call, const std::string& dataset, const std::string& authors) {
  if (dataset.empty()) throw InputError(call, 0, "needs recorded trials: --dataset DIR");
  RecordedTrials recorded{find_wsr_trials(dataset), {}};
  const auto results = authors.empty() ? results_beside(dataset) : std::optional<fs::path>(authors);
  if (results) recorded.published = read_wsr_results(*results);
  return recorded;
}

}  // namespace radioslam::cli
