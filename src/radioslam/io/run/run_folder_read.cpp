#include <algorithm>

#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/run/run_tables.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The member `key` of an object; null if there is none.
const Json& member(const Json& json, const char* key) {
  static const Json none;
  if (!json.is_object()) return none;
  const auto found = json.find(key);
  return found == json.end() ? none : *found;
}

std::vector<std::string> strings_in(const Text& text, const Json& list, const char* what) {
  std::vector<std::string> result;
  if (list.is_null()) return result;
  const auto is_string = [](const Json& entry) { return entry.is_string(); };
  if (!list.is_array() || !std::all_of(list.begin(), list.end(), is_string))
    text.fail(1, std::string(what) + " must be a list of robots");
  for (const Json& entry : list) result.push_back(entry.get<std::string>());
  return result;
}

void read_team_frame(const Text& text, RunFolder& run) {
  const Json& frame = member(run.summary, "team_frame");
  run.unplaced = strings_in(text, member(frame, "unplaced"), "unplaced");
  const Json& components = member(frame, "components");
  if (components.is_null()) return;
  if (!components.is_array()) text.fail(1, "components must be a list");
  for (const Json& entry : components) run.components.push_back({strings_in(text, entry, "a component")});
}

std::vector<std::string> robots_in_summary(const Text& text, const Json& summary) {
  const Json& robots = member(summary, "robots");
  if (!robots.is_object()) text.fail(1, "'robots' is missing");
  std::vector<std::string> ids;
  for (const auto& entry : robots.items()) ids.push_back(entry.key());
  return ids;
}

std::vector<std::string> robots_with_file(const fs::path& folder) {
  std::vector<std::string> ids;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && entry.path().extension() == ".tum")
      ids.push_back(entry.path().stem().string());
  std::sort(ids.begin(), ids.end());
  if (ids.empty())
    throw InputError(folder.string(), 0, "is not a run: it has no summary.json and no .tum file");
  return ids;
}

void read_trajectories(const fs::path& folder, const std::vector<std::string>& ids, RunFolder& run) {
  for (const std::string& id : ids) {
    EstimatedTrajectory& robot = run.robots.emplace_back();
    robot.id = id;
    if (id.find('/') != std::string::npos)
      throw InputError(folder.string(), 0, "the robot's id '" + id + "' contains a path");
    const bool unplaced = std::find(run.unplaced.begin(), run.unplaced.end(), id) != run.unplaced.end();
    const fs::path path = folder / (id + ".tum");
    if (!unplaced || fs::exists(path)) robot.poses = read_tum(read_text(path));
  }
}

/// The run searched for candidates if there are rows, or a count in its summary, or a file without a summary.
void read_candidates_of(const fs::path& folder, RunFolder& run) {
  if (!fs::exists(folder / "candidates.csv")) return;
  auto candidates = read_candidates(read_text(folder / "candidates.csv"), run.robots);
  const bool counted = !member(member(run.summary, "counts"), "candidates").is_null();
  if (!candidates.empty() || counted || run.summary.is_null()) run.candidates = std::move(candidates);
}

}  // namespace

Json read_json(const Text& text) {
  try {
    return Json::parse(text.content);
  } catch (const Json::parse_error& error) {
    const auto end =
        text.content.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.content.size()));
    const auto breaks = std::count(text.content.begin(), end, '\n');
    text.fail(1 + static_cast<std::size_t>(breaks), "not valid JSON");
  } catch (const Json::out_of_range&) {
    text.fail(0, "a number is too large for a double");  // the parser does not report the position
  }
}

RunFolder read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string(), 0, "no such run folder");
  RunFolder run;
  std::vector<std::string> ids;
  if (fs::exists(folder / "summary.json")) {
    const Text text = read_text(folder / "summary.json");
    run.summary = read_json(text);
    read_team_frame(text, run);
    ids = robots_in_summary(text, run.summary);
  } else {
    ids = robots_with_file(folder);
  }
  read_trajectories(folder, ids, run);
  read_candidates_of(folder, run);
  if (fs::exists(folder / "closures.csv"))
    run.closures = read_closures(read_text(folder / "closures.csv"), run.robots);
  if (fs::exists(folder / "aoa.csv"))
    run.aoa_measurements = read_measured_aoa(read_text(folder / "aoa.csv"), run.robots);
  if (fs::exists(folder / "uncertainty.csv"))
    read_uncertainty(read_text(folder / "uncertainty.csv"), run.robots);
  return run;
}

}  // namespace radioslam
