#include "radioslam/joint/places/place_proposals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "radioslam/joint/places/place_predictions.hpp"
#include "radioslam/places/loops/other_places.hpp"

namespace radioslam {
namespace {

constexpr double kMostDifferent =
    0.5;  // largest difference of descriptors that is compared with the prediction
constexpr double kDescriptorScale = 0.1;  // difference of descriptors as telling as one standard deviation
constexpr double kStrideRatio = 0.2;      // path length between compared keyframes, in the descriptors' range

/// Per keyframe of robot b, those of robot a that it may be compared with.
class AllowedPairs {
 public:
  AllowedPairs(const std::vector<CandidateList::Group>& groups, RobotIndex a, RobotIndex b,
               std::size_t keyframes_b)
      : with_(keyframes_b) {
    for (const CandidateList::Group& group : groups)
      if (group.robot_i == a && group.robot_j == b)
        for (const CandidateList::Row& row : group.rows) with_[row.keyframe_j].push_back(row.keyframe_i);
  }
  bool contains(std::size_t i, std::size_t j) const {
    return std::binary_search(with_[j].begin(), with_[j].end(), static_cast<std::uint32_t>(i));
  }

 private:
  std::vector<std::vector<std::uint32_t>> with_;
};

template <class Pose>
bool are_aligned(const TeamAlignment<Pose>& alignment, std::size_t a, std::size_t b) {
  return alignment.component[a] == alignment.component[b] ||
         connected_without_matches(alignment, RobotIndex(a), RobotIndex(b));
}

void count_descriptor(PlaceCounts& counts, const ScannedRobot& robot, std::size_t k, bool is_sent) {
  const std::size_t bytes = wire_bytes(robot.contexts->context(k));
  counts.descriptor_bytes_all += bytes;
  if (is_sent) counts.descriptor_bytes += bytes;
}

/// Attempts of earlier rounds, by robots and keyframes.
class Attempts {
 public:
  explicit Attempts(const std::vector<PlaceAttempt>& tried) {
    for (const PlaceAttempt& attempt : tried) {
      const std::size_t a = attempt.robot_i.index(), b = attempt.robot_j.index();
      of_pair_[{a, b, attempt.i, attempt.j}].push_back(&attempt);
      robots_.emplace(a, b);
    }
  }

  /// Whether the pair is known to hold, or was tried under a prediction that was hardly worse.
  bool has(const Proposal& pair) const {
    const auto found = of_pair_.find({pair.a, pair.b, pair.i, pair.j});
    if (found == of_pair_.end()) return false;
    const double now_m = horizontal_sigma(pair.T_i_j);
    return std::any_of(found->second.begin(), found->second.end(), [&](const PlaceAttempt* attempt) {
      return attempt->holds || !is_worth_another_trial(attempt->sigma_m, now_m);
    });
  }
  bool has_robots(std::size_t a, std::size_t b) const { return robots_.contains({a, b}); }

 private:
  std::map<std::array<std::size_t, 4>, std::vector<const PlaceAttempt*>> of_pair_;
  std::set<std::pair<std::size_t, std::size_t>> robots_;
};

template <class Pose>
class PlaceSearch {
 public:
  PlaceSearch(const PlaceInput<Pose>& input, const PlaceParams& params, const ScanLoopParams& loops,
              const RadioAlignmentParams& alignment)
      : input_(input),
        params_(params),
        loops_(loops),
        tried_(input.tried),
        predictions_(input.team, alignment) {
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
        counts_.pairs += robots_[a].size() * robots_[b].strides(stride_m(robots_[b])).size();
        if (!are_aligned(input_.team.alignment, a, b) || !input_.allowed)
          propose_by_descriptor(a, b);
        else if (predictions_.exist())
          propose_by_prediction(a, b);
      }
    counts_.proposed = proposals_.size();
    if (input_.budget && (input_.budget->least_worth > 0 || proposals_.size() > input_.budget->registrations))
      keep_within(*input_.budget);
    return {std::move(robots_), std::move(proposals_), counts_};
  }

 private:
  using Poses = std::vector<Pose>;

  double stride_m(const ScannedRobot& robot) const {
    return params_.stride_m > 0 ? params_.stride_m : kStrideRatio * robot.context_range_m;
  }

