// Puts a team into one frame from its ranges and angles of arrival, none of which need be direct.
//
// Source: Wi-Closure (pairwise consistency of links) replaced by a joint likelihood: pieces are added one at
// a time, the one with the most links to the team first; places for it come from grids over all its links
// (place_search.hpp); each is refined together with the team placed so far (mixture_refinement.hpp) and
// ranked by its evidence. The best few teams are kept at every step and to the end, as hypotheses. A piece
// whose links are too few to fix it stays in a component of its own. Cost: beam x references x peaks
// refinements per piece.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/team_frame/mixture_refinement.hpp"
#include "radioslam/team_frame/place_search.hpp"

namespace radioslam {

struct BeamParams {
  int beam = 4;                ///< teams kept
  int tried_places = 80;       ///< places refined coarsely per team and piece
  int refined_places = 48;     ///< places refined per team and piece
  double same_map_m = 0.5;     ///< two teams nowhere further apart than this ...
  double same_map_sigmas = 3;  ///< ... plus this many standard deviations are one
  double overconfidence = 4;   ///< log evidence is divided by this for a hypothesis' weight

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"beam", "", 1, 100, "teams kept while robots are added"}, self.beam);
    visit(Field{"tried_places", "", 1, 10000, "places refined coarsely per team and robot"},
          self.tried_places);
    visit(Field{"refined_places", "", 1, 10000, "and those of them refined to the end, over all teams"},
          self.refined_places);
    visit(Field{"same_map_m", "m", 0, 1000, "teams nowhere further apart than this are one"},
          self.same_map_m);
    visit(Field{"same_map_sigmas", "sigma", 0, 100, "or than this many standard deviations"},
          self.same_map_sigmas);
    visit(Field{"overconfidence", "", 1, 1000,
                "links share errors: log evidence is divided by this for a hypothesis' weight"},
          self.overconfidence);
  }
};

struct RadioAlignmentParams {
  MixtureParams mixture;
  GridParams grid;
  RefinementParams refinement;
  BeamParams beam;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    MixtureParams::visit_fields(self.mixture, visit);
    GridParams::visit_fields(self.grid, visit);
    RefinementParams::visit_fields(self.refinement, visit);
    BeamParams::visit_fields(self.beam, visit);
  }
};

/// One way the team may lie.
template <class Pose>
struct TeamHypothesis {
  std::vector<Pose> poses;  ///< of the full graph
  std::vector<typename Pose::Point> points;
  std::vector<Drift> drifts;
  std::vector<double> range_weight;                 ///< posterior that each range is direct
  std::vector<std::vector<double>> path_sigma_rad;  ///< of every path of each bearing, places included
  std::vector<std::vector<double>> path_weight;     ///< posterior of every path of each bearing
  double log_evidence = 0;
  double weight = 1;
};

template <class Pose>
struct RadioAlignment {
  TeamComponents components;                     ///< 0: the first piece's
  std::vector<TeamHypothesis<Pose>> hypotheses;  ///< at least one, best first; weights sum to one
};

template <class Pose>
RadioAlignment<Pose> align_by_radio(const TeamGraph<Pose>& team, const RadioAlignmentParams& params,
                                    const Progress& progress = {});

}  // namespace radioslam
