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

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/closure/overlap/overlap_search.hpp"
#include "radioslam/joint/joint_graph.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

/// Source of the relative covariances.
enum class OverlapMode {
  kJoint,
  kLink,  ///< reproduces Wi-Closure where ranges have angles at both ends
};

struct OverlapStageParams {
  OverlapParams overlap;
  double radius_m = 0;
  std::string mode = "joint";
  double pairing_s = 1;
  int max_links = 200;
  int max_listed_candidates = 1000000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    OverlapParams::visit_fields(self.overlap, visit);
    RADIOSLAM_FIELD(radius_m, "m", 0, 1e5,
                    "distance within which two keyframes overlap, whatever their scanners see; 0: by the "
                    "scanners' ranges and min_shared_view");
    RADIOSLAM_FIELD(mode, "", 0, 0,
                    "relative covariances; joint: of the joint estimate; link: odometry over the nearest "
                    "range with angles at both ends (Wang et al.), else the joint pose at a link",
                    "joint|link");
    RADIOSLAM_FIELD(pairing_s, "s", 0, 1e6,
                    "largest time difference between a range and its angles, in mode link");
    RADIOSLAM_FIELD(max_links, "", 1, 1e6,
                    "largest number of links per pair of robots in mode link; more are thinned evenly");
    RADIOSLAM_FIELD(
        max_listed_candidates, "", 0, 2e9,
        "largest number of candidates that `run` lists and draws: the most probable ones; prune lists all");
  }
};

inline OverlapMode overlap_mode(const OverlapStageParams& params) {
  return params.mode == "link" ? OverlapMode::kLink : OverlapMode::kJoint;
}

/// Keyframes of two robots.
struct KeyframePair {
  RobotIndex robot_i;
  Stamp stamp_i;
  RobotIndex robot_j;
  Stamp stamp_j;
};

/// Receives all candidates, by robots, then keyframes; `keyframes` has the stamps that a group's rows refer
/// to.
using TakeCandidates = std::function<void(const CandidateList::Group& group, const CandidateList& keyframes)>;

/// What becomes of the candidates, which may be too many to be kept.
struct OverlapRequest {
  SearchMethod method = SearchMethod::kTree;
  std::size_t max_listed = 0;       ///< the most probable ones are listed
  std::vector<KeyframePair> asked;  ///< pairs of which it must be known whether they are candidates
  TakeCandidates take;              ///< receives every candidate; may be empty
};

struct OverlapStage {
  CandidateList listed;
  CandidateList of_asked;                  ///< candidates, listed or not, that were asked for
  OverlapCounts counts;                    ///< of all candidates
  bool searched = false;                   ///< false: the estimate's covariances are not computable
  std::optional<ExchangeResult> exchange;  ///< of a distributed search
  std::size_t alignments = 1;              ///< number of team alignments whose candidates these are
  bool estimated_links = false;            ///< mode link: no range had angles at both ends
  std::vector<std::pair<RobotIndex, RobotIndex>> unlinked;  ///< mode link: not compared, for want of a link
};

/// `alignments`: the likely ones, optimized and placed, the likeliest first. Candidates are those of any of
/// them; of a pair in several, the nearest one in standard deviations. An alignment whose covariances are not
/// computable is left out; if that is the first one, nothing is searched. In mode link all are one, the
/// first.
template <class Pose>
OverlapStage find_overlaps(std::vector<JointGraph<Pose>> alignments, const OverlapStageParams& params,
                           const OverlapRequest& request);

}  // namespace radioslam