  void propose_by_prediction(std::size_t a, std::size_t b) {
    const TeamAlignment<Pose>& alignment = input_.team.alignment;
    const AllowedPairs allowed(*input_.allowed, RobotIndex(a), RobotIndex(b),
                               input_.team.joint.robots[b].stamps.size());
    const std::vector<double>& weights = alignment.alternative_weights;
    const std::size_t others = predictions_.others();
    std::size_t turn = 0;
    for (const std::size_t j : robots_[b].strides(stride_m(robots_[b]))) {
      std::vector<std::size_t> with;
      for (std::size_t i = 0; i < robots_[a].size(); ++i)
        if (robots_[a].has_cloud(i) && allowed.contains(robots_[a].keyframes[i], robots_[b].keyframes[j]))
          with.push_back(i);
      counts_.allowed += with.size();
      count_descriptor(counts_, robots_[b], j, !with.empty());
      if (with.empty()) continue;
      Proposal pair{a, b, 0, j, {}, false, 1, 0, alignment.weight};
      propose_best(pair, with, input_.team.joint.team.graph.poses);
      if (others == 0 || params_.candidates == 1) continue;
      pair.alignment = 1 + turn++ % others;
      pair.alignment_weight = weights[pair.alignment - 1];
      propose_best(pair, with, alignment.alternatives[pair.alignment - 1]);
    }
  }

  /// Proposes keyframe j of the pair with the best of `with` in this alignment.
  void propose_best(Proposal pair, const std::vector<std::size_t>& with, const Poses& poses) {
    const SE3 at_j = predictions_.pose(poses, robots_[pair.b], pair.j);
    std::vector<double> distances_m;
    for (const std::size_t i : with)
      distances_m.push_back(
          (predictions_.pose(poses, robots_[pair.a], i).translation() - at_j.translation()).norm());
    const auto nearest = std::min_element(distances_m.begin(), distances_m.end());
    pair.i = with[static_cast<std::size_t>(nearest - distances_m.begin())];
    const std::size_t nearest_i = pair.i;
    pair.T_i_j = predictions_.relative_pose(poses, robots_, pair);
    const double sigma_m = horizontal_sigma(pair.T_i_j);
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < with.size(); ++n) {
      const double farther_m2 = distances_m[n] * distances_m[n] - *nearest * *nearest;
      const double prior = -farther_m2 / (2 * sigma_m * sigma_m);
      if (prior < -kMostDifferent / kDescriptorScale) continue;
      const double distance = compare_descriptors(pair, with[n]).distance;
      const double score = prior - distance / kDescriptorScale;
      if (score > best) best = score, pair.i = with[n], pair.descriptor_distance = distance;
    }
    if (pair.i != nearest_i) pair.T_i_j = predictions_.relative_pose(poses, robots_, pair);
    if (tried_.has(pair)) return;
    pair.alternatives = predictions_.by_others(robots_, pair);
    proposals_.push_back(std::move(pair));
  }

  void keep_within(const VerificationBudget& budget) {
    const auto predicted = predictions_.of_graph();
    proposals_ = within_budget(budget, proposals_, robots_, predicted ? &*predicted : nullptr, loops_);
  }

  ContextMatch compare_descriptors(const Proposal& pair, std::size_t i) {
    ++counts_.compared;
    return compare(robots_[pair.a].contexts->context(i), robots_[pair.b].contexts->context(pair.j));
  }

  /// Proposes, for every stride of b, the keyframes of a with the most similar descriptors, not two of one
  /// stride.
  void propose_by_descriptor(std::size_t a, std::size_t b) {
    if (tried_.has_robots(a, b) && !input_.budget) return;  // descriptors alone would only repeat themselves
    const ScannedRobot& of_a = robots_[a];
    const auto compared = static_cast<std::size_t>(
        std::min(params_.descriptors.index.nearest_keys, params_.descriptors.index.shortlist));
    for (const std::size_t j : robots_[b].strides(stride_m(robots_[b]))) {
      counts_.compared += std::min(of_a.size(), compared);
      counts_.allowed += of_a.size();
      count_descriptor(counts_, robots_[b], j, true);
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
  ScanLoopParams loops_;
  Attempts tried_;
  PlacePredictions<Pose> predictions_;
  std::vector<ScannedRobot> robots_;
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
