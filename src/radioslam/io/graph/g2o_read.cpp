#include <cmath>
#include <cstddef>

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/g2o_entries.hpp"
#include "radioslam/io/graph/g2o_vertices.hpp"
#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/graph/team_ids.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

/// Reads the information matrices of a g2o file, and repairs or refuses those that are zero or indefinite.
/// Indefinite ones are counted first and refused together, because a file has either none or many.
class G2oInformationReader {
 public:
  explicit G2oInformationReader(RepairInformation repair) : repair_(repair) {}

  /// Reads the upper triangle at the end of a line. Refuses a zero matrix unless it is to be repaired.
  template <int N>
  Eigen::Matrix<double, N, N> read(const TextLines& lines, LineFields& fields) {
    Eigen::Matrix<double, N, N> information = read_upper_triangle<N>(fields, "information");
    ++count_;
    if (information.isZero(0) && repair_ == RepairInformation::kNo)
      lines.fail("the information matrix is zero; --repair-information accepts such edges without effect");
    if (!information.isZero(0) && is_information(information)) return information;
    if (repair_ == RepairInformation::kYes) {
      ++repaired_;
      return nearest_information(information);
    }
    if (indefinite_++ == 0) {
      first_indefinite_line_ = lines.number();
      first_eigenvalue_ = relative_smallest_eigenvalue(information);
    }
    return information;
  }

  /// Refuses the file if any matrix was indefinite and not repaired.
  void refuse_indefinite(const Text& text) const {
    if (indefinite_ == 0) return;
    text.fail(first_indefinite_line_, "the information matrix is indefinite (its smallest eigenvalue is " +
                                          format_number(first_eigenvalue_) +
                                          " of the largest), the first such of " +
                                          std::to_string(indefinite_) + " among " + std::to_string(count_) +
                                          "; --repair-information uses the nearest positive definite ones");
  }

  std::size_t repaired() const { return repaired_; }

 private:
  RepairInformation repair_;
  std::size_t repaired_ = 0;
  std::size_t count_ = 0;
  std::size_t indefinite_ = 0;
  std::size_t first_indefinite_line_ = 0;
  double first_eigenvalue_ = 0;
};

/// Second pass over a file: reads the factors, after all vertices are known.
template <class Pose>
class G2oReader {
 public:
  G2oReader(const Text& text, RepairInformation repair, BadLines bad_lines, const IsElsewhere& is_elsewhere)
      : text_(text),
        lines_(text),
        bad_lines_(bad_lines),
        pass_(read_g2o_vertices(text, bad_lines, is_elsewhere, out_)),
        informations_(repair) {}

  G2oGraph<Pose> read() {
    out_.graph.chart = PoseChart::kG2o;
    std::size_t lines = 0;
    for (; lines_.next_with_content(); ++lines)
      if (!pass_.bad_lines.contains(lines_.number())) read_or_skip_entry();
    if (2 * out_.skipped_lines.count() > lines) out_.skipped_lines.throw_first();
    informations_.refuse_indefinite(text_);
    vertices().refuse_missing();
    if (out_.graph.poses.empty()) text_.fail(1, "the graph has no poses");
    if (const auto id = id_without_letter(out_.pose_ids)) refuse_missing_letter(text_, *id);
    if (second_odometry(out_.graph, out_.pose_ids) == SecondOdometry::kContradicts)
      refuse_second_odometry(text_);
    out_.repaired_informations = informations_.repaired();
    return std::move(out_);
  }

 private:
  using Tags = G2oTags<Pose>;

  const G2oVertices& vertices() const { return pass_.vertices; }

  void read_or_skip_entry() {
    LineFields fields(lines_);
    try {
      read_entry(fields);
    } catch (const InputError& error) {
      if (bad_lines_ == BadLines::kRefuse) throw;
      out_.skipped_lines.add(error);
    }
  }

  void read_entry(LineFields& fields) {
    const std::string_view tag = fields.next("a tag");
    if (tag == Tags::kVertex || tag == Tags::kPoint) return;
    read_factor(tag, fields);
    fields.end();
  }

  /// The first pass has refused other tags.
  void read_factor(std::string_view tag, LineFields& fields) {
    if (tag == Tags::kEdge) return read_edge(fields);
    if (tag == kG2oRange) return read_range(fields);
    if (tag == Tags::kSighting) return read_sighting(fields);
    if (tag == Tags::kPrior) return read_prior(fields);
    if (tag == kG2oFix) return read_fixed(fields);
    if (tag == Tags::kOffset) read_offset(fields);
  }

  PoseId pose_at(G2oVertices::Id id) const { return vertices().pose_at(id, lines_.number()); }

