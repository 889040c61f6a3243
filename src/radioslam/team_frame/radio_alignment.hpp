// Aligns a team in one frame from ranges and angles of arrival, any of which may be multipath or outliers.
//
// Replaces the pairwise consistency of links in Wi-Closure (Wang et al.) by a joint likelihood: trajectory
// segments are added one at a time, the one with the most links to the team first; start poses come from
// grids over all its links (pose_proposals.hpp); each is refined jointly with the team placed so far
// (mixture_refinement.hpp) and ranked by its evidence. A beam of the best teams is kept at every step
// (beam_search/team_beam_search.hpp); those left at the end are the hypotheses. A segment with too few links
// to determine its pose stays in a component of its own. Cost: beam x references x peaks refinements per
// segment.
#pragma once

#include <cstddef>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/team_frame/beam_search/radio_alignment_params.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {

/// One of the alignments that the measurements leave open.
template <class Pose>
struct TeamHypothesis {
  std::vector<Pose> poses;  ///< of the full graph
  std::vector<typename Pose::Point> points;
  std::vector<Drift> drifts;
  std::vector<double> range_weight;  ///< posterior that each range is direct
  std::vector<std::vector<double>>
      path_sigma_rad;  ///< of every path of each bearing, antenna positions included
  std::vector<std::vector<double>> path_weight;  ///< posterior of every path of each bearing
  double log_evidence = 0;
  double weight = 1;
};

template <class Pose>
struct RadioAlignment {
  TeamComponents components;                     ///< 0: the first segment's
  std::vector<TeamHypothesis<Pose>> hypotheses;  ///< at least one, best first; weights sum to one
};

template <class Pose>
RadioAlignment<Pose> align_by_radio(const TeamGraph<Pose>& team, const RadioAlignmentParams& params,
                                    const Progress& progress = {});

/// The alignment nearest to the team's values, which must be in the frames of `components`. Its evidence is
/// comparable with that of other alignments of the same team.
template <class Pose>
TeamHypothesis<Pose> refine_alignment(const TeamGraph<Pose>& team, const TeamComponents& components,
                                      const RadioAlignmentParams& params);

/// The alignments near these values of all poses, in the frames of `components`: those of the team as it was
/// known before, say. Each is refined twice, as it is and with the variances of the odometry's drift, without
/// which links after a long time without any pass for outliers. Alike ones are one.
template <class Pose>
RadioAlignment<Pose> refine_alignments(const TeamGraph<Pose>& team, const TeamComponents& components,
                                       const std::vector<std::vector<Pose>>& starts,
                                       const RadioAlignmentParams& params);

/// The team's values as they are, with the weight of every range and path there; the evidence is the log
/// likelihood.
template <class Pose>
TeamHypothesis<Pose> weigh_links(const TeamGraph<Pose>& team, const TeamComponents& components,
                                 const MixtureParams& params);

}  // namespace radioslam
