// Which closures may take part when those that hold are chosen: what other evidence says of each alone.
//
// Where other measurements than closures relate two robots, a closure between them is set aside unless the
// keyframes before its ends are a candidate pair of the overlap search and, where radio links constrain the
// robots' relative pose, its own one passes the chi-squared test under the joint estimate. What is set aside
// can still hold: where the estimate agrees with it once others of the two robots hold (loop_selection.hpp).
// Optionally, angles of arrival measured near a closure scale its information; one that would keep less than
// half of it is excluded. Closures within one robot, and between robots that nothing else relates, all may.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/joint/aoa/aoa_match_weights.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/joint/links/radio_covariance.hpp"
#include "radioslam/joint/overlap_stage.hpp"
#include "radioslam/joint/team_alignment.hpp"
#include "radioslam/results/candidate_list.hpp"

namespace radioslam {

/// In the order of the closures. `candidates`: all that are keyframes of a closure (keyframes_of); null:
/// pairs are not pruned, and nothing is set aside.
template <class Pose>
std::vector<ClosureAdmission> admit_closures(const JointGraph<Pose>& joint,
                                             const TeamAlignment<Pose>& alignment,
                                             const std::vector<Closure>& closures,
                                             const CandidateList* candidates,
                                             const std::optional<RadioCovariance<Pose>>& radio,
                                             const AoaMatchWeights* angles);

/// The keyframes before the ends of every closure between two robots.
template <class Pose>
std::vector<KeyframePair> keyframes_of(const JointGraph<Pose>& joint, const std::vector<Closure>& closures);

}  // namespace radioslam
