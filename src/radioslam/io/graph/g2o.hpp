// Reads and writes pose graphs in g2o's text format (Kuemmerle et al. 2011), 2D or 3D. One entry per line:
//
//   VERTEX_SE2 id x y theta                      VERTEX_SE3:QUAT id x y z qx qy qz qw
//   VERTEX_XY id x y                             VERTEX_TRACKXYZ id x y z
//   EDGE_SE2 i j x y theta <3x3>                 EDGE_SE3:QUAT i j x y z qx qy qz qw <6x6>
//   EDGE_SE2_XY i j x y <2x2>                    EDGE_SE3_TRACKXYZ i j 0 x y z <3x3>
//   EDGE_PRIOR_SE2 i x y theta <3x3>             EDGE_SE3_PRIOR i 0 x y z qx qy qz qw <6x6>
//   FIX id ...                                   PARAMS_SE3OFFSET 0 0 0 0 0 0 0 1
//   EDGE_RANGE i j range_m information [lever_i lever_j]       extension: a distance between poses or points
//
// <nxn> is the upper triangle, row by row, of an information matrix in the order [translation, rotation] of
// g2o's error vector (PoseChart::kG2o). A lever arm is the antenna's position in the body frame, x y (z). Ids
// have 64 bits. Blank lines and '#' comments are skipped. VERTEX lines may be missing for all poses, or for
// all poses of another robot (g2o_vertices.hpp). Repeated edges count once each. Refused (InputError, with
// the line) are graphs that mix 2D and 3D entries, unknown tags, other landmark edges, information matrices
// that are indefinite or zero, a vertex with two different values, and ids of poses with and without robots'
// letters (team_ids.hpp).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "radioslam/graph/pose_graph.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Treatment of information matrices that are zero or have negative eigenvalues beyond rounding.
enum class RepairInformation {
  kNo,   ///< refuse the file, with the first such line and their number
  kYes,  ///< use the nearest positive definite matrix (zero stays zero) and count it
};

/// Treatment of lines that cannot be read.
enum class BadLines {
  kRefuse,  ///< refuse the file, with the first one
  kSkip,    ///< leave them out and count them; refuse a file that mixes dimensions or has more bad lines than
            ///< good
};

/// A file's graph. Poses are in the order of their VERTEX lines, followed by those without one, sorted by id.
template <class Pose>
struct G2oGraph {
  PoseGraph<Pose> graph;
  std::vector<std::uint64_t> pose_ids;   ///< per pose
  std::vector<std::uint64_t> point_ids;  ///< per point
  std::vector<bool> pose_has_value;      ///< per pose: whether it has a VERTEX line
  std::size_t repaired_informations = 0;
  SkippedRecords skipped_lines;
};

using AnyG2oGraph = std::variant<G2oGraph<SE2>, G2oGraph<SE3>>;

/// Whether another file of the team has the pose with this id; an empty function: none has.
using IsElsewhere = std::function<bool(std::uint64_t)>;

/// Parses a graph in linear time. All errors are InputErrors with their line. Poses that are elsewhere need
/// no VERTEX line.
AnyG2oGraph read_g2o(const Text& text, RepairInformation repair = RepairInformation::kNo,
                     BadLines bad_lines = BadLines::kRefuse, const IsElsewhere& is_elsewhere = {});

/// Assigns ids 0, 1, ... to the poses and then to the points.
template <class Pose>
G2oGraph<Pose> with_default_ids(PoseGraph<Pose> graph);

/// Assigns these ids; where there is not one per pose, those of with_default_ids, and where there is not one
/// per point, numbers above all ids of poses.
template <class Pose>
G2oGraph<Pose> with_ids(PoseGraph<Pose> graph, const std::vector<std::uint64_t>& pose_ids,
                        const std::vector<std::uint64_t>& point_ids);

/// The text of a graph. Information matrices are multiplied by their factor's weight and converted to g2o's
/// chart; drifts are applied to their measurements. Elements that the format does not support (losses,
/// bearings, positions, drift priors) are counted in a comment at the end.
template <class Pose>
std::string format_g2o(const G2oGraph<Pose>& graph);

}  // namespace radioslam
