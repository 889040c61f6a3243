// Every parameter of a run, by section.
#pragma once

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/pipeline/access_point_stage.hpp"
#include "radioslam/pipeline/angle_checks.hpp"
#include "radioslam/pipeline/csi_params.hpp"
#include "radioslam/pipeline/fix_stage.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/match_angles.hpp"
#include "radioslam/pipeline/overlap_stage.hpp"
#include "radioslam/pipeline/range_biases.hpp"
#include "radioslam/pipeline/robust_solution.hpp"
#include "radioslam/pipeline/scan_picture.hpp"
#include "radioslam/pipeline/scan_stage.hpp"
#include "radioslam/pipeline/sequence_stage.hpp"
#include "radioslam/radio/arrival_likelihood.hpp"
#include "radioslam/radio/measurements.hpp"
#include "radioslam/team_frame/field_refinement.hpp"
#include "radioslam/team_frame/fingerprint_layout.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

struct RunParams {
  KeyframeParams keyframe;
  RadioParams radio;
  ScanParams scans;
  ScanPictureParams scan_picture;
  CsiStageParams csi;
  LayoutParams team_frame;
  FieldParams field;
  RadioAlignmentParams alignment;
  FingerprintClosureParams closure;
  SequenceStageParams sequence;
  JointGraphParams graph;
  FixParams fixes;
  TeamBiasParams range_bias;
  OverlapStageParams overlap;
  MatchParams matches;
  ArrivalLikelihoodParams angles;
  AngleCheckParams angle_check;
  AccessPointStageParams access_points;
  RobustParams robust;
  /// Distances from fingerprints are good to metres: a millionth of the cost decides nothing.
  OptimizerParams optimizer{.max_iterations = 30, .relative_cost_tolerance = 1e-5};

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("keyframe", self.keyframe);
    visit("radio", self.radio);
    ScanParams::visit_sections(self.scans, visit);
    visit("scan_picture", self.scan_picture);
    visit("csi", self.csi);
    visit("team_frame", self.team_frame);
    visit("field", self.field);
    visit("alignment", self.alignment);
    visit("closure", self.closure);
    visit("sequence", self.sequence);
    visit("graph", self.graph);
    visit("fixes", self.fixes);
    visit("range_bias", self.range_bias);
    visit("overlap", self.overlap);
    visit("matches", self.matches);
    visit("angles", self.angles);
    visit("angle_check", self.angle_check);
    visit("access_points", self.access_points);
    visit("robust", self.robust);
    visit("optimizer", self.optimizer);
  }
};

}  // namespace radioslam
