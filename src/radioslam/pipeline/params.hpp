// All parameters of a run, by section.
#pragma once

#include <optional>

#include "radioslam/closure/fingerprint_closures.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"
#include "radioslam/consistency/consistency_params.hpp"
#include "radioslam/graph/optimizer.hpp"
#include "radioslam/joint/access_point_stage.hpp"
#include "radioslam/joint/aoa/aoa_integrity.hpp"
#include "radioslam/joint/aoa/aoa_match_weights.hpp"
#include "radioslam/joint/graduated_optimization.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/links/range_biases.hpp"
#include "radioslam/joint/overlap_stage.hpp"
#include "radioslam/joint/places/place_recognition.hpp"
#include "radioslam/joint/places/verification_budget.hpp"
#include "radioslam/joint/position_fixes/placement.hpp"
#include "radioslam/joint/sequence_stage.hpp"
#include "radioslam/map/map_params.hpp"
#include "radioslam/mission/keyframes.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"
#include "radioslam/radio/captures/csi_params.hpp"
#include "radioslam/radio/fingerprints/measurements.hpp"
#include "radioslam/team_frame/field_refinement.hpp"
#include "radioslam/team_frame/fingerprint_layout.hpp"
#include "radioslam/team_frame/radio_alignment.hpp"

namespace radioslam {

struct RunParams {
  KeyframeParams keyframe;
  RadioParams radio;
  ScanParams scans;
  CsiStageParams csi;
  LayoutParams team_frame;
  FieldParams field;
  RadioAlignmentParams alignment;
  FingerprintClosureParams closure;
  SequenceStageParams sequence;
  JointGraphParams graph;
  FixParams fixes;
  RangeBiasPriorParams range_bias;
  OverlapStageParams overlap;
  PlaceParams places;
  MatchParams matches;
  ConsistencyParams consistency;
  AoaLikelihoodParams angles;
  AoaIntegrityParams angle_check;
  AccessPointStageParams access_points;
  MapParams map;
  RobustParams robust;
  /// Predicted fingerprint distances are accurate to metres, so a tighter tolerance changes nothing.
  OptimizerParams optimizer{.max_iterations = 30, .relative_cost_tolerance = 1e-5};

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("keyframe", self.keyframe);
    visit("radio", self.radio);
    ScanParams::visit_sections(self.scans, visit);
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
    visit("places", self.places);
    visit("matches", self.matches);
    visit("consistency", self.consistency);
    visit("angles", self.angles);
    visit("angle_check", self.angle_check);
    visit("access_points", self.access_points);
    visit("map", self.map);
    visit("robust", self.robust);
    visit("optimizer", self.optimizer);
  }
};

// How far a run goes, and what it skips.

enum class Pruning {
  kOn,
  kOff,  ///< every closure may take part, to measure the effect of pruning
};

struct RunOptions {
  Pruning pruning = Pruning::kOn;
  SearchMethod search = SearchMethod::kTree;
  bool overlap_only = false;                             ///< stop after the overlap search
  bool lists_overlaps = true;                            ///< false: only those of closures are asked for
  std::optional<VerificationBudget> verifications = {};  ///< scans of different robots that are registered
  /// Receives every candidate as the search finds it; then none is listed in the result.
  TakeCandidates take_candidates = nullptr;
};

}  // namespace radioslam
