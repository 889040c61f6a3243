#include "radioslam/io/graph/pyfg_vertices.hpp"

#include <cmath>
#include <set>
#include <utility>

#include "radioslam/io/graph/field_matrices.hpp"
#include "radioslam/io/graph/pyfg_tags.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxQuotedCharacters = 40;
constexpr double kMaxPyfgStamp_s = 9e9;  ///< year 2255; leaves room to separate equal stamps

bool is_robot_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Splits an id into letters and a number: robot and index.
PoseIndex place_of(const TextLines& lines, std::string_view name, Stamp stamp) {
  std::size_t letters = 0;
  while (letters < name.size() && is_robot_letter(name[letters])) ++letters;
  const auto place = parse_id(name.substr(letters));
  if (letters == 0 || letters > kMaxQuotedCharacters || !place)
    lines.fail("the pose's id " + quoted_pyfg_word(name) + " is not letters and a number");
  return {std::string(name.substr(0, letters)), *place, stamp};
}

template <class Pose>
class PyfgVertexReader {
 public:
  explicit PyfgVertexReader(const Text& text) : lines_(text) {}

  PyfgVertices<Pose> read() {
    while (lines_.next_with_content()) {
      LineFields fields(lines_);
      const std::string_view tag = fields.next("a tag");
      if (!is_pyfg_vertex<Pose>(tag)) continue;
      read_vertex(tag, fields);
      fields.end();
    }
    return std::move(out_);
  }

 private:
  void read_vertex(std::string_view tag, LineFields& fields) {
    const bool is_point = tag == PyfgTags<Pose>::kPoint;
    const Stamp stamp = is_point ? Stamp{} : fields.stamp("t");
    if (std::abs(stamp.seconds()) > kMaxPyfgStamp_s) lines_.fail("the time is not plausible");
    const std::string_view name = fields.next("id");
    add_name(name, is_point);
    if (is_point) {
      out_.point_names.emplace_back(name);
      out_.true_points.push_back(read_point_fields<Pose>(fields));
    } else {
      read_pose(name, stamp, fields);
    }
  }

  void add_name(std::string_view name, bool is_point) {
    RangeEnd<Pose> end;
    if (is_point) end.point = PointId(out_.true_points.size());
    if (!is_point) end.pose = PoseId(out_.true_poses.size());
    if (!out_.by_name.emplace(name, end).second) lines_.fail(quoted_pyfg_word(name) + " appears twice");
  }

  void read_pose(std::string_view name, Stamp stamp, LineFields& fields) {
    out_.places.push_back(place_of(lines_, name, stamp));
    if (!taken_.insert({out_.places.back().robot, out_.places.back().place}).second)
      lines_.fail(quoted_pyfg_word(name) + " is another name of an earlier pose");
    out_.pose_names.emplace_back(name);
    out_.pose_lines.push_back(lines_.number());
    out_.true_poses.push_back(read_pyfg_pose<Pose>(fields));
  }

  TextLines lines_;
  PyfgVertices<Pose> out_;
  std::set<std::pair<std::string, std::uint64_t>> taken_;
};

}  // namespace

std::string quoted_pyfg_word(std::string_view word) {
  return "'" + std::string(word.substr(0, kMaxQuotedCharacters)) + "'";
}

template <class Pose>
RangeEnd<Pose> PyfgVertices<Pose>::find(const TextLines& at, std::string_view name) const {
  const auto found = by_name.find(std::string(name));
  if (found == by_name.end()) at.fail(quoted_pyfg_word(name) + " has no VERTEX line");
  return found->second;
}

template <class Pose>
PoseId PyfgVertices<Pose>::find_pose(const TextLines& at, std::string_view name) const {
  const RangeEnd<Pose> end = find(at, name);
  if (!end.pose.valid()) at.fail(quoted_pyfg_word(name) + " is a point, not a pose");
  return end.pose;
}

template <class Pose>
PyfgVertices<Pose> read_pyfg_vertices(const Text& text) {
  return PyfgVertexReader<Pose>(text).read();
}

template <class Pose>
Pose read_pyfg_pose(LineFields& fields) {
  const typename Pose::Point position = read_point_fields<Pose>(fields);
  if constexpr (Pose::kDim == 2)
    return {position, fields.number("theta")};
  else
    return {position, fields.unit_quaternion()};
}

template struct PyfgVertices<SE2>;
template struct PyfgVertices<SE3>;
template PyfgVertices<SE2> read_pyfg_vertices(const Text&);
template PyfgVertices<SE3> read_pyfg_vertices(const Text&);
template SE2 read_pyfg_pose(LineFields&);
template SE3 read_pyfg_pose(LineFields&);

}  // namespace radioslam
