// Overlap search on a joint estimate: finds keyframe pairs of different robots whose views can overlap.
//   joint   relative covariances from the joint estimate's marginals
//   link    as in Wi-Closure (Wang et al.): robots keep their odometry, and a pair is compared over the
//           measured
//           link with the shortest path to it. A link is a range with an angle of arrival at both ends within
//           `pairing_s`, direct paths as selected by the alignment:
//             T_a_b = (d (cos phi, sin phi), phi + pi - psi),
//           with the covariance of range and angles. Missions without such links use the joint estimate's
//           relative poses at their radio links instead.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_placement.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

enum class SearchMethod {
  kTree,
  kExhaustive,  ///< tests every pair; same result
};

/// Source of the relative covariances.
enum class OverlapMode {
  kJoint,
  kLink,  ///< reproduces Wi-Closure
};

struct OverlapStageParams {
  OverlapParams overlap;
  std::string mode = "joint";
  double pairing_s = 1;
  int max_links = 200;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    OverlapParams::visit_fields(self.overlap, visit);
    visit(Field{"mode", "", 0, 0,
                "source of relative covariances; joint: marginals of the joint estimate; link: odometry over "
                "the nearest link, reproduces Wi-Closure (Wang et al.)",
                "joint|link"},
          self.mode);
    visit(Field{"pairing_s", "s", 0, 1e6,
                "largest time difference between a range and its angles, in mode link"},
          self.pairing_s);
    visit(Field{"max_links", "", 1, 1e6,
                "largest number of links per pair of robots in mode link; more are thinned evenly"},
          self.max_links);
  }
};

inline OverlapMode overlap_mode(const OverlapStageParams& params) {
  return params.mode == "link" ? OverlapMode::kLink : OverlapMode::kJoint;
}

struct OverlapStage {
  CandidateList candidates;
  OverlapCounts counts;
  bool searched = false;       ///< false: the estimate's covariances are not computable
  std::size_t alignments = 1;  ///< number of team alignments whose candidates these are
};

/// Adds the candidates of another alignment; of a pair in both, the nearer one stays.
void add_candidates(OverlapStage& stage, const OverlapStage& other);

/// `joint` must be optimised and placed.
template <class Pose>
OverlapStage find_overlaps(const JointGraph<Pose>& joint, const OverlapStageParams& params,
                           SearchMethod method);

}  // namespace radioslam
