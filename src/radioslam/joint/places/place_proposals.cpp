#include "radioslam/joint/places/place_proposals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/joint/places/predicted_places.hpp"
#include "radioslam/places/loops/other_places.hpp"

namespace radioslam {
namespace {

constexpr double kStrideRatio = 0.2;  // path length between compared keyframes, in the descriptors' range

template <class Pose>
bool are_aligned(const TeamAlignment<Pose>& alignment, std::size_t a, std::size_t b) {
  return alignment.component[a] == alignment.component[b] ||
         connected_without_matches(alignment, RobotIndex(a), RobotIndex(b));
}

template <class Pose>
class PlaceSearch {
 public:
  PlaceSearch(const PlaceInput<Pose>& input, const PlaceParams& params, const ScanLoopParams& loops,
              const RadioAlignmentParams& alignment)
      : input_(input),
        params_(params),
        tried_(input.tried),
        exchange_(input.exchange),
        predicted_(input, robots_, params, loops, alignment) {
    const JointGraph<Pose>& joint = input.team.joint;
    for (std::size_t r = 0; r < joint.robots.size(); ++r)
      robots_.push_back(input.scans.robots[r]
                            ? scanned_robot(*input.scans.robots[r], input.descriptors.robots[r],
                                            joint.robots[r], input.mission.robots[r].odometry)
                            : ScannedRobot{});
  }

  PlaceProposals run() {
    for (std::size_t a = 0; a < robots_.size(); ++a)
      for (std::size_t b = a + 1; b < robots_.size(); ++b) {
        if (!robots_[a].has_any_cloud() || !robots_[b].has_any_cloud()) continue;
        if (robots_[a].kind() != robots_[b].kind()) continue;
        const std::vector<std::size_t> strides = robots_[b].strides(stride_m(robots_[b]));
        counts_.pairs += robots_[a].size() * strides.size();
        const PlaceBytes all = bytes_of_all(robots_[b], strides);
        counts_.bytes_all.descriptors += all.descriptors;
        counts_.bytes_all.scans += all.scans;
        if (!are_aligned(input_.team.alignment, a, b) || !input_.allowed)
          propose_by_descriptor(a, b, strides);
        else if (predicted_.exist())
          counts_.allowed += predicted_.expect(a, b, strides);
      }
    const std::size_t left_out = predicted_.propose(tried_, exchange_, counts_, proposals_);
    counts_.proposed = proposals_.size() + left_out;
    if (input_.budget && (input_.budget->least_worth > 0 || proposals_.size() > input_.budget->registrations))
      proposals_ = predicted_.within(*input_.budget, proposals_);
    return {std::move(robots_), std::move(proposals_), std::move(exchange_), counts_};
  }

 private:
  double stride_m(const ScannedRobot& robot) const {
    return params_.stride_m > 0 ? params_.stride_m : kStrideRatio * robot.context_range_m;
  }

  /// Proposes, for every stride of b, the keyframes of a with the most similar descriptors, not two of one
  /// stride.
  void propose_by_descriptor(std::size_t a, std::size_t b, const std::vector<std::size_t>& strides) {
    if (tried_.has_robots(a, b) && !input_.budget) return;  // descriptors alone would only repeat themselves
    const ScannedRobot& of_a = robots_[a];
    const auto compared = static_cast<std::size_t>(
        std::min(params_.descriptors.index.nearest_keys, params_.descriptors.index.shortlist));
    for (const std::size_t j : strides) {
      counts_.compared += std::min(of_a.size(), compared);
      counts_.allowed += of_a.size();
      exchange_.send_descriptor(robots_, a, b, j);
      std::vector<std::size_t> taken;
      const auto is_new = [&](std::size_t i) {
        return of_a.has_cloud(i) && std::none_of(taken.begin(), taken.end(), [&](std::size_t other) {
                 return std::abs(of_a.path_m[i] - of_a.path_m[other]) < stride_m(of_a);
               });
      };
      for (int n = 0; n < params_.candidates; ++n) {
        const auto found = of_a.contexts->nearest(robots_[b].contexts->context(j), 1, is_new);
        if (found.empty() || found.front().match.distance > params_.max_descriptor_distance) break;
        taken.push_back(found.front().index);
        const int sectors = robots_[b].contexts->context(j).sectors();
        Proposal pair{a, b, taken.back(), j, described_pose(of_a.scans->keyframes, found.front(), sectors)};
        pair.anywhere = true;
        pair.descriptor_distance = found.front().match.distance;
        if (!tried_.has(pair)) proposals_.push_back(std::move(pair));
      }
    }
  }

  const PlaceInput<Pose>& input_;
  PlaceParams params_;
  Attempts tried_;
  PlaceExchange exchange_;
  std::vector<ScannedRobot> robots_;
  PredictedPlaces<Pose> predicted_;
  std::vector<Proposal> proposals_;
  PlaceCounts counts_;
};

}  // namespace

double horizontal_sigma(const UncertainPose<SE3>& T) {
  return std::sqrt(T.position_covariance().topLeftCorner<2, 2>().trace() / 2);
}

template <class Pose>
PlaceProposals propose_places(const PlaceInput<Pose>& input, const PlaceParams& params,
                              const ScanLoopParams& loops, const RadioAlignmentParams& alignment) {
  return PlaceSearch<Pose>(input, params, loops, alignment).run();
}

template PlaceProposals propose_places(const PlaceInput<SE2>&, const PlaceParams&, const ScanLoopParams&,
                                       const RadioAlignmentParams&);
template PlaceProposals propose_places(const PlaceInput<SE3>&, const PlaceParams&, const ScanLoopParams&,
                                       const RadioAlignmentParams&);

}  // namespace radioslam
