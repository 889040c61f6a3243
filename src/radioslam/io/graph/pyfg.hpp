// Reads factor graphs in PyFG's text format (Papalia et al., PyFactorGraph), 2D or 3D, one entry per line, t
// in seconds:
//
//   VERTEX_SE2 t id x y theta                      VERTEX_SE3:QUAT t id x y z qx qy qz qw
//   VERTEX_XY id x y                               VERTEX_XYZ id x y z
//   VERTEX_SE2:PRIOR t id x y theta <3x3>          VERTEX_SE3:QUAT:PRIOR t id x y z qx qy qz qw <6x6>
//   VERTEX_XY:PRIOR t id x y <2x2>                 VERTEX_XYZ:PRIOR t id x y z <3x3>
//   EDGE_SE2 t i j x y theta <3x3>                 EDGE_SE3:QUAT t i j x y z qx qy qz qw <6x6>
//   EDGE_SE2_XY t i j x y <2x2>                    EDGE_SE3_XYZ t i j x y z <3x3>
//   EDGE_RANGE t i j range_m variance
//
// <nxn> is the upper triangle, row by row, of a COVARIANCE in the order [translation, rotation]. Ids of poses
// consist of letters and a number: A12 is robot A and the index along its trajectory. Ids of points are
// arbitrary. The VERTEX lines (without :PRIOR) are the ground truth; they give the graph its stamps, but not
// its values. Refused (InputError, with the line) are unknown tags and ids, mixed dimensions, covariances and
// variances that are not positive, edges from a vertex to itself, and stamps that decrease along a robot.
#pragma once

#include "radioslam/io/graph/team_graph_file.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Parses a graph; linear in the text, except for sorting the poses.
AnyTeamGraphFile read_pyfg(const Text& text, StatedStarts starts = StatedStarts::kIgnored);

}  // namespace radioslam
