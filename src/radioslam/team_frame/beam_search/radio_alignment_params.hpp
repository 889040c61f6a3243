// Parameters of the team alignment by ranges and angles of arrival (radio_alignment.hpp).
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/team_frame/mixture_refinement.hpp"
#include "radioslam/team_frame/pose_proposals.hpp"

namespace radioslam {

struct BeamParams {
  int beam = 4;
  int tried_places = 80;
  int refined_places = 48;
  double same_map_m = 0.5;
  double same_map_sigmas = 1;
  double evidence_temperature = 4;
  int joint_segments = 4;
  int neighbours = 3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(
        beam, "", 1, 100,
        "number of team alignments kept while robots are added; higher values search more broadly");
    RADIOSLAM_FIELD(tried_places, "", 1, 10000,
                    "number of start poses refined coarsely per team alignment and robot");
    RADIOSLAM_FIELD(refined_places, "", 1, 10000,
                    "number of start poses per robot refined to convergence, over all team alignments kept");
    RADIOSLAM_FIELD(same_map_m, "m", 0, 1000,
                    "distance below which all corresponding poses of two alignments count as one hypothesis");
    RADIOSLAM_FIELD(
        same_map_sigmas, "sigma", 0, 100,
        "tolerance added to same_map_m when alignments are merged, in standard deviations of a pose");
    RADIOSLAM_FIELD(evidence_temperature, "", 1, 1000,
                    "divisor of the log evidence of a hypothesis, since links share errors; higher values "
                    "even out the weights");
    RADIOSLAM_FIELD(joint_segments, "", 2, 1000,
                    "trajectory segments of the largest team refined as a whole at every step; higher values "
                    "search more thoroughly, at a cost of their fourth power");
    RADIOSLAM_FIELD(
        neighbours, "", 1, 100,
        "number of placed segments with which a further segment of a larger team is refined jointly");
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

}  // namespace radioslam
