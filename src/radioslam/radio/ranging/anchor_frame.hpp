// Anchor frame: origin, direction of +x and side of +y for a layout known up to rigid motion and reflection.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "radioslam/radio/ranging/anchor_layout.hpp"

namespace radioslam {

/// The points in the frame that these anchors define (anchor_layout.hpp); nothing where the requested anchors
/// are collinear or not distinct. A point counts as off the line (plane) from a distance of `clearance` times
/// the layout's extent.
std::optional<Eigen::MatrixXd> in_anchor_frame(const Eigen::MatrixXd& points, const AnchorFrame& frame,
                                               double clearance);

}  // namespace radioslam
