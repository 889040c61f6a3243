#include <cmath>

#include "radioslam/io/fields_of_line.hpp"
#include "radioslam/io/g2o.hpp"
#include "radioslam/io/g2o_tags.hpp"
#include "radioslam/io/g2o_vertices.hpp"
#include "radioslam/io/information.hpp"
#include "radioslam/io/numbers.hpp"

namespace radioslam {
namespace {

using Id = G2oVertices::Id;

/// The ids of an edge, until all vertices are known.
struct EdgeEnds {
  Id i = 0;
  Id j = 0;
};

template <class Pose>
Pose read_pose(LineFields& fields) {
  if constexpr (Pose::kDim == 2) {
    const double x = fields.coordinate("x");
    const double y = fields.coordinate("y");
    return {{x, y}, fields.number("theta")};
  } else {
    return fields.pose();
  }
}

template <class Pose>
typename Pose::Point read_point(LineFields& fields) {
  typename Pose::Point point;
  for (int axis = 0; axis < Pose::kDim; ++axis) point(axis) = fields.coordinate("coordinate");
  return point;
}

template <int N>
Eigen::Matrix<double, N, N> read_upper_triangle(LineFields& fields) {
  Eigen::Matrix<double, N, N> m;
  for (int row = 0; row < N; ++row)
    for (int column = row; column < N; ++column)
      m(row, column) = m(column, row) = fields.number("information");
  return m;
}

template <class Pose>
class G2oReader {
 public:
  G2oReader(const Text& text, RepairInformation repair)
      : text_(text), lines_(text), repair_(repair), vertices_(text) {}

  G2oGraph<Pose> read() {
    out_.graph.chart = PoseChart::kG2o;
    while (lines_.next_with_content()) {
      LineFields fields(lines_);
      read_entry(fields);
      fields.end();
    }
    refuse_indefinite();
    add_undeclared_poses();
    resolve_relative_poses();
    resolve_ranges();
    resolve_sightings();
    resolve_priors();
    resolve_fixed();
    if (out_.graph.poses.empty()) text_.fail(1, "the graph has no poses");
    return std::move(out_);
  }

 private:
  using Tags = G2oTags<Pose>;
  using OtherPose = std::conditional_t<Pose::kDim == 2, SE3, SE2>;

  void read_entry(LineFields& fields) {
    const std::string_view tag = fields.next("a tag");
    if (tag == Tags::kEdge) return read_edge(fields);
    if (tag == Tags::kVertex) return read_vertex(fields);
    if (tag == Tags::kPoint) return read_point_vertex(fields);
    if (tag == kG2oRange) return read_range(fields);
    if (tag == Tags::kSighting) return read_sighting(fields);
    if (tag == Tags::kPrior) return read_prior(fields);
    if (tag == kG2oFix) return read_fixed(fields);
    if (tag == Tags::kOffset) return read_offset(fields);
    refuse_tag(tag);
  }

  [[noreturn]] void refuse_tag(std::string_view tag) const {
    const std::string name(tag.substr(0, 40));
    if (is_g2o_tag<OtherPose>(tag)) lines_.fail(name + ": the graph mixes the plane and space");
    if (is_g2o_tag<Pose>(tag)) lines_.fail(name + ": such landmark edges are not supported");
    lines_.fail("unknown tag '" + name + "'");
  }

  void read_vertex(LineFields& fields) {
    const Id id = fields.id("id");
    vertices_.declare(id, {false, static_cast<std::int32_t>(out_.graph.poses.size())}, lines_.number());
    out_.graph.poses.push_back(read_pose<Pose>(fields));
    out_.pose_ids.push_back(id);
    out_.pose_has_value.push_back(true);
  }

  void read_point_vertex(LineFields& fields) {
    const Id id = fields.id("id");
    vertices_.declare(id, {true, static_cast<std::int32_t>(out_.graph.points.size())}, lines_.number());
    out_.graph.points.push_back(read_point<Pose>(fields));
    out_.point_ids.push_back(id);
  }

