#include "radioslam/team_frame/beam_search/placement_order.hpp"

#include <algorithm>

namespace radioslam {
namespace {

constexpr std::size_t kMinLinksOfSegment = 3;   // x, y and heading
constexpr std::size_t kMinLinksOfOriented = 2;  // x and y
constexpr std::size_t kMinLinksOfPoint = 2;

/// Whether the segment and one of the component have a common heading.
template <class Pose>
bool has_known_heading(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
                       std::size_t segment) {
  if (team.segments[segment].sigma_heading_rad <= 0) return false;
  for (std::size_t p = 0; p < team.segments.size(); ++p)
    if (components.of_segment[p] == component && team.segments[p].sigma_heading_rad > 0) return true;
  return false;
}

template <class Pose>
std::size_t min_links(const TeamGraph<Pose>& team, const TeamComponents& components, int component,
                      const UnplacedNode& unit) {
  if (!unit.is_segment) return kMinLinksOfPoint;
  return has_known_heading(team, components, component, unit.index) ? kMinLinksOfOriented
                                                                    : kMinLinksOfSegment;
}

}  // namespace

template <class Pose>
std::vector<UnplacedNode> unplaced_nodes(const TeamGraph<Pose>& team, const TeamComponents& components) {
  std::vector<UnplacedNode> units;
  for (std::size_t p = 0; p < team.segments.size(); ++p)
    if (components.of_segment[p] == kUnplaced) units.push_back({true, p});
  for (std::size_t p = 0; p < team.graph.points.size(); ++p)
    if (components.of_point[p] == kUnplaced) units.push_back({false, p});
  return units;
}

template <class Pose>
std::optional<std::size_t> next_root(const TeamGraph<Pose>& team, const TeamComponents& components) {
  std::optional<std::size_t> best;
  std::size_t most = 0;
  for (std::size_t p = 0; p < team.segments.size(); ++p) {
    if (components.of_segment[p] != kUnplaced) continue;
    TeamComponents probe = components;
    const int probe_component = static_cast<int>(team.segments.size()) + 1;
    probe.of_segment[p] = probe_component;
    for (const UnplacedNode& unit : unplaced_nodes(team, components)) {
      if (unit.is_segment && unit.index == p) continue;
      const std::size_t links = count_links(team, probe, probe_component, unit);
      if (links < min_links(team, probe, probe_component, unit) || links <= most) continue;
      most = links;
      best = p;
    }
  }
  return best;
}

template <class Pose>
std::optional<UnplacedNode> next_unit(const TeamGraph<Pose>& team, const TeamComponents& components,
                                      int component) {
  std::optional<UnplacedNode> best;
  std::size_t most = 0;
  for (const UnplacedNode& unit : unplaced_nodes(team, components)) {
    if (best && best->is_segment && !unit.is_segment) break;
    const std::size_t links = count_links(team, components, component, unit);
    if (links < min_links(team, components, component, unit) || links <= most) continue;
    most = links;
    best = unit;
  }
  return best;
}

void renumber(TeamComponents& components) {
  std::vector<int> order;
  const auto number = [&](int c) {
    if (c == kUnplaced) return kUnplaced;
    const auto found = std::find(order.begin(), order.end(), c);
    if (found != order.end()) return static_cast<int>(found - order.begin());
    order.push_back(c);
    return static_cast<int>(order.size()) - 1;
  };
  for (int& c : components.of_segment) c = number(c);
  for (int& c : components.of_point) c = number(c);
}

template std::vector<UnplacedNode> unplaced_nodes(const TeamGraph<SE2>&, const TeamComponents&);
template std::vector<UnplacedNode> unplaced_nodes(const TeamGraph<SE3>&, const TeamComponents&);
template std::optional<std::size_t> next_root(const TeamGraph<SE2>&, const TeamComponents&);
template std::optional<std::size_t> next_root(const TeamGraph<SE3>&, const TeamComponents&);
template std::optional<UnplacedNode> next_unit(const TeamGraph<SE2>&, const TeamComponents&, int);
template std::optional<UnplacedNode> next_unit(const TeamGraph<SE3>&, const TeamComponents&, int);

}  // namespace radioslam
