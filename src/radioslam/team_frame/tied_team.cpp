#include "radioslam/team_frame/tied_team.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// Whether two ends share a frame.
template <class Pose>
class Frames {
 public:
  Frames(const TeamGraph<Pose>& team, const TeamComponents& components)
      : piece_of_(piece_of_poses(team)), components_(components) {}

  bool together(const RangeEnd<Pose>& a, const RangeEnd<Pose>& b) const {
    if (a.pose.valid() && b.pose.valid() && piece(a) == piece(b)) return true;
    return component(a) >= 0 && component(a) == component(b);
  }
  bool together(PoseId a, const RangeEnd<Pose>& b) const {
    return together(RangeEnd<Pose>{a, {}, Pose::Point::Zero()}, b);
  }
  bool together(PoseId a, PoseId b) const { return together(a, RangeEnd<Pose>{b, {}, Pose::Point::Zero()}); }

 private:
  std::size_t piece(const RangeEnd<Pose>& end) const { return piece_of_[end.pose.index()]; }
  int component(const RangeEnd<Pose>& end) const {
    return end.pose.valid() ? components_.of_piece[piece(end)] : components_.of_point[end.point.index()];
  }

  std::vector<std::size_t> piece_of_;
  const TeamComponents& components_;
};

}  // namespace

template <class Pose>
std::vector<std::size_t> piece_of_poses(const TeamGraph<Pose>& team) {
  std::vector<std::size_t> piece_of(team.graph.poses.size());
  for (std::size_t p = 0; p < team.pieces.size(); ++p)
    std::fill_n(piece_of.begin() + static_cast<std::ptrdiff_t>(team.pieces[p].first_pose),
                team.pieces[p].pose_count, p);
  return piece_of;
}

template <class Pose>
TiedTeam<Pose> tied_team(const TeamGraph<Pose>& team, const TeamComponents& components) {
  const Frames<Pose> frames(team, components);
  TiedTeam<Pose> tied{team, {}, {}};
  tied.team.graph.ranges.clear();
  tied.team.bearings.clear();
  for (std::size_t k = 0; k < team.graph.ranges.size(); ++k)
    if (frames.together(team.graph.ranges[k].i, team.graph.ranges[k].j)) {
      tied.ranges.push_back(k);
      tied.team.graph.ranges.push_back(team.graph.ranges[k]);
    }
  for (std::size_t k = 0; k < team.bearings.size(); ++k)
    if (frames.together(team.bearings[k].i, team.bearings[k].j)) {
      tied.bearings.push_back(k);
      tied.team.bearings.push_back(team.bearings[k]);
    }
  std::erase_if(tied.team.graph.relative_points, [&](const auto& f) { return !frames.together(f.i, f.j); });
  std::erase_if(tied.team.graph.relative_poses, [&](const auto& f) { return !frames.together(f.i, f.j); });
  return tied;
}

template std::vector<std::size_t> piece_of_poses(const TeamGraph<SE2>&);
template std::vector<std::size_t> piece_of_poses(const TeamGraph<SE3>&);
template TiedTeam<SE2> tied_team(const TeamGraph<SE2>&, const TeamComponents&);
template TiedTeam<SE3> tied_team(const TeamGraph<SE3>&, const TeamComponents&);

}  // namespace radioslam