  EdgeEnds read_ends(LineFields& fields) const {
    const Id i = fields.id("id");
    const Id j = fields.id("id");
    if (i == j) lines_.fail("an edge from " + quoted_vertex(i) + " to itself");
    return {i, j};
  }

  template <int N>
  Eigen::Matrix<double, N, N> read_information(LineFields& fields) {
    Eigen::Matrix<double, N, N> information = read_upper_triangle<N>(fields);
    ++informations_;
    if (information.isZero(0) && repair_ == RepairInformation::kNo)
      lines_.fail("the information matrix is zero; --repair-information lets such an edge say nothing");
    if (!information.isZero(0) && is_information(information)) return information;
    if (repair_ == RepairInformation::kYes) {
      ++out_.repaired_informations;
      return nearest_information(information);
    }
    if (indefinite_++ == 0) {
      first_indefinite_line_ = lines_.number();
      first_eigenvalue_ = relative_smallest_eigenvalue(information);
    }
    return information;
  }

  void read_edge(LineFields& fields) {
    const EdgeEnds ends = read_ends(fields);
    for (const Id id : {ends.i, ends.j}) vertices_.mention(id, lines_.number());
    relative_pose_ends_.push_back(ends);
    RelativePoseFactor<Pose>& factor = out_.graph.relative_poses.emplace_back();
    factor.T_i_j = read_pose<Pose>(fields);
    factor.information = read_information<Pose::kDof>(fields);
    out_.relative_pose_lines.push_back(lines_.number());
  }

  void read_range(LineFields& fields) {
    range_ends_.push_back(read_ends(fields));
    RangeFactor<Pose>& factor = out_.graph.ranges.emplace_back();
    factor.range_m = fields.coordinate("range");
    const double information = fields.number("information");
    factor.sigma_m = 1 / std::sqrt(information);
    if (!(information > 0) || !std::isfinite(factor.sigma_m)) lines_.fail("the information is not positive");
    if (!fields.empty()) {
      factor.i.lever_arm = read_point<Pose>(fields);
      factor.j.lever_arm = read_point<Pose>(fields);
    }
    out_.range_lines.push_back(lines_.number());
  }

  void read_sighting(LineFields& fields) {
    sighting_ends_.push_back(read_ends(fields));
    if (Pose::kDim == 3) fields.id("offset parameter");
    RelativePointFactor<Pose>& factor = out_.graph.relative_points.emplace_back();
    factor.position = read_point<Pose>(fields);
    factor.information = read_information<Pose::kDim>(fields);
    out_.relative_point_lines.push_back(lines_.number());
  }

  void read_prior(LineFields& fields) {
    prior_ids_.push_back(fields.id("id"));
    if (Pose::kDim == 3) fields.id("offset parameter");
    PosePriorFactor<Pose>& factor = out_.graph.pose_priors.emplace_back();
    factor.prior = read_pose<Pose>(fields);
    factor.information = read_information<Pose::kDof>(fields);
    out_.pose_prior_lines.push_back(lines_.number());
  }

  void read_offset(LineFields& fields) const {
    fields.id("id");
    const typename Pose::Tangent offset = read_pose<Pose>(fields).log();
    if (!offset.isZero(0)) lines_.fail("offsets other than the identity are not supported");
  }

  void read_fixed(LineFields& fields) {
    do {
      fixed_.push_back({fields.id("id"), lines_.number()});
    } while (!fields.empty());
  }

  void refuse_indefinite() const {
    if (indefinite_ == 0) return;
    text_.fail(first_indefinite_line_,
               "the information matrix is indefinite (its smallest eigenvalue is " +
                   format_number(first_eigenvalue_) + " of the largest), the first such of " +
                   std::to_string(indefinite_) + " among " + std::to_string(informations_) +
                   "; --repair-information takes the nearest positive definite ones");
  }

