// Beam search for a team's alignment: grows components by one trajectory segment or point at a time
// (placement_order.hpp). Every step proposes start poses of the unit for each team of the beam, refines the
// different ones jointly with all that is placed (partial_mixture.hpp) and keeps the best different teams
// (beam_selection.hpp). The first component has all segments with a known start.
//
// In a team of more than `joint_segments` segments and no points, from the third segment of a component on
// each is placed jointly with its best-linked neighbours only (local_placement.hpp), so that the cost of a
// segment does not grow with the team; the whole component is refined after each step while it is small, then
// when several alignments are left or it has grown by half.
#pragma once

#include <utility>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/team_frame/beam_search/beam_selection.hpp"

namespace radioslam {

/// Keeps references to its arguments.
template <class Pose>
class TeamBeamSearch {
 public:
  TeamBeamSearch(const TeamGraph<Pose>& team, const RadioAlignmentParams& params, const Progress& progress);

  void run();

  /// For parts of a search: values and components to start from, and one unit added to a component.
  void start_from(TeamValues<Pose> values, TeamComponents components);
  void refine_start() { refine_beam(); }
  void add_jointly(int component, const UnplacedNode& unit);

  const TeamComponents& components() const { return components_; }
  /// At least one, the team with the most evidence first.
  const std::vector<TeamValues<Pose>>& beam() const { return beam_; }

 private:
  using Starts = std::vector<RefinementStart<Pose>>;
  using Connected = ConnectedTeam<Pose>;

  bool take_known_starts(int component);
  void refine_known_starts();
  void grow(int component);
  void adopt_sighted_points(int component);
  void add(int component, const UnplacedNode& unit);
  void add_locally(int component, std::size_t segment);
  std::size_t segments_of(int component) const;
  std::vector<TeamValues<Pose>> refined_gradually(std::vector<TeamValues<Pose>> teams) const;
  std::vector<std::pair<std::size_t, PoseProposal>> proposals_for_beam(int component,
                                                                       const UnplacedNode& unit) const;
  Starts refined_coarsely(const std::vector<std::pair<std::size_t, PoseProposal>>& proposals,
                          const UnplacedNode& unit, const Connected& connected) const;
  std::vector<TeamValues<Pose>> refined(const Starts& starts, const Connected& connected) const;
  void move_unit(TeamValues<Pose>& team, const UnplacedNode& unit, const PoseProposal& proposal) const;
  void return_first_pose(TeamValues<Pose>& team, const UnplacedNode& unit) const;
  MixtureGraph<Pose> mixture(const Connected& connected, const TeamValues<Pose>& at) const;
  void keep_best(std::vector<TeamValues<Pose>> teams);
  void refine_beam();

  const TeamGraph<Pose>& team_;
  const RadioAlignmentParams& params_;
  const Progress& progress_;
  TeamComponents components_;
  std::vector<TeamValues<Pose>> beam_;
  int width_;                        ///< of the beam
  std::size_t next_refinement_ = 0;  ///< number of segments at which the whole component is refined again
};

}  // namespace radioslam
