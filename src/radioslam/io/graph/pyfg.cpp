#include "radioslam/io/graph/pyfg.hpp"

#include <cmath>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "radioslam/geometry/se2.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

/// Tags at the beginning of the lines of a PyFG file.
template <class Pose>
struct PyfgTags;

template <>
struct PyfgTags<SE2> {
  static constexpr std::string_view kPose = "VERTEX_SE2";
  static constexpr std::string_view kPoint = "VERTEX_XY";
  static constexpr std::string_view kPosePrior = "VERTEX_SE2:PRIOR";
  static constexpr std::string_view kPointPrior = "VERTEX_XY:PRIOR";
  static constexpr std::string_view kRelativePose = "EDGE_SE2";
  static constexpr std::string_view kSighting = "EDGE_SE2_XY";
};

template <>
struct PyfgTags<SE3> {
  static constexpr std::string_view kPose = "VERTEX_SE3:QUAT";
  static constexpr std::string_view kPoint = "VERTEX_XYZ";
  static constexpr std::string_view kPosePrior = "VERTEX_SE3:QUAT:PRIOR";
  static constexpr std::string_view kPointPrior = "VERTEX_XYZ:PRIOR";
  static constexpr std::string_view kRelativePose = "EDGE_SE3:QUAT";
  static constexpr std::string_view kSighting = "EDGE_SE3_XYZ";
};

inline constexpr std::string_view kPyfgRange = "EDGE_RANGE";

/// Whether `tag` belongs to graphs of this dimension.
template <class Pose>
constexpr bool is_pyfg_tag(std::string_view tag) {
  using Tags = PyfgTags<Pose>;
  return tag == Tags::kPose || tag == Tags::kPoint || tag == Tags::kPosePrior || tag == Tags::kPointPrior ||
         tag == Tags::kRelativePose || tag == Tags::kSighting;
}

template <class Pose>
constexpr bool is_pyfg_vertex(std::string_view tag) {
  return tag == PyfgTags<Pose>::kPose || tag == PyfgTags<Pose>::kPoint;
}

// First pass over a PyFG file: reads the VERTEX lines, so that factors may precede them, and finds the pose
// or point of a name.

constexpr std::size_t kMaxQuotedCharacters = 40;

/// The beginning of a word of the file, for error messages.
std::string quoted_pyfg_word(std::string_view word) {
  return "'" + std::string(word.substr(0, kMaxQuotedCharacters)) + "'";
}

/// The vertices of one file, poses and points each in the order of their lines.
template <class Pose>
struct PyfgVertices {
  std::vector<PoseIndex> places;  ///< robot, index and stamp of each pose
  std::vector<std::string> pose_names;
  std::vector<std::size_t> pose_lines;
  std::vector<Pose> true_poses;
  std::vector<std::string> point_names;
  std::vector<typename Pose::Point> true_points;
  std::unordered_map<std::string, RangeEnd<Pose>> by_name;  ///< used for look-up only, never iterated

  /// The pose or point with this name; `at` is the line that names it. Refuses unknown names.
  RangeEnd<Pose> find(const TextLines& at, std::string_view name) const {
    const auto found = by_name.find(std::string(name));
    if (found == by_name.end()) at.fail(quoted_pyfg_word(name) + " has no VERTEX line");
    return found->second;
  }

  /// Also refuses points.
  PoseId find_pose(const TextLines& at, std::string_view name) const {
    const RangeEnd<Pose> end = find(at, name);
    if (!end.pose.valid()) at.fail(quoted_pyfg_word(name) + " is a point, not a pose");
    return end.pose;
  }
};

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