  void add_undeclared_poses() {
    for (const Id id : vertices_.add_undeclared(out_.graph.poses.size())) {
      out_.graph.poses.emplace_back();
      out_.pose_ids.push_back(id);
      out_.pose_has_value.push_back(false);
    }
  }

  void resolve_relative_poses() {
    for (std::size_t k = 0; k < relative_pose_ends_.size(); ++k) {
      RelativePoseFactor<Pose>& factor = out_.graph.relative_poses[k];
      factor.i = vertices_.pose_at(relative_pose_ends_[k].i, out_.relative_pose_lines[k]);
      factor.j = vertices_.pose_at(relative_pose_ends_[k].j, out_.relative_pose_lines[k]);
    }
  }

  void resolve_range_end(RangeEnd<Pose>& end, Id id, std::size_t line) const {
    const G2oVertex vertex = vertices_.at(id, line);
    if (vertex.is_point && !end.lever_arm.isZero(0)) text_.fail(line, "a point has no lever arm");
    if (vertex.is_point) end.point = PointId(vertex.index);
    if (!vertex.is_point) end.pose = PoseId(vertex.index);
  }

  void resolve_ranges() {
    for (std::size_t k = 0; k < range_ends_.size(); ++k) {
      resolve_range_end(out_.graph.ranges[k].i, range_ends_[k].i, out_.range_lines[k]);
      resolve_range_end(out_.graph.ranges[k].j, range_ends_[k].j, out_.range_lines[k]);
    }
  }

  void resolve_sightings() {
    for (std::size_t k = 0; k < sighting_ends_.size(); ++k) {
      const std::size_t line = out_.relative_point_lines[k];
      out_.graph.relative_points[k].i = vertices_.pose_at(sighting_ends_[k].i, line);
      resolve_range_end(out_.graph.relative_points[k].j, sighting_ends_[k].j, line);
    }
  }

  void resolve_priors() {
    for (std::size_t k = 0; k < prior_ids_.size(); ++k)
      out_.graph.pose_priors[k].i = vertices_.pose_at(prior_ids_[k], out_.pose_prior_lines[k]);
  }

  void resolve_fixed() {
    if (fixed_.empty()) return;
    out_.graph.pose_fixed.assign(out_.graph.poses.size(), false);
    for (const auto& [id, line] : fixed_) out_.graph.pose_fixed[vertices_.pose_at(id, line).index()] = true;
  }

  struct Fixed {
    Id id;
    std::size_t line;
  };

  const Text& text_;
  TextLines lines_;
  RepairInformation repair_;
  G2oGraph<Pose> out_;
  G2oVertices vertices_;
  std::vector<EdgeEnds> relative_pose_ends_;
  std::vector<EdgeEnds> range_ends_;
  std::vector<EdgeEnds> sighting_ends_;
  std::vector<Id> prior_ids_;
  std::vector<Fixed> fixed_;
  std::size_t informations_ = 0;
  std::size_t indefinite_ = 0;
  std::size_t first_indefinite_line_ = 0;
  double first_eigenvalue_ = 0;
};

enum class Dimension { kPlane, kSpace };

/// From the first tag that tells.
Dimension dimension_of(const Text& text) {
  TextLines lines(text);
  while (lines.next_with_content()) {
    const std::string_view tag = LineFields(lines).next("a tag");
    if (is_g2o_tag<SE2>(tag)) return Dimension::kPlane;
    if (is_g2o_tag<SE3>(tag)) return Dimension::kSpace;
    if (tag != kG2oRange && tag != kG2oFix)
      lines.fail("unknown tag '" + std::string(tag.substr(0, 40)) + "'");
  }
  text.fail(1, "the graph has no poses");
}

}  // namespace

AnyG2oGraph read_g2o(const Text& text, RepairInformation repair) {
  if (dimension_of(text) == Dimension::kPlane) return G2oReader<SE2>(text, repair).read();
  return G2oReader<SE3>(text, repair).read();
}

}  // namespace radioslam
