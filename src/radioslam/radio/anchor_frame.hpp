// The frame of a layout whose turn, shift and handedness are open: origin, direction of +x, side of +y.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "radioslam/radio/anchor_layout.hpp"

namespace radioslam {

/// The points in the frame that these anchors fix (anchor_layout.hpp); nothing where those asked for are on
/// one line or not distinct. By default a point counts as off the line (plane) when it is at least
/// `clearance` of the layout's extent away from it.
std::optional<Eigen::MatrixXd> in_anchor_frame(const Eigen::MatrixXd& points, const AnchorFrame& frame,
                                               double clearance);

}  // namespace radioslam
