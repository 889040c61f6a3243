// Position fixes from access points at known positions: where a fingerprint was taken, by the strengths of
// those that it has.
//
//   P_k = P0 - 10 n log10 d_k + e_k,   d_k^2 = |x - a_k|^2 + height^2
//
// for access point k at a_k, with e_k ~ N(0, known_sigma_db^2) independent: the shadowing, and how one
// transmitter differs from another. A known access point that is not detected is below the threshold (a Tobit
// term, bounded because it may be off). P0 and n are those of the team: of a grid of values around the priors
// of the path loss model (access_points.hpp), each has the weight of its evidence, which is that of all
// fingerprints (a quarter of it, because errors of the model are correlated). The posterior of x is summed
// over a grid around the access points (Huber's loss) and over the models; its mean and the larger axis of
// its second moment are the fix: what is ambiguous has a large sigma. One fingerprint is used per
// `known_spacing_m` of path.
//
// Fixes share errors: one transmitter is 6 dB stronger wherever it is received, or 2 m off, and shadowing is
// the same within metres. To first order a fix i moves by sum_k G_ik e_ik, G_ik the gain on the power of
// access point k, so that
//   C_ij = sum_k G_ik G_jk^T (transmitter^2 + shadowing^2 exp(-|x_i - x_j| / shadowing_length_m)
//                             + slope_ik . slope_jk sigma_k^2 + [i = j] fading^2),
// where transmitter^2 is what shadowing and fading leave of known_sigma_db^2. A fix counts as one with the
// others by n_i = sum_j max(0, trace C_ij / sqrt(trace C_ii trace C_jj)) over the team, and its variance is
// n_i times its own, so that the weight of all together is that of the independent ones among them.
//
// One access point at a wrong position is an outlier in the fixes (Huber's loss) or makes some of them
// outliers, which those who use them have to reject. Metres, in the frame of the given positions; heights are
// not estimated, so this is for missions in the plane. Cost: 21 models times the cells times the access
// points, and times the readings of all fingerprints; and the square of the fixes times the access points.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/known_access_points.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/fingerprints/access_points.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"

namespace radioslam {

struct AccessPointFixParams {
  bool use_known = true;
  int known_at_once = 3;
  double known_spacing_m = 8;
  double known_sigma_db = 8;
  double known_margin_m = 25;
  int known_cells = 48;
  double known_max_sigma_m = 15;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(use_known, "", 0, 0,
                    "whether access points at known positions (radio/anchors.csv) give position fixes");
    RADIOSLAM_FIELD(known_at_once, "", 3, 1000,
                    "smallest number of known access points in a fingerprint that gives a position fix");
    RADIOSLAM_FIELD(known_spacing_m, "m", 0.1, 1e4, "path length between position fixes by access points");
    RADIOSLAM_FIELD(
        known_sigma_db, "dB", 0.1, 100,
        "standard deviation of a known access point's RSS about the path loss model, shadowing and "
        "differences of transmitters included");
    RADIOSLAM_FIELD(known_margin_m, "m", 0, 1e4,
                    "margin around the known access points within which a fingerprint is searched");
    RADIOSLAM_FIELD(known_cells, "", 4, 1000, "number of cells along each side of the searched rectangle");
    RADIOSLAM_FIELD(known_max_sigma_m, "m", 0.1, 1e4, "largest standard deviation of a fix by access points");
  }
};

struct AccessPointFixes {
  std::vector<KnownAccessPoint> known;           ///< received by any robot
  std::vector<std::vector<PositionFix>> robots;  ///< per robot, in time order
};

/// Fixes of the robots that have none of their own; `fingerprints` per robot, as in RadioMeasurements.
AccessPointFixes fixes_by_access_points(const Mission& mission,
                                        const std::vector<std::vector<PlacedFingerprint>>& fingerprints,
                                        const AccessPointFixParams& params, const AccessPointParams& model);

}  // namespace radioslam
