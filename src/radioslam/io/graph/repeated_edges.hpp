// Whether two edges are one measurement written twice. Programs write an edge between two robots into the
// files of both: with the same numbers, with fewer digits, or as its inverse, seen from the other robot.
//
// Two edges repeat each other if one is the other, or its inverse, up to the digits that both are printed
// with. How many these are, the shortest decimal form of the numbers shows; fewer than four significant
// digits of the longest number count as four. Numbers of the same many digits are copies only if they are
// equal. An inverse may keep the matrix of information or carry it over.
#pragma once

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

/// The inverse measurement: (Z Exp(xi))^-1 = Z^-1 Exp(-Ad(Z) xi).
template <class Pose>
RelativePoseFactor<Pose> reversed(const RelativePoseFactor<Pose>& factor);

/// Both from i to j and equal up to the rounding of typically six digits.
template <class Pose>
bool are_equal_edges(const RelativePoseFactor<Pose>& a, const RelativePoseFactor<Pose>& b);

/// Between the same two poses in either direction.
template <class Pose>
bool are_repeated_edges(const RelativePoseFactor<Pose>& a, const RelativePoseFactor<Pose>& b);

}  // namespace radioslam
