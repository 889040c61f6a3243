#include "radioslam/io/graph/pyfg.hpp"

#include <cmath>
#include <utility>

#include "radioslam/io/graph/field_matrices.hpp"
#include "radioslam/io/graph/graph_keys.hpp"
#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/graph/pyfg_tags.hpp"
#include "radioslam/io/graph/pyfg_vertices.hpp"
#include "radioslam/io/graph/team_assembly.hpp"
#include "radioslam/io/text/line_fields.hpp"

namespace radioslam {
namespace {

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
  TeamGraphFile<Pose> out;
  out.team = std::move(assembled.team);
  out.notes = std::move(assembled.notes);
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
