// Where static anchors stand, from distances between them (ground truth without motion capture, Wi-Closure
// 4.3.2): a fit of their distances (anchor_distances.hpp) put into a frame, with gross errors set aside.
//
// The frame: one anchor is the origin, a second one lies on +x, a third one has y > 0 (in space: and z = 0),
// a fourth one z > 0. Distances cannot tell a layout from its mirror image: that the third anchor is to the
// left of the way from the first to the second, seen from above, is for the caller to know. By default they
// are the first ones listed, the third (fourth) being the first that is clearly off the line (plane).
//
// Gross errors: the distance with the largest standardised residual is set aside as long as it is further off
// than `outlier_sigmas` deletion residuals, the noise being the stated one or, if larger, the one that the
// other distances show without it. Two redundant distances must be left to judge it by.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/anchor_distances.hpp"

namespace radioslam {

struct AnchorLayoutParams {
  int dimension = 2;
  double outlier_sigmas = 4;   ///< deletion residual that sets a distance aside
  double flatness_sigmas = 5;  ///< how surely the anchors must not lie on a line (plane)

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"dimension", "", 2, 3, "of the layout: 2 for horizontal distances, 3 in space"},
          self.dimension);
    visit(Field{"outlier_sigmas", "", 2, 100, "a distance further off than this is set aside; ours"},
          self.outlier_sigmas);
    visit(Field{"flatness_sigmas", "", 1, 100, "how surely anchors must not stand on one line; ours"},
          self.flatness_sigmas);
  }
};

/// Which anchors fix the frame, as far as given.
struct AnchorFrame {
  std::optional<std::size_t> origin, along_x, left;
};

enum class LayoutRefusal {
  kTooFewAnchors,  ///< less than dimension + 1
  kDisconnected,   ///< `anchor` is tied to the first one by no chain of distances
  kLoose,          ///< distances are missing: `anchor` (that with fewest) can move
  kFlat,           ///< on one line (plane) as far as the distances tell: the side is left open
  kFrame,          ///< the anchors asked to fix the frame are on one line or not distinct
};

struct LayoutFailure {
  LayoutRefusal reason = LayoutRefusal::kTooFewAnchors;
  std::size_t anchor = 0;
};

struct AnchorLayout {
  Eigen::Matrix3Xd positions_m;     ///< z = 0 in the plane
  std::vector<double> sigmas_m;     ///< per anchor and axis, relative to the layout as a whole
  std::vector<double> residuals_m;  ///< per distance: of the layout, less the measured one
  std::vector<bool> used;           ///< per distance: false when set aside as a gross error
  double rms_m = 0;                 ///< of the residuals used
  double noise_factor = 1;          ///< of the distances, over their stated sigmas
  std::ptrdiff_t redundancy = 0;    ///< 0: nothing can be checked; 1: an error shows, but not where
};

/// sigmas of the distances must be positive.
std::variant<AnchorLayout, LayoutFailure> lay_out_anchors(std::size_t anchors,
                                                          const std::vector<AnchorDistance>& distances,
                                                          const AnchorFrame& frame = {},
                                                          const AnchorLayoutParams& params = {});

}  // namespace radioslam
