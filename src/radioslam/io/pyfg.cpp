#include "radioslam/io/pyfg.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <set>
#include <unordered_map>
#include <utility>

#include "radioslam/io/fields_of_line.hpp"
#include "radioslam/io/numbers.hpp"
#include "radioslam/io/team_assembly.hpp"

namespace radioslam {
namespace {

template <class Pose>
struct Tags;

template <>
struct Tags<SE2> {
  static constexpr std::string_view kPose = "VERTEX_SE2";
  static constexpr std::string_view kPoint = "VERTEX_XY";
  static constexpr std::string_view kPosePrior = "VERTEX_SE2:PRIOR";
  static constexpr std::string_view kPointPrior = "VERTEX_XY:PRIOR";
  static constexpr std::string_view kRelativePose = "EDGE_SE2";
  static constexpr std::string_view kSighting = "EDGE_SE2_XY";
};

template <>
struct Tags<SE3> {
  static constexpr std::string_view kPose = "VERTEX_SE3:QUAT";
  static constexpr std::string_view kPoint = "VERTEX_XYZ";
  static constexpr std::string_view kPosePrior = "VERTEX_SE3:QUAT:PRIOR";
  static constexpr std::string_view kPointPrior = "VERTEX_XYZ:PRIOR";
  static constexpr std::string_view kRelativePose = "EDGE_SE3:QUAT";
  static constexpr std::string_view kSighting = "EDGE_SE3_XYZ";
};

constexpr std::string_view kRange = "EDGE_RANGE";
constexpr std::size_t kShownOfLine = 40;
constexpr double kLargestStamp_s = 9e9;  ///< year 2255; leaves room to tell equal stamps apart

template <class Pose>
bool is_tag_of(std::string_view tag) {
  using T = Tags<Pose>;
  return tag == T::kPose || tag == T::kPoint || tag == T::kPosePrior || tag == T::kPointPrior ||
         tag == T::kRelativePose || tag == T::kSighting;
}

std::string in_quotes(std::string_view word) { return "'" + std::string(word.substr(0, kShownOfLine)) + "'"; }

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Letters and a number: robot and place.
PosePlace place_of(const TextLines& lines, std::string_view name, Stamp stamp) {
  std::size_t letters = 0;
  while (letters < name.size() && is_letter(name[letters])) ++letters;
  const auto place = parse_id(name.substr(letters));
  if (letters == 0 || letters > kShownOfLine || !place)
    lines.fail("the pose's id " + in_quotes(name) + " is not letters and a number");
  return {std::string(name.substr(0, letters)), *place, stamp};
}

/// A pose or a point, by its place in the file's graph.
struct Vertex {
  bool is_point = false;
  std::size_t index = 0;
};

template <class Pose>
class PyfgReader {
 public:
  explicit PyfgReader(const Text& text) : text_(text) {}

  TeamGraphFile<Pose> read() {
    read_lines(true);
    if (graph_.poses.empty()) text_.fail(1, "the graph has no poses");
    read_lines(false);
    if (const auto pose = first_backward_stamp(places_))
      text_.fail(pose_lines_[*pose], "time runs backwards along robot " + in_quotes(places_[*pose].robot));
    auto [team, file_index] = assemble_team(std::move(graph_), places_);
    out_.team = std::move(team);
    for (const std::size_t k : file_index) {
      out_.pose_names.push_back(std::move(pose_names_[k]));
      out_.true_poses.push_back(true_poses_[k]);
    }
    return std::move(out_);
  }

 private:
  using T = Tags<Pose>;
  using Point = typename Pose::Point;

  /// Vertices first, so that edges may stand before them.
  void read_lines(bool vertices) {
    TextLines lines(text_);
    lines_ = &lines;
    while (lines.next_with_content()) {
      LineFields fields(lines);
      const std::string_view tag = fields.next("a tag");
      const bool is_vertex = tag == T::kPose || tag == T::kPoint;
      if (is_vertex != vertices) continue;
      if (is_vertex) {
        read_vertex(tag, fields);
      } else {
        read_factor(tag, fields);
      }
      fields.end();
    }
    lines_ = nullptr;
  }

  void read_vertex(std::string_view tag, LineFields& fields) {
    const bool is_point = tag == T::kPoint;
    const Stamp stamp = is_point ? Stamp{} : fields.stamp("t");
    if (std::abs(stamp.seconds()) > kLargestStamp_s) lines_->fail("the time is not plausible");
    const std::string_view name = fields.next("id");
    const std::size_t index = is_point ? graph_.points.size() : graph_.poses.size();
    if (!vertices_.emplace(name, Vertex{is_point, index}).second)
      lines_->fail(in_quotes(name) + " was given before");
    if (is_point) {
      graph_.points.emplace_back(Point::Zero());
      out_.point_names.emplace_back(name);
      out_.true_points.push_back(read_point(fields));
      return;
    }
    graph_.poses.emplace_back();
    places_.push_back(place_of(*lines_, name, stamp));
    if (!taken_.insert({places_.back().robot, places_.back().place}).second)
      lines_->fail(in_quotes(name) + " is another name of a pose that was given before");
    pose_names_.emplace_back(name);
    pose_lines_.push_back(lines_->number());
    true_poses_.push_back(read_pose(fields));
  }

