// Anchor layout: positions of static anchors from the distances between them, with outlier rejection.
// Source: Wi-Closure 4.3.2, ground truth without motion capture; the fit is in anchor_distances.hpp.
//
// Frame: one anchor is the origin, a second one is on +x, a third one has y > 0 (and z = 0 in 3D), a fourth
// one has z > 0. Distances do not observe reflections: the caller must know that the third anchor is to the
// left of the line from the first to the second, seen from above. By default these are the first anchors
// listed, the third (fourth) being the first that is clearly off the line (plane).
//
// Outliers: the distance with the largest standardised residual is rejected while its deletion residual
// exceeds `outlier_sigmas`, with the stated noise or, if larger, the noise estimated from the other
// distances. At least two redundant distances must remain.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/radio/ranging/anchor_distances.hpp"

namespace radioslam {

struct AnchorLayoutParams {
  int dimension = 2;
  double outlier_sigmas = 4;
  double flatness_sigmas = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(dimension, "", 2, 3,
                    "dimension of the layout: 2 for horizontal distances, 3 for spatial ones");
    RADIOSLAM_FIELD(
        outlier_sigmas, "", 2, 100,
        "deletion residual above which a distance is rejected as an outlier; higher values reject fewer");
    RADIOSLAM_FIELD(
        flatness_sigmas, "", 1, 100,
        "significance, in sigmas, with which the anchors must not be collinear (in 3D: coplanar)");
  }
};

/// Anchors that define the frame; those not given are chosen by default.
struct AnchorFrame {
  std::optional<std::size_t> origin, along_x, left;
};

enum class LayoutRefusal {
  kTooFewAnchors,      ///< fewer than dimension + 1
  kDisconnected,       ///< no chain of distances connects `anchor` to the first one
  kPoorlyConstrained,  ///< too few distances: `anchor`, the one with fewest, can move
  kFlat,               ///< collinear (coplanar) within the distances' noise
  kFrame,              ///< the anchors that define the frame are collinear or not distinct
};

struct LayoutFailure {
  LayoutRefusal reason = LayoutRefusal::kTooFewAnchors;
  std::size_t anchor = 0;
};

struct AnchorLayout {
  Eigen::Matrix3Xd positions_m;     ///< z = 0 in the plane
  std::vector<double> sigmas_m;     ///< per anchor and axis, relative to the layout as a whole
  std::vector<double> residuals_m;  ///< per distance: distance in the layout minus measured distance
  std::vector<bool> used;           ///< per distance: false if rejected as an outlier
  double rms_m = 0;                 ///< of the residuals used
  double noise_factor = 1;          ///< noise of the distances relative to their stated sigmas
  std::ptrdiff_t redundancy = 0;    ///< 0: errors undetectable; 1: detectable, not attributable
};

/// Estimates the layout. The distances' sigmas must be positive.
std::variant<AnchorLayout, LayoutFailure> estimate_anchor_layout(std::size_t anchors,
                                                                 const std::vector<AnchorDistance>& distances,
                                                                 const AnchorFrame& frame = {},
                                                                 const AnchorLayoutParams& params = {});

}  // namespace radioslam