/// x y theta, or x y z qx qy qz qw.
template <class Pose>
Pose read_pyfg_pose(LineFields& fields) {
  const typename Pose::Point position = read_point_fields<Pose>(fields);
  if constexpr (Pose::kDim == 2)
    return {position, fields.number("theta")};
  else
    return {position, fields.unit_quaternion()};
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

/// Refuses malformed lines, implausible times, ids that are not letters and a number, and repeated names.
template <class Pose>
PyfgVertices<Pose> read_pyfg_vertices(const Text& text) {
  return PyfgVertexReader<Pose>(text).read();
}

/// Second pass over a file: reads the factors, after all vertices are known.
template <class Pose>
class PyfgFactorReader {
 public:
  PyfgFactorReader(const Text& text, const PyfgVertices<Pose>& vertices)
      : lines_(text), vertices_(vertices) {}

  PoseGraph<Pose> read() {
    graph_.poses.resize(vertices_.true_poses.size());
    graph_.points.assign(vertices_.true_points.size(), Point::Zero());
    while (lines_.next_with_content()) {
      LineFields fields(lines_);
      const std::string_view tag = fields.next("a tag");
      if (is_pyfg_vertex<Pose>(tag)) continue;
      read_factor(tag, fields);
      fields.end();
    }
    return std::move(graph_);
  }

 private:
  using Tags = PyfgTags<Pose>;
  using Point = typename Pose::Point;

  void read_factor(std::string_view tag, LineFields& fields) {
    using Other = std::conditional_t<Pose::kDim == 2, SE3, SE2>;
    if (is_pyfg_tag<Other>(tag)) lines_.fail(std::string(tag) + ": the graph mixes 2D and 3D");
    if (tag != kPyfgRange && !is_pyfg_tag<Pose>(tag)) lines_.fail("unknown tag " + quoted_pyfg_word(tag));
    fields.stamp("t");
    if (tag == Tags::kRelativePose) return read_relative_pose(fields);
    if (tag == kPyfgRange) return read_range(fields);
    if (tag == Tags::kSighting) return read_sighting(fields);
    if (tag == Tags::kPosePrior) return read_pose_prior(fields);
    read_point_prior(fields);
  }

  void read_relative_pose(LineFields& fields) {
    RelativePoseFactor<Pose>& factor = graph_.relative_poses.emplace_back();
    factor.i = next_pose(fields);
    factor.j = next_pose(fields);
    if (factor.i == factor.j) lines_.fail("an edge from a pose to itself");
    factor.T_i_j = read_pyfg_pose<Pose>(fields);
    factor.information = read_information<Pose::kDof>(fields);
  }

  void read_range(LineFields& fields) {
    RangeFactor<Pose>& factor = graph_.ranges.emplace_back();
    factor.i = next_end(fields);
    factor.j = next_end(fields);
    refuse_itself(factor.i, factor.j);
    factor.range_m = fields.coordinate("range");
    if (factor.range_m < 0) lines_.fail("the range is negative");
    const double variance = fields.number("variance");
    factor.sigma_m = std::sqrt(variance);
    if (!(variance > 0)) lines_.fail("the variance is not positive");
  }

  void read_sighting(LineFields& fields) {
    RelativePointFactor<Pose>& factor = graph_.relative_points.emplace_back();
    factor.i = next_pose(fields);
    factor.j = next_end(fields);
    refuse_itself({factor.i, {}, Point::Zero()}, factor.j);
    factor.position = read_point_fields<Pose>(fields);
    factor.information = read_information<Pose::kDim>(fields);
  }

  void read_pose_prior(LineFields& fields) {
    PosePriorFactor<Pose>& factor = graph_.pose_priors.emplace_back();
    factor.i = next_pose(fields);
    factor.prior = read_pyfg_pose<Pose>(fields);
    factor.information = read_information<Pose::kDof>(fields);
  }

  void read_point_prior(LineFields& fields) {
    PositionFactor<Pose>& factor = graph_.positions.emplace_back();
    factor.i = next_end(fields);
    factor.position = read_point_fields<Pose>(fields);
    factor.information = read_information<Pose::kDim>(fields);
  }

  PoseId next_pose(LineFields& fields) const { return vertices_.find_pose(lines_, fields.next("id")); }
  RangeEnd<Pose> next_end(LineFields& fields) const { return vertices_.find(lines_, fields.next("id")); }

  void refuse_itself(const RangeEnd<Pose>& i, const RangeEnd<Pose>& j) const {
    if (i.pose == j.pose && i.point == j.point) lines_.fail("a measurement from a vertex to itself");
  }

  /// Inverts the covariance.
  template <int N>
  Eigen::Matrix<double, N, N> read_information(LineFields& fields) const {
    const auto information = information_of<N>(read_upper_triangle<N>(fields, "covariance"));
    if (!information) lines_.fail("the covariance is not positive definite");
    return *information;
  }

  TextLines lines_;
  const PyfgVertices<Pose>& vertices_;
  PoseGraph<Pose> graph_;
};

/// The file's graph, with the poses of each robot in the order of their indices.
template <class Pose>
TeamGraphFile<Pose> read_pyfg_graph(const Text& text, StatedStarts starts) {
  PyfgVertices<Pose> vertices = read_pyfg_vertices<Pose>(text);
  if (vertices.true_poses.empty()) text.fail(1, "the graph has no poses");
  PoseGraph<Pose> graph = PyfgFactorReader<Pose>(text, vertices).read();
  if (const auto pose = first_backward_stamp(vertices.places))
    text.fail(vertices.pose_lines[*pose],
              "time runs backwards along robot " + quoted_pyfg_word(vertices.places[*pose].robot));
  AssembledTeam<Pose> assembled = assemble_team(std::move(graph), vertices.places, starts);
  TeamGraphFile<Pose> out = std::move(assembled.file);
  out.point_names = std::move(vertices.point_names);
  out.true_points = std::move(vertices.true_points);
  for (const std::size_t k : assembled.file_index) {
    out.pose_names.push_back(std::move(vertices.pose_names[k]));
    out.true_poses.push_back(vertices.true_poses[k]);
    if (const auto key = key_of(vertices.places[k])) out.pose_ids.push_back(*key);
  }
  if (out.pose_ids.size() != out.pose_names.size()) out.pose_ids.clear();
  return out;
}

}  // namespace

AnyTeamGraphFile read_pyfg(const Text& text, StatedStarts starts) {
  TextLines lines(text);
  while (lines.next_with_content()) {
    const std::string_view tag = LineFields(lines).next("a tag");
    if (is_pyfg_tag<SE2>(tag)) return read_pyfg_graph<SE2>(text, starts);
    if (is_pyfg_tag<SE3>(tag)) return read_pyfg_graph<SE3>(text, starts);
    if (tag != kPyfgRange) lines.fail("unknown tag " + quoted_pyfg_word(tag));
  }
  text.fail(1, "the graph has no poses");
}

}  // namespace radioslam