  void read_factor(std::string_view tag, LineFields& fields) {
    using Other = std::conditional_t<Pose::kDim == 2, SE3, SE2>;
    if (is_tag_of<Other>(tag)) lines_->fail(std::string(tag) + ": the graph mixes the plane and space");
    if (tag != kRange && !is_tag_of<Pose>(tag)) lines_->fail("unknown tag " + in_quotes(tag));
    fields.stamp("t");
    if (tag == T::kRelativePose) return read_relative_pose(fields);
    if (tag == kRange) return read_range(fields);
    if (tag == T::kSighting) return read_sighting(fields);
    if (tag == T::kPosePrior) return read_pose_prior(fields);
    read_point_prior(fields);
  }

  void read_relative_pose(LineFields& fields) {
    RelativePoseFactor<Pose>& factor = graph_.relative_poses.emplace_back();
    factor.i = pose_named(fields.next("id"));
    factor.j = pose_named(fields.next("id"));
    if (factor.i == factor.j) lines_->fail("an edge from a pose to itself");
    factor.T_i_j = read_pose(fields);
    factor.information = read_information<Pose::kDof>(fields);
  }

  void read_range(LineFields& fields) {
    RangeFactor<Pose>& factor = graph_.ranges.emplace_back();
    factor.i = end_named(fields.next("id"));
    factor.j = end_named(fields.next("id"));
    refuse_itself(factor.i, factor.j);
    factor.range_m = fields.coordinate("range");
    if (factor.range_m < 0) lines_->fail("the range is negative");
    const double variance = fields.number("variance");
    factor.sigma_m = std::sqrt(variance);
    if (!(variance > 0)) lines_->fail("the variance is not positive");
  }

  void read_sighting(LineFields& fields) {
    RelativePointFactor<Pose>& factor = graph_.relative_points.emplace_back();
    factor.i = pose_named(fields.next("id"));
    factor.j = end_named(fields.next("id"));
    refuse_itself({factor.i, {}, Point::Zero()}, factor.j);
    factor.position = read_point(fields);
    factor.information = read_information<Pose::kDim>(fields);
  }

  void read_pose_prior(LineFields& fields) {
    PosePriorFactor<Pose>& factor = graph_.pose_priors.emplace_back();
    factor.i = pose_named(fields.next("id"));
    factor.prior = read_pose(fields);
    factor.information = read_information<Pose::kDof>(fields);
  }

  void read_point_prior(LineFields& fields) {
    PositionFactor<Pose>& factor = graph_.positions.emplace_back();
    factor.i = end_named(fields.next("id"));
    factor.position = read_point(fields);
    factor.information = read_information<Pose::kDim>(fields);
  }

  void refuse_itself(const RangeEnd<Pose>& i, const RangeEnd<Pose>& j) const {
    if (i.pose == j.pose && i.point == j.point) lines_->fail("a measurement from a vertex to itself");
  }

  RangeEnd<Pose> end_named(std::string_view name) const {
    const auto found = vertices_.find(std::string(name));
    if (found == vertices_.end()) lines_->fail(in_quotes(name) + " has no VERTEX line");
    RangeEnd<Pose> end;
    if (found->second.is_point) end.point = PointId(found->second.index);
    if (!found->second.is_point) end.pose = PoseId(found->second.index);
    return end;
  }

  PoseId pose_named(std::string_view name) const {
    const RangeEnd<Pose> end = end_named(name);
    if (!end.pose.valid()) lines_->fail(in_quotes(name) + " is a point, a pose is needed");
    return end.pose;
  }

  Point read_point(LineFields& fields) const {
    Point point;
    for (int axis = 0; axis < Pose::kDim; ++axis) point(axis) = fields.coordinate("coordinate");
    return point;
  }

  Pose read_pose(LineFields& fields) const {
    const Point position = read_point(fields);
    if constexpr (Pose::kDim == 2)
      return {position, fields.number("theta")};
    else
      return {position, fields.unit_quaternion()};
  }

  /// Inverts the covariance.
  template <int N>
  Eigen::Matrix<double, N, N> read_information(LineFields& fields) const {
    Eigen::Matrix<double, N, N> covariance;
    for (int row = 0; row < N; ++row)
      for (int column = row; column < N; ++column)
        covariance(row, column) = covariance(column, row) = fields.number("covariance");
    const Eigen::LLT<Eigen::Matrix<double, N, N>> llt(covariance);
    const Eigen::Matrix<double, N, N> information = llt.solve(Eigen::Matrix<double, N, N>::Identity());
    if (llt.info() != Eigen::Success || !information.allFinite())
      lines_->fail("the covariance is not positive definite");
    return (information + information.transpose()) / 2;
  }

  const Text& text_;
  const TextLines* lines_ = nullptr;
  PoseGraph<Pose> graph_;
  TeamGraphFile<Pose> out_;
  std::vector<PosePlace> places_;
  std::vector<std::string> pose_names_;
  std::vector<std::size_t> pose_lines_;
  std::vector<Pose> true_poses_;
  std::unordered_map<std::string, Vertex> vertices_;  // looked up, never walked through
  std::set<std::pair<std::string, std::uint64_t>> taken_;
};

}  // namespace

AnyTeamGraphFile read_pyfg(const Text& text) {
  TextLines lines(text);
  while (lines.next_with_content()) {
    const std::string_view tag = LineFields(lines).next("a tag");
    if (is_tag_of<SE2>(tag)) return PyfgReader<SE2>(text).read();
    if (is_tag_of<SE3>(tag)) return PyfgReader<SE3>(text).read();
    if (tag != kRange) lines.fail("unknown tag " + in_quotes(tag));
  }
  text.fail(1, "the graph has no poses");
}

}  // namespace radioslam
