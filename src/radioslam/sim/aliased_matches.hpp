// Relative poses as someone else's place recognition would report them: true ones, and false ones that agree
// with each other because a place looks like another one.
//
// A true match is T_i_j of two poses near each other, at any two times. An alias is a fixed motion S of the
// common frame: robot j's places look as if they lay at S times where they are, so a false match is
// T_i^-1 S T_j of two poses that are near each other after S. Both carry Gaussian noise on the right.
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

/// How many matches there are and how good.
struct AliasedMatchParams {
  int matches_true = 0;
  int matches_false = 0;
  int aliases = 1;
  double sigma_match_t_m = 0.2;
  double sigma_match_r_deg = 2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"matches_true", "", 0, 1e6, "true matches between robots; 40 in the usual hard case"},
          self.matches_true);
    visit(Field{"matches_false", "", 0, 1e6, "aliased matches between robots; 120 in the usual hard case"},
          self.matches_false);
    visit(Field{"aliases", "", 1, 10000, "groups of aliased matches; each agrees with itself"}, self.aliases);
    visit(Field{"sigma_match_t_m", "m", 0.001, 100, "noise of a match's position, per axis"},
          self.sigma_match_t_m);
    visit(Field{"sigma_match_r_deg", "deg", 0.01, 90, "noise of a match's rotation, per axis"},
          self.sigma_match_r_deg);
  }
};

/// Matches in the order of their times, and which are true (see Truth).
struct LabelledMatches {
  std::vector<PoseMatch> matches;
  std::vector<std::optional<bool>> true_matches;
};

/// Draws a motion S by which places of trajectory j look like places of trajectory i.
using DrawAlias = std::function<SE3(const Trajectory<SE3>& i, const Trajectory<SE3>& j, Rng& rng)>;

/// S that lays a random pose of j onto a random pose of i at least `apart_m` away, upright (only turned about
/// the vertical): a street that looks like another one.
DrawAlias place_alias(double apart_m);

/// Matches between different robots that move along `truth`, nearer than `within_m` (after S). Fewer than
/// asked for where there are not so many pairs. Dimension 2 leaves height, roll and pitch alone.
LabelledMatches simulate_matches(const std::vector<Trajectory<SE3>>& truth, int dimension, double within_m,
                                 const DrawAlias& draw_alias, const AliasedMatchParams& params,
                                 const Rng& rng);

}  // namespace radioslam