  void read_edge(LineFields& fields) {
    const G2oEdgeIds ids = read_g2o_edge_ids(fields);
    RelativePoseFactor<Pose> factor;
    factor.T_i_j = read_g2o_pose<Pose>(fields);
    factor.information = informations_.read<Pose::kDof>(lines_, fields);
    factor.i = pose_at(ids.i);
    factor.j = pose_at(ids.j);
    fields.end();
    out_.graph.relative_poses.push_back(factor);
  }

  void read_range(LineFields& fields) {
    const G2oEdgeIds ids = read_g2o_edge_ids(fields);
    RangeFactor<Pose> factor;
    factor.range_m = fields.coordinate("range");
    const double information = fields.number("information");
    factor.sigma_m = 1 / std::sqrt(information);
    if (!(information > 0) || !std::isfinite(factor.sigma_m)) lines_.fail("the information is not positive");
    if (!fields.empty()) {
      factor.i.lever_arm = read_point_fields<Pose>(fields);
      factor.j.lever_arm = read_point_fields<Pose>(fields);
    }
    set_end(factor.i, ids.i);
    set_end(factor.j, ids.j);
    fields.end();
    out_.graph.ranges.push_back(factor);
  }

  void set_end(RangeEnd<Pose>& end, G2oVertices::Id id) const {
    const G2oVertex vertex = vertices().at(id, lines_.number());
    if (vertex.is_point && !end.lever_arm.isZero(0)) lines_.fail("a point cannot have a lever arm");
    if (vertex.is_point) end.point = PointId(vertex.index);
    if (!vertex.is_point) end.pose = PoseId(vertex.index);
  }

  void read_sighting(LineFields& fields) {
    const G2oEdgeIds ids = read_g2o_edge_ids(fields);
    if (Pose::kDim == 3) fields.id("offset parameter");
    RelativePointFactor<Pose> factor;
    factor.position = read_point_fields<Pose>(fields);
    factor.information = informations_.read<Pose::kDim>(lines_, fields);
    factor.i = pose_at(ids.i);
    set_end(factor.j, ids.j);
    fields.end();
    out_.graph.relative_points.push_back(factor);
  }

  void read_prior(LineFields& fields) {
    const G2oVertices::Id id = fields.id("id");
    if (Pose::kDim == 3) fields.id("offset parameter");
    PosePriorFactor<Pose> factor;
    factor.prior = read_g2o_pose<Pose>(fields);
    factor.information = informations_.read<Pose::kDof>(lines_, fields);
    factor.i = pose_at(id);
    fields.end();
    out_.graph.pose_priors.push_back(factor);
  }

  void read_offset(LineFields& fields) const {
    fields.id("id");
    const typename Pose::Tangent offset = read_g2o_pose<Pose>(fields).log();
    if (!offset.isZero(0)) lines_.fail("offsets other than the identity are not supported");
  }

  void read_fixed(LineFields& fields) {
    out_.graph.pose_fixed.resize(out_.graph.poses.size(), false);
    do {
      out_.graph.pose_fixed[pose_at(fields.id("id")).index()] = true;
    } while (!fields.empty());
  }

  const Text& text_;
  TextLines lines_;
  G2oGraph<Pose> out_;
  BadLines bad_lines_;
  G2oVertexPass pass_;
  G2oInformationReader informations_;
};

enum class Dimension { kPlane, kSpace };

/// Determines the dimension from the first tag that depends on it.
Dimension dimension_of(const Text& text, BadLines bad_lines) {
  TextLines lines(text);
  SkippedRecords unknown;
  while (lines.next_with_content()) {
    const std::string_view tag = LineFields(lines).next("a tag");
    if (is_g2o_tag<SE2>(tag)) return Dimension::kPlane;
    if (is_g2o_tag<SE3>(tag)) return Dimension::kSpace;
    if (tag == kG2oRange || tag == kG2oFix) continue;
    unknown.add(
        InputError(text.name, lines.number(), "unknown tag '" + std::string(tag.substr(0, 40)) + "'"));
    if (bad_lines == BadLines::kRefuse) unknown.throw_first();
  }
  unknown.throw_first();
  text.fail(1, "the graph has no poses");
}

}  // namespace

AnyG2oGraph read_g2o(const Text& text, RepairInformation repair, BadLines bad_lines,
                     const IsElsewhere& is_elsewhere) {
  if (dimension_of(text, bad_lines) == Dimension::kPlane)
    return G2oReader<SE2>(text, repair, bad_lines, is_elsewhere).read();
  return G2oReader<SE3>(text, repair, bad_lines, is_elsewhere).read();
}

}  // namespace radioslam
