#include "radioslam/team_frame/link_thinning.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

/// However many robots there are, a pair keeps so many links.
constexpr std::size_t kLeastLinks = 8;

/// Keeps at most so many measurements of a kind between two segments or a segment and a point, evenly spread.
template <class Pose>
class Thinning {
 public:
  explicit Thinning(const TeamGraph<Pose>& team)
      : segment_of_(segment_of_poses(team)), partners_(team.segments.size()) {
    for (const auto& range : team.graph.ranges) connect(number(range.i), number(range.j));
    for (const auto& bearing : team.bearings) connect(number(bearing.i), number(bearing.j));
  }

  template <class Factor>
  std::vector<Factor> operator()(const std::vector<Factor>& factors, std::size_t most) const {
    return kept(factors, [&](const Ends&) { return most; });
  }
  /// The same, and of measurements between segments at most about `most_of_segment` per segment.
  template <class Factor>
  std::vector<Factor> operator()(const std::vector<Factor>& factors, std::size_t most,
                                 std::size_t most_of_segment) const {
    return kept(factors, [&](const Ends& ends) {
      if (ends.first < 0 || ends.second < 0) return most;  // a point
      const std::size_t pairs = std::max(partners(ends.first), partners(ends.second));
      return std::min(most, std::max(kLeastLinks, most_of_segment / pairs));
    });
  }

 private:
  using Ends = std::pair<std::int64_t, std::int64_t>;
  template <class Factor, class Most>
  std::vector<Factor> kept(const std::vector<Factor>& factors, const Most& most_between) const {
    std::map<Ends, std::size_t> total, seen;
    for (const Factor& f : factors) ++total[ends(f)];
    std::vector<Factor> kept;
    for (const Factor& f : factors) {
      const std::size_t n = total[ends(f)], k = seen[ends(f)]++, most = most_between(ends(f));
      if (n <= most || (k + 1) * most / n != k * most / n) kept.push_back(f);
    }
    return kept;
  }
  std::int64_t number(const auto& end) const { return end_number(segment_of_, end); }
  Ends ends(const auto& factor) const { return std::minmax(number(factor.i), number(factor.j)); }
  /// Angles are thinned by receiver, so that those of the exchanges stay whose ranges do.
  Ends ends(const AmbiguousBearing<Pose>& bearing) const { return {number(bearing.i), number(bearing.j)}; }

  void connect(std::int64_t a, std::int64_t b) {
    if (a < 0 || b < 0) return;
    partners_[static_cast<std::size_t>(a)].insert(b);
    partners_[static_cast<std::size_t>(b)].insert(a);
  }
  std::size_t partners(std::int64_t segment) const {
    return partners_[static_cast<std::size_t>(segment)].size();
  }

  std::vector<std::size_t> segment_of_;
  std::vector<std::set<std::int64_t>> partners_;  ///< segments with a measurement to each
};

}  // namespace

template <class Pose>
TeamGraph<Pose> thin_links(const TeamGraph<Pose>& team, const GridParams& params) {
  const auto max_links = static_cast<std::size_t>(params.max_links);
  const auto of_segment = static_cast<std::size_t>(params.max_links_of_robot);
  const auto max_sightings = static_cast<std::size_t>(params.max_sightings);
  const Thinning<Pose> thin(team);
  TeamGraph<Pose> fewer = team;
  fewer.graph.ranges = thin(team.graph.ranges, max_links, of_segment);
  fewer.bearings = thin(team.bearings, max_links, of_segment);
  fewer.graph.relative_points = thin(team.graph.relative_points, max_sightings);
  return fewer;
}

template TeamGraph<SE2> thin_links(const TeamGraph<SE2>&, const GridParams&);
template TeamGraph<SE3> thin_links(const TeamGraph<SE3>&, const GridParams&);

}  // namespace radioslam
