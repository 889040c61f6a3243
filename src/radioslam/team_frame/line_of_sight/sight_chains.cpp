#include "radioslam/team_frame/line_of_sight/sight_chains.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/team_frame/connected_measurements.hpp"

namespace radioslam {
namespace {

/// Probability of a change from each state over a gap.
struct Changes {
  double to_obstructed, to_sight;
};

Changes changes(double obstructed_share, double forgotten) {
  return {obstructed_share * forgotten, (1 - obstructed_share) * forgotten};
}

/// Chains per task: some thousand links.
constexpr std::size_t kChainsPerTask = 32;

/// The sum of log_likelihood(chain) over all chains, computed on several threads.
template <class LogLikelihood>
double sum_over_chains(std::size_t chains, const LogLikelihood& log_likelihood) {
  std::vector<double> of_chains(chains);
  parallel_for(chains, kChainsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) of_chains[c] = log_likelihood(c);
  });
  return std::accumulate(of_chains.begin(), of_chains.end(), 0.0);
}

/// Ends of measurements, and when they were taken.
template <class Pose>
class Ends {
 public:
  explicit Ends(const TeamGraph<Pose>& team) : team_(team), segment_of_(segment_of_poses(team)) {}

  std::int64_t number(const auto& end) const { return end_number(segment_of_, end); }
  Stamp stamp(const RangeFactor<Pose>& range) const {
    return stamp(range.i.pose.valid() ? range.i.pose : range.j.pose, range.after_ns);
  }
  Stamp stamp(const AmbiguousBearing<Pose>& bearing) const { return stamp(bearing.i, bearing.after_ns); }

 private:
  Stamp stamp(PoseId pose, std::int64_t after_ns) const {
    const TrajectorySegment& segment = team_.segments[segment_of_[pose.index()]];
    return {segment.stamps[pose.index() - segment.first_pose].ns + after_ns};
  }

  const TeamGraph<Pose>& team_;
  std::vector<std::size_t> segment_of_;
};

}  // namespace

struct SightChains::Forward {
  double in_sight, obstructed;  ///< given all measurements so far
  double scale;                 ///< density of this one given those before
};

template <class Pose>
std::vector<PairLinks> links_by_pair(const TeamGraph<Pose>& team) {
  const Ends<Pose> ends(team);
  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<TimedLink>> by_pair;
  std::size_t measurement = 0;
  const auto add = [&](const auto& factor) {
    by_pair[std::minmax(ends.number(factor.i), ends.number(factor.j))].push_back(
        {ends.stamp(factor), measurement++});
  };
  for (const auto& range : team.graph.ranges) add(range);
  for (const auto& bearing : team.bearings) add(bearing);
  std::vector<PairLinks> result;
  for (auto& [pair, links] : by_pair) {
    std::stable_sort(links.begin(), links.end(),
                     [](const TimedLink& x, const TimedLink& y) { return x.stamp < y.stamp; });
    result.push_back({pair.first >= 0, std::move(links)});
  }
  return result;
}

template <class Pose>
SightChains::SightChains(const TeamGraph<Pose>& team, double correlation_time_s) {
  for (const auto& [is_between_robots, links] : links_by_pair(team)) {
    std::vector<Link>& chain = chains_.emplace_back();
    for (std::size_t k = 0; k < links.size(); ++k) {
      const double gap_s = k == 0 ? 0 : seconds_between(links[k - 1].stamp, links[k].stamp);
      chain.push_back({links[k].measurement, -std::expm1(-gap_s / correlation_time_s)});
    }
  }
}

double SightChains::pass_forward(const std::vector<Link>& chain, const std::vector<SightDensities>& densities,
                                 double obstructed_share, std::vector<Forward>* passed) {
  double log_likelihood = 0;
  double in_sight = 1 - obstructed_share, obstructed = obstructed_share;
  for (const Link& link : chain) {
    const Changes change = changes(obstructed_share, link.forgotten);
    const double before = in_sight;
    in_sight = before * (1 - change.to_obstructed) + obstructed * change.to_sight;
    obstructed = before * change.to_obstructed + obstructed * (1 - change.to_sight);
    in_sight *= densities[link.measurement].in_sight;
    obstructed *= densities[link.measurement].obstructed;
    const double scale = in_sight + obstructed;
    in_sight /= scale;
    obstructed /= scale;
    log_likelihood += std::log(scale);
    if (passed) passed->push_back({in_sight, obstructed, scale});
  }
  return log_likelihood;
}

void SightChains::pass_backward(const std::vector<Link>& chain, const std::vector<SightDensities>& densities,
                                double obstructed_share, const std::vector<Forward>& passed,
                                std::vector<double>& in_sight) {
  double later_in_sight = 1, later_obstructed = 1;  // density of all later measurements, scaled
  for (std::size_t k = chain.size(); k-- > 0;) {
    in_sight[chain[k].measurement] = passed[k].in_sight * later_in_sight;
    const Changes change = changes(obstructed_share, chain[k].forgotten);
    const SightDensities& own = densities[chain[k].measurement];
    const double a = own.in_sight * later_in_sight / passed[k].scale;
    const double b = own.obstructed * later_obstructed / passed[k].scale;
    later_in_sight = (1 - change.to_obstructed) * a + change.to_obstructed * b;
    later_obstructed = change.to_sight * a + (1 - change.to_sight) * b;
  }
}

double SightChains::log_likelihood(const std::vector<SightDensities>& densities,
                                   double obstructed_share) const {
  return sum_over_chains(chains_.size(), [&](std::size_t c) {
    return pass_forward(chains_[c], densities, obstructed_share, nullptr);
  });
}

double SightChains::smooth(const std::vector<SightDensities>& densities, double obstructed_share,
                           std::vector<double>& in_sight) const {
  in_sight.assign(densities.size(), 1);
  return sum_over_chains(chains_.size(), [&](std::size_t c) {
    std::vector<Forward> passed;
    passed.reserve(chains_[c].size());
    const double log_likelihood = pass_forward(chains_[c], densities, obstructed_share, &passed);
    pass_backward(chains_[c], densities, obstructed_share, passed, in_sight);
    return log_likelihood;
  });
}

template std::vector<PairLinks> links_by_pair(const TeamGraph<SE2>&);
template std::vector<PairLinks> links_by_pair(const TeamGraph<SE3>&);
template SightChains::SightChains(const TeamGraph<SE2>&, double);
template SightChains::SightChains(const TeamGraph<SE3>&, double);

}  // namespace radioslam
