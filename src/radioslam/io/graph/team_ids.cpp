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

constexpr std::size_t kMinRepeated = 3;
constexpr double kOtherMotion = 0.3;  // metres per metre of the longer step, or radians

template <class Pose>
bool differ(const Pose& a, const Pose& b) {
  const typename Pose::Tangent error = (a.inverse() * b).log();
  const double length_m = std::max(a.translation().norm(), b.translation().norm());
  return error.template head<Pose::kDim>().norm() > kOtherMotion * length_m ||
         error.template tail<Pose::kDof - Pose::kDim>().norm() > kOtherMotion;
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

template <class Pose>
SecondOdometry second_odometry(const PoseGraph<Pose>& graph, std::span<const std::uint64_t> ids) {
  std::map<Id, Pose> first;
  std::size_t repeated = 0, contradicting = 0;
  for (const auto& factor : graph.relative_poses) {
    const Id i = ids[factor.i.index()], j = ids[factor.j.index()];
    if (std::max(i, j) != std::min(i, j) + 1 || i > kKeyPlaceMask) continue;
    const Pose step = i < j ? factor.T_i_j : factor.T_i_j.inverse();
    const auto [known, is_first] = first.emplace(std::min(i, j), step);
    if (is_first) continue;
    ++repeated;
    if (differ(known->second, step)) ++contradicting;
  }
  if (repeated < kMinRepeated || 2 * repeated <= first.size()) return SecondOdometry::kNone;
  return 2 * contradicting > repeated ? SecondOdometry::kContradicts : SecondOdometry::kAgrees;
}

void refuse_second_odometry(const Text& text) {
  std::set<Id> steps;
  TextLines lines(text);
  while (lines.next_with_content()) {
    const std::vector<Id> ids = ids_of_line(lines);
    if (ids.size() != 2 || std::max(ids[0], ids[1]) != std::min(ids[0], ids[1]) + 1) continue;
    if (!steps.insert(std::min(ids[0], ids[1])).second)
      lines.fail(
          "most edges between successive ids appear twice, with different motions: these are poses of two "
          "robots, and the robots' letters are missing in the ids (top eight bits)");
  }
  text.fail(0, "the robots' letters are missing in the ids (top eight bits)");
}

DividedIds::DividedIds(std::span<const Text> texts) {
  if (texts.size() < 2) return;
  std::vector<FileIds> files;
  for (const Text& text : texts) files.push_back(ids_of(text));
  if (has_letters(files)) return;
  file_of_ = owners_by(files, &FileIds::declared);
  if (file_of_.empty()) file_of_ = owners_by(files, &FileIds::steps);
}

template SecondOdometry second_odometry(const PoseGraph<SE2>&, std::span<const std::uint64_t>);
template SecondOdometry second_odometry(const PoseGraph<SE3>&, std::span<const std::uint64_t>);

std::optional<std::size_t> DividedIds::file_of(std::uint64_t id) const {
  const auto found = file_of_.find(id);
  return found == file_of_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace radioslam
