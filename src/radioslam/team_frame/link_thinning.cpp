#include "radioslam/team_frame/link_thinning.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

/// Keeps at most `most` measurements of a kind between two segments or a segment and a point, evenly spread.
template <class Pose>
class Thinning {
 public:
  explicit Thinning(const TeamGraph<Pose>& team) : segment_of_(segment_of_poses(team)) {}

  template <class Factor>
  std::vector<Factor> operator()(const std::vector<Factor>& factors, std::size_t most) const {
    std::map<Ends, std::size_t> total, seen;
    for (const Factor& f : factors) ++total[ends(f)];
    std::vector<Factor> kept;
    for (const Factor& f : factors) {
      const std::size_t n = total[ends(f)], k = seen[ends(f)]++;
      if (n <= most || (k + 1) * most / n != k * most / n) kept.push_back(f);
    }
    return kept;
  }

 private:
  using Ends = std::pair<std::int64_t, std::int64_t>;
  std::int64_t number(const auto& end) const { return end_number(segment_of_, end); }
  Ends ends(const auto& factor) const { return std::minmax(number(factor.i), number(factor.j)); }
  /// Angles are thinned by receiver, so that those of the exchanges stay whose ranges do.
  Ends ends(const AmbiguousBearing<Pose>& bearing) const { return {number(bearing.i), number(bearing.j)}; }

  std::vector<std::size_t> segment_of_;
};

}  // namespace

template <class Pose>
TeamGraph<Pose> thin_links(const TeamGraph<Pose>& team, const GridParams& params) {
  const auto max_links = static_cast<std::size_t>(params.max_links);
  const auto max_sightings = static_cast<std::size_t>(params.max_sightings);
  const Thinning<Pose> thin(team);
  TeamGraph<Pose> fewer = team;
  fewer.graph.ranges = thin(team.graph.ranges, max_links);
  fewer.bearings = thin(team.bearings, max_links);
  fewer.graph.relative_points = thin(team.graph.relative_points, max_sightings);
  return fewer;
}

template TeamGraph<SE2> thin_links(const TeamGraph<SE2>&, const GridParams&);
template TeamGraph<SE3> thin_links(const TeamGraph<SE3>&, const GridParams&);

}  // namespace radioslam
