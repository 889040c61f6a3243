// The team's joint estimate as its robots send it to one another: each robot its rows of the skeleton's
// information matrix. All factors that touch a robot's poses are its own odometry and measurements it took
// part in, so it knows its rows. Rows of no robot's own (anchors, range biases) are sent by the first robot.
//
//   number of blocks of the matrix
//   own blocks: count, each: index | size | whether it is eliminated last | lower triangle
//   blocks left of them: count, each: row | column | columns | values
//   variables of the own segments: count, each: block + 1 (0: held) | whether it is a pose | of a pose the
//     upper rows of its adjoint
//   own segments: count, each: first | last | drift + 1 (0: none), as indices into the variables
//
// Reading takes time and memory in proportion to the bytes. Refused: rows that do not make one matrix, and
// segments without their variables.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/closure/overlap/overlap_cross_covariance.hpp"

namespace radioslam {

template <class Pose>
std::string write_rows(const SkeletonInformation<Pose>& information, std::size_t robot);

/// Whether these are all the bytes of some robot's rows.
template <class Pose>
bool is_rows(std::string_view bytes);

/// From the rows of every robot, in their order.
template <class Pose>
std::optional<SkeletonInformation<Pose>> read_rows(const std::vector<std::string_view>& robots);

}  // namespace radioslam
