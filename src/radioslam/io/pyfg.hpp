// Factor graphs in PyFG's text format (Papalia et al., PyFactorGraph), in the plane or in space, one entry
// per line, t in seconds:
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
// are letters and a number, A12: the robot A and the place in its chain; ids of points come as they are. The
// VERTEX lines (without :PRIOR) are the truth; the graph's values never come from them, its stamps do.
// Refused: unknown tags, ids and other dimensions, covariances and variances that are not positive, edges
// from a vertex to itself, stamps that run backwards along a robot.
#pragma once

#include "radioslam/io/team_graph_file.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// Linear in the text, but for a sort of the poses.
AnyTeamGraphFile read_pyfg(const Text& text);

}  // namespace radioslam
