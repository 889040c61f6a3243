// A relative pose's error E as a vector, and its derivative under E <- E Exp(xi). Charts: PoseChart.
#pragma once

#include "radioslam/graph/pose_graph.hpp"

namespace radioslam {

SE2::Tangent chart_error(PoseChart chart, const SE2& error);
SE3::Tangent chart_error(PoseChart chart, const SE3& error);

/// d chart(E Exp(xi)) / d xi at xi = 0.
SE2::Jacobian chart_derivative(PoseChart chart, const SE2& error);
SE3::Jacobian chart_derivative(PoseChart chart, const SE3& error);

}  // namespace radioslam
