#include "radioslam/io/graph/team_graph_file.hpp"

#include <algorithm>

#include "radioslam/io/graph/g2o_team.hpp"
#include "radioslam/io/graph/jrl.hpp"
#include "radioslam/io/graph/pyfg.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

/// The extension, ignoring .zst.
std::string kind_of(const fs::path& path) {
  return (has_zstd_extension(path) ? path.stem() : path).extension().string();
}

/// The g2o files of a folder, sorted by number (2.g2o before 10.g2o), others by name.
std::vector<fs::path> g2o_files(const fs::path& folder) {
  std::vector<fs::path> files =
      files_in(folder, Depth::kFolder, [](const fs::path& file) { return kind_of(file) == ".g2o"; });
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    const std::string x = a.filename().string(), y = b.filename().string();
    return x.size() != y.size() ? x.size() < y.size() : x < y;
  });
  return files;
}

AnyTeamGraphFile read_files(const std::vector<fs::path>& files, StatedStarts starts,
                            RepairInformation repair) {
  std::vector<Text> texts;
  for (const fs::path& file : files) texts.push_back(read_zstd_text(file));
  return read_g2o_team(texts, starts, repair);
}

AnyTeamGraphFile read_any(const fs::path& path, StatedStarts starts, RepairInformation repair) {
  if (fs::is_directory(path)) {
    const std::vector<fs::path> files = g2o_files(path);
    if (files.empty()) throw InputError(path.string(), 0, "the folder has no .g2o files");
    return read_files(files, starts, repair);
  }
  const std::string kind = kind_of(path);
  if (kind == ".pyfg") return read_pyfg(read_zstd_text(path), starts);
  if (kind == ".jrl") return read_jrl(read_zstd_text(path), starts);
  if (kind == ".g2o") return read_files({path}, starts, repair);
  throw InputError(path.string(), 0, "is not a factor graph: its name ends in none of .g2o, .pyfg and .jrl");
}

AnyTeamGraphFile with_measurements(AnyTeamGraphFile any, const fs::path& path) {
  const bool is_measured = std::visit(
      [](const auto& file) { return file.team.graph.poses.size() < 2 || measures_anything(file.team.graph); },
      any);
  if (!is_measured) throw InputError(path.string(), 0, "nothing is measured between its poses: no edges");
  return any;
}

}  // namespace

bool is_graph_file(const fs::path& path) {
  const std::string kind = kind_of(path);
  return kind == ".g2o" || kind == ".pyfg" || kind == ".jrl";
}

bool is_graph_folder(const fs::path& path) {
  return fs::is_directory(path) && !fs::exists(path / "mission.yaml") && !g2o_files(path).empty();
}

AnyTeamGraphFile read_team_graph(const fs::path& path, StatedStarts starts, RepairInformation repair) {
  return with_measurements(read_any(path, starts, repair), path);
}

AnyTeamGraphFile read_team_graph(const std::vector<fs::path>& paths, StatedStarts starts,
                                 RepairInformation repair) {
  if (paths.size() == 1) return read_team_graph(paths.front(), starts, repair);
  for (const fs::path& path : paths)
    if (kind_of(path) != ".g2o" || fs::is_directory(path))
      throw InputError(path.string(), 0,
                       "is not a .g2o file: only these are read several at a time, a robot each");
  return with_measurements(read_files(paths, starts, repair), paths.front());
}

}  // namespace radioslam
