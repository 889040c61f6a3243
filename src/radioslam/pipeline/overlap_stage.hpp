// The overlap search on a joint estimate: which keyframes of different robots may have seen the same place.
//   joint   relative covariances from the joint estimate's marginals
//   link    as in Wi-Closure: every robot keeps its own odometry, and a pair is compared over the measured
//   link
//           with the shortest way to it. A link is a range with an angle at both ends within `pairing_s` of
//           it, direct paths as the alignment chose them: T_a_b = (d (cos phi, sin phi), phi + pi - psi),
//           with the covariance of range and angles. Where a mission has no such links, the relative poses
//           that the joint estimate gives at its radio links take their place.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/overlap_search.hpp"
#include "radioslam/pipeline/joint_graph.hpp"
#include "radioslam/pipeline/team_placement.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

enum class SearchMethod {
  kTree,
  kExhaustive,  ///< tests every pair; the same answer
};

struct OverlapStageParams {
  OverlapParams overlap;
  std::string mode = "joint";
  double pairing_s = 1;
  int most_links = 200;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    OverlapParams::visit_fields(self.overlap, visit);
    visit(Field{"mode", "", 0, 0, "joint: covariances of the joint estimate; link: over the nearest link",
                "joint|link"},
          self.mode);
    visit(Field{"pairing_s", "s", 0, 1e6, "mode link: a range and its angles are at most this far apart"},
          self.pairing_s);
    visit(Field{"most_links", "", 1, 1e6, "mode link: more links per pair of robots are thinned"},
          self.most_links);
  }
};

struct OverlapStage {
  std::vector<CandidateResult> candidates;
  OverlapCounts counts;
  bool searched = false;  ///< false: the estimate's covariances cannot be computed
};

/// `joint` is optimised and placed.
template <class Pose>
OverlapStage find_overlaps(const JointGraph<Pose>& joint, const OverlapStageParams& params,
                           SearchMethod method);

}  // namespace radioslam
