// Simulated matches of an external place recognition: true relative poses, and false ones that are mutually
// consistent because places look alike (perceptual aliasing).
//
// A true match is T_i_j of two poses close to each other, at any two times. An alias is a fixed motion S of
// the common frame: robot j's surroundings look like those at S times its pose, so a false match is T_i^-1 S
// T_j of two poses that are close to each other after S. Both carry Gaussian noise on the right.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Numbers and noise of matches.
struct AliasedMatchParams {
  int matches_true = 0;
  int matches_false = 0;
  int aliases = 1;
  double sigma_match_t_m = 0.2;
  double sigma_match_r_deg = 2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(matches_true, "", 0, 1e6,
                          "number of true matches between robots; 40 in the standard hard case");
    RADIOSLAM_BASIC_FIELD(matches_false, "", 0, 1e6,
                          "number of aliased matches between robots; 120 in the standard hard case");
    RADIOSLAM_FIELD(aliases, "", 1, 10000,
                    "number of groups of aliased matches; each is consistent in itself");
    RADIOSLAM_FIELD(sigma_match_t_m, "m", 0.001, 100, "standard deviation of a match's position, per axis");
    RADIOSLAM_FIELD(sigma_match_r_deg, "deg", 0.01, 90, "standard deviation of a match's rotation, per axis");
  }
};

/// Matches in temporal order, and which are true (see Truth).
struct LabelledMatches {
  std::vector<PoseMatch> matches;
  std::vector<std::optional<bool>> true_matches;
};

/// Draws a motion S under which trajectory j looks like parts of trajectory i.
using DrawAlias = std::function<SE3(const Trajectory<SE3>& i, const Trajectory<SE3>& j, Rng& rng)>;

/// Upright S (rotation about the vertical only) that moves a random pose of j onto a random pose of i at
/// least `apart_m` away: a street that looks like another one.
DrawAlias upright_alias(double apart_m);

/// Matches between different robots that move along `truth`, closer than `within_m` (after S). Fewer than
/// requested if there are not enough pairs. Dimension 2 keeps height, roll and pitch free of noise.
LabelledMatches simulate_matches(const std::vector<Trajectory<SE3>>& truth, int dimension, double within_m,
                                 const DrawAlias& draw_alias, const AliasedMatchParams& params,
                                 const Rng& rng);

}  // namespace radioslam
