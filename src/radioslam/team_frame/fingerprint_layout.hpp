// Coarse placing of robots whose starts are unknown: a layout of their trajectories whose mutual distances
// agree with what the fingerprints' similarity says. Every trajectory stays rigid.
//
// Starts: classical multidimensional scaling of all fingerprints (Torgerson 1952) with far distances cut at
// several lengths, and the mirror images; the trajectories, which may turn but not flip, tell these apart.
// From each, majorisation of the stress; the layout of least stress is kept. The stress is
//   sum w_ij (|x_i - x_j| - d_ij)^2,  w_ij = 1 / (sigma_0^2 + (r d_ij)^2),
// one robot at a time (SMACOF, de Leeuw 1977, with each robot's points bound rigidly), which never raises
// it. Pairs with hardly anything in common only push apart: their distance is a lower bound.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/measurements.hpp"

namespace radioslam {

struct LayoutParams {
  double least_similarity = 0.1;  ///< below, a distance is only a lower bound
  double sigma_m = 5;             ///< sigma_0: error of a predicted distance near zero
  double sigma_relative = 0.3;    ///< r: its relative error far away
  double pair_weight = 0.02;      ///< distances share their fingerprints' errors: one counts this much
  int least_shared = 3;           ///< access points that tie two robots: x, y and a heading are unknown
  int sweeps = 100;
  int max_nodes = 1500;  ///< more fingerprints are thinned evenly

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"least_similarity", "", 0.001, 0.9, "below it a distance is only a lower bound"},
          self.least_similarity);
    visit(Field{"sigma_m", "m", 0.1, 100, "error of a predicted distance near zero"}, self.sigma_m);
    visit(Field{"sigma_relative", "", 0, 2, "its relative error far away"}, self.sigma_relative);
    visit(Field{"pair_weight", "", 1e-4, 1, "share of a pair that is independent evidence"},
          self.pair_weight);
    visit(Field{"least_shared", "", 1, 1000, "access points that two robots must both hear to be tied"},
          self.least_shared);
    visit(Field{"sweeps", "", 1, 10000, "passes over the robots"}, self.sweeps);
    visit(Field{"max_nodes", "", 10, 20000, "more fingerprints than this are thinned"}, self.max_nodes);
  }
};

/// Where every robot's start is, seen from above, and which robots hang together.
struct TeamFrame {
  std::vector<SE2> T_team_start;  ///< per robot
  std::vector<int> component;     ///< per robot; 0 is the first robot's
  std::vector<bool> placed;       ///< false: no radio and no initial pose ties it to its component
};

/// Robots with an initial pose keep it; the others are laid out around them (or around the first robot).
TeamFrame align_by_fingerprints(const Mission& mission, const RadioMeasurements& radio,
                                const LayoutParams& params, const Progress& progress = {});

}  // namespace radioslam
