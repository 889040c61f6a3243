#include "radioslam/io/graph/team_ids.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "radioslam/io/graph/g2o_entries.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

using Id = std::uint64_t;
using Owners = std::map<Id, std::size_t>;

template <class Pose>
bool is_pose_tag(std::string_view tag) {
  return tag == G2oTags<Pose>::kVertex || tag == G2oTags<Pose>::kEdge;
}

/// The ids that a line names as those of poses: one of a VERTEX line, two of an edge, else none.
std::vector<Id> ids_of_line(const TextLines& lines) {
  LineFields fields(lines);
  std::vector<Id> ids;
  try {
    const std::string_view tag = fields.next("a tag");
    if (!is_pose_tag<SE2>(tag) && !is_pose_tag<SE3>(tag)) return {};
    ids.push_back(fields.id("id"));
    if (tag == G2oTags<SE2>::kEdge || tag == G2oTags<SE3>::kEdge) ids.push_back(fields.id("id"));
  } catch (const InputError&) {
    return {};
  }
  return ids;
}

/// The ids of one file.
struct FileIds {
  std::set<Id> declared;   ///< in VERTEX lines
  std::set<Id> steps;      ///< at the ends of edges between successive ids
  std::set<Id> mentioned;  ///< in edges
};

FileIds ids_of(const Text& text) {
  FileIds result;
  TextLines lines(text);
  while (lines.next_with_content()) {
    const std::vector<Id> ids = ids_of_line(lines);
    if (ids.size() == 1) result.declared.insert(ids[0]);
    if (ids.size() != 2) continue;
    result.mentioned.insert(ids.begin(), ids.end());
    if (std::max(ids[0], ids[1]) == std::min(ids[0], ids[1]) + 1) result.steps.insert(ids.begin(), ids.end());
  }
  return result;
}

/// The file of every id, if no two files have the same one and some file names one of another; else nothing.
/// A file without any of its own has only links between others' poses.
Owners owners_by(const std::vector<FileIds>& files, std::set<Id> FileIds::*own) {
  Owners owners;
  for (std::size_t k = 0; k < files.size(); ++k)
    for (const Id id : files[k].*own)
      if (!owners.emplace(id, k).second) return {};
  bool has_links = false;
  for (std::size_t k = 0; k < files.size(); ++k)
    for (const Id id : files[k].mentioned) {
      const auto owner = owners.find(id);
      has_links = has_links || (owner != owners.end() && owner->second != k);
      if (owner == owners.end() && (files[k].*own).empty()) return {};
    }
  return has_links ? owners : Owners();
}

bool has_letters(const std::vector<FileIds>& files) {
  return std::any_of(files.begin(), files.end(), [](const FileIds& file) {
    const auto is_beyond = [](const std::set<Id>& ids) {
      return !ids.empty() && *ids.rbegin() > kKeyPlaceMask;
    };
    return is_beyond(file.declared) || is_beyond(file.mentioned);
  });
}

}  // namespace

std::optional<std::uint64_t> id_without_letter(std::span<const std::uint64_t> ids) {
  const auto has_letter = [](Id id) { return is_key_letter(id >> kKeyRobotShift); };
  const auto has_none = [](Id id) { return id >> kKeyRobotShift == 0; };
  const auto without = std::find_if(ids.begin(), ids.end(), has_none);
  if (without == ids.end() || std::none_of(ids.begin(), ids.end(), has_letter)) return std::nullopt;
  return *without;
}

void refuse_missing_letter(const Text& text, std::uint64_t id) {
  TextLines lines(text);
  std::size_t line = 0;
  while (line == 0 && lines.next_with_content()) {
    const std::vector<Id> ids = ids_of_line(lines);
    if (std::find(ids.begin(), ids.end(), id) != ids.end()) line = lines.number();
  }
  text.fail(line,
            quoted_vertex(id) +
                " has no robot's letter in its id (top eight bits), but others of the team have one: the "
                "robots' letters are missing");
}

DividedIds::DividedIds(std::span<const Text> texts) {
  std::vector<FileIds> files;
  for (const Text& text : texts) files.push_back(ids_of(text));
  if (files.size() < 2 || has_letters(files)) return;
  file_of_ = owners_by(files, &FileIds::declared);
  if (file_of_.empty()) file_of_ = owners_by(files, &FileIds::steps);
}

std::optional<std::size_t> DividedIds::file_of(std::uint64_t id) const {
  const auto found = file_of_.find(id);
  return found == file_of_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace radioslam
