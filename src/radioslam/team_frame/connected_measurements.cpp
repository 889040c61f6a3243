#include "radioslam/team_frame/connected_measurements.hpp"

#include <algorithm>

namespace radioslam {
namespace {

/// Decides whether two ends share a frame.
template <class Pose>
class Frames {
 public:
  Frames(const TeamGraph<Pose>& team, const TeamComponents& components)
      : segment_of_(segment_of_poses(team)), components_(components) {}

  bool together(const RangeEnd<Pose>& a, const RangeEnd<Pose>& b) const {
    if (a.pose.valid() && b.pose.valid() && segment(a) == segment(b)) return true;
    return component(a) >= 0 && component(a) == component(b);
  }
  bool together(PoseId a, const RangeEnd<Pose>& b) const {
    return together(RangeEnd<Pose>{a, {}, Pose::Point::Zero()}, b);
  }
  bool together(PoseId a, PoseId b) const { return together(a, RangeEnd<Pose>{b, {}, Pose::Point::Zero()}); }

 private:
  std::size_t segment(const RangeEnd<Pose>& end) const { return segment_of_[end.pose.index()]; }
  int component(const RangeEnd<Pose>& end) const {
    return end.pose.valid() ? components_.of_segment[segment(end)] : components_.of_point[end.point.index()];
  }

  std::vector<std::size_t> segment_of_;
  const TeamComponents& components_;
};

}  // namespace

template <class Pose>
std::vector<std::size_t> segment_of_poses(const TeamGraph<Pose>& team) {
  std::vector<std::size_t> segment_of(team.graph.poses.size());
  for (std::size_t p = 0; p < team.segments.size(); ++p)
    std::fill_n(segment_of.begin() + static_cast<std::ptrdiff_t>(team.segments[p].first_pose),
                team.segments[p].pose_count, p);
  return segment_of;
}

template <class Pose>
ConnectedTeam<Pose> connected_team(const TeamGraph<Pose>& team, const TeamComponents& components) {
  const Frames<Pose> frames(team, components);
  ConnectedTeam<Pose> connected{team, {}, {}};
  connected.team.graph.ranges.clear();
  connected.team.bearings.clear();
  for (std::size_t k = 0; k < team.graph.ranges.size(); ++k)
    if (frames.together(team.graph.ranges[k].i, team.graph.ranges[k].j)) {
      connected.ranges.push_back(k);
      connected.team.graph.ranges.push_back(team.graph.ranges[k]);
    }
  for (std::size_t k = 0; k < team.bearings.size(); ++k)
    if (frames.together(team.bearings[k].i, team.bearings[k].j)) {
      connected.bearings.push_back(k);
      connected.team.bearings.push_back(team.bearings[k]);
    }
  std::erase_if(connected.team.graph.relative_points,
                [&](const auto& f) { return !frames.together(f.i, f.j); });
  std::erase_if(connected.team.graph.relative_poses,
                [&](const auto& f) { return !frames.together(f.i, f.j); });
  return connected;
}

template std::vector<std::size_t> segment_of_poses(const TeamGraph<SE2>&);
template std::vector<std::size_t> segment_of_poses(const TeamGraph<SE3>&);
template ConnectedTeam<SE2> connected_team(const TeamGraph<SE2>&, const TeamComponents&);
template ConnectedTeam<SE3> connected_team(const TeamGraph<SE3>&, const TeamComponents&);

}  // namespace radioslam
