#include "radioslam/joint/closures/loop_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kBeam = 64;  // choices of frames that are kept
const double kLogOddsPerSighting = std::log(5.0);

/// A measured relative pose that joins two frames.
template <class Pose>
struct FrameLink {
  std::size_t segment_a, segment_b;
  RelativePoseMatch<Pose> loop;
};

/// The pose of b's pose j from a's pose i along the links, to first order; nothing in different components.
template <class Pose>
std::optional<UncertainPose<Pose>> relative_pose(const SegmentChains<Pose>& chains,
                                                 const std::vector<FrameLink<Pose>>& links, std::size_t a,
                                                 std::size_t i, std::size_t b, std::size_t j) {
  struct Reached {
    std::size_t segment, pose;
    UncertainPose<Pose> from_i;
  };
  std::deque<Reached> queue{{a, i, {}}};
  std::vector<bool> seen(chains.size(), false);
  seen[a] = true;
  for (; !queue.empty(); queue.pop_front()) {
    const Reached at = queue.front();
    if (at.segment == b) return at.from_i * chains[b]->between(at.pose, j);
    for (const FrameLink<Pose>& link : links) {
      const bool forward = link.segment_a == at.segment;
      const std::size_t other = forward ? link.segment_b : link.segment_a;
      if ((!forward && link.segment_b != at.segment) || seen[other]) continue;
      seen[other] = true;
      const UncertainPose<Pose> step{link.loop.T_a_b, link.loop.covariance};
      const std::size_t leave = forward ? link.loop.pose_a : link.loop.pose_b;
      queue.push_back(
          {other, forward ? link.loop.pose_b : link.loop.pose_a,
           at.from_i * chains[at.segment]->between(at.pose, leave) * (forward ? step : step.inverse())});
    }
  }
  return std::nullopt;
}

template <class Pose>
struct Choice {
  LoopAlignment<Pose> alignment;
  std::vector<FrameLink<Pose>> links;  ///< a tree per component
};

template <class Pose>
class FrameSearch {
 public:
  FrameSearch(const JointGraph<Pose>& joint, const std::vector<TeamLoop<Pose>>& loops,
              const std::vector<LoopGroup>& groups, const SegmentChains<Pose>& chains)
      : joint_(joint), loops_(loops), groups_(groups), chains_(chains) {}

  std::vector<LoopAlignment<Pose>> run(const std::vector<int>& component) {
    std::vector<Choice<Pose>> beam{start(component)};
    for (const std::size_t g : strongest_first()) {
      std::vector<Choice<Pose>> next;
      for (Choice<Pose>& choice : beam) extend(std::move(choice), g, next);
      keep_best(next);
      beam = std::move(next);
    }
    for (Choice<Pose>& choice : beam) weigh(choice);
    keep_best(beam);
    std::vector<LoopAlignment<Pose>> result;
    for (Choice<Pose>& choice : beam) {
      const auto is_same = [&](const LoopAlignment<Pose>& other) {
        return other.group_holds == choice.alignment.group_holds;
      };
      if (std::none_of(result.begin(), result.end(), is_same)) result.push_back(std::move(choice.alignment));
    }
    return result;
  }

 private:
  std::vector<std::size_t> strongest_first() const {
    std::vector<std::size_t> order(groups_.size());
    for (std::size_t g = 0; g < order.size(); ++g) order[g] = g;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return groups_[x].evidence > groups_[y].evidence; });
    return order;
  }

  /// Segments that share a frame already are linked as they are.
  Choice<Pose> start(const std::vector<int>& component) const {
    Choice<Pose> choice;
    choice.alignment.component = component;
    choice.alignment.T_frame_segment.assign(component.size(), Pose());
    choice.alignment.group_holds.assign(groups_.size(), false);
    std::vector<PoseId> end(component.size());  // of a loop, per segment
    for (const TeamLoop<Pose>& loop : loops_)
      if (!loop.is_own()) end[loop.segment_i] = loop.i, end[loop.segment_j] = loop.j;
    std::map<int, std::size_t> first;
    for (std::size_t s = 0; s < component.size(); ++s) {
      if (!end[s].valid()) continue;
      const auto [with, is_first] = first.try_emplace(component[s], s);
      if (is_first) continue;
      const auto& poses = joint_.team.graph.poses;
      const PoseId i = end[with->second], j = end[s];
      choice.links.push_back({with->second,
                              s,
                              {i.index() - joint_.team.segments[with->second].first_pose,
                               j.index() - joint_.team.segments[s].first_pose,
                               poses[i.index()].inverse() * poses[j.index()], Pose::Jacobian::Zero()}});
    }
    return choice;
  }

  void extend(Choice<Pose> choice, std::size_t g, std::vector<Choice<Pose>>& next) const {
    const LoopGroup& group = groups_[g];
    LoopAlignment<Pose>& alignment = choice.alignment;
    if (alignment.component[group.segment_a] != alignment.component[group.segment_b]) {
      next.push_back(choice);
      join(choice, g);
      alignment.log_weight += kLogOddsPerSighting * group.evidence;
    } else if (holds(choice, g)) {
      alignment.log_weight += kLogOddsPerSighting * group.evidence;
    }
    next.push_back(std::move(choice));
  }

  /// Moves the component of the group's segment b to where its middle loop wants it.
  void join(Choice<Pose>& choice, std::size_t g) const {
    const LoopGroup& group = groups_[g];
    LoopAlignment<Pose>& alignment = choice.alignment;
    const RelativePoseMatch<Pose> loop = seen_from(joint_, loops_[group.middle()], group.segment_a);
    const auto pose = [&](std::size_t segment, std::size_t k) {
      return alignment.T_frame_segment[segment] *
             joint_.team.graph.poses[joint_.team.segments[segment].first_pose + k];
    };
    const Pose T =
        pose(group.segment_a, loop.pose_a) * loop.T_a_b * pose(group.segment_b, loop.pose_b).inverse();
    const int from = alignment.component[group.segment_b], to = alignment.component[group.segment_a];
    for (std::size_t s = 0; s < alignment.component.size(); ++s)
      if (alignment.component[s] == from) {
        alignment.component[s] = to;
        alignment.T_frame_segment[s] = T * alignment.T_frame_segment[s];
      }
    choice.links.push_back({group.segment_a, group.segment_b, loop});
    alignment.joins.push_back(g);
  }

  bool holds(const Choice<Pose>& choice, std::size_t g) const {
    const LoopGroup& group = groups_[g];
    const auto loop = seen_from(joint_, loops_[group.middle()], group.segment_a);
    const auto by_frames =
        relative_pose(chains_, choice.links, group.segment_a, loop.pose_a, group.segment_b, loop.pose_b);
    if (!by_frames) return false;
    const Cholesky<typename Pose::Jacobian> cholesky(by_frames->covariance + loop.covariance);
    const typename Pose::Tangent error = (loop.T_a_b.inverse() * by_frames->pose).log();
    return cholesky.succeeded() && cholesky.whitened(error).squaredNorm() <= kPoseChiSquared999<Pose>;
  }

  /// By all groups: those that could not be compared when it was their turn, too.
  void weigh(Choice<Pose>& choice) const {
    choice.alignment.log_weight = 0;
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      choice.alignment.group_holds[g] = holds(choice, g);
      if (choice.alignment.group_holds[g])
        choice.alignment.log_weight += kLogOddsPerSighting * groups_[g].evidence;
    }
  }

  static void keep_best(std::vector<Choice<Pose>>& choices) {
    std::stable_sort(choices.begin(), choices.end(), [](const auto& x, const auto& y) {
      return x.alignment.log_weight > y.alignment.log_weight;
    });
    if (choices.size() > kBeam) choices.erase(choices.begin() + kBeam, choices.end());
  }

  const JointGraph<Pose>& joint_;
  const std::vector<TeamLoop<Pose>>& loops_;
  const std::vector<LoopGroup>& groups_;
  const SegmentChains<Pose>& chains_;
};

}  // namespace

template <class Pose>
std::vector<LoopAlignment<Pose>> align_by_loops(const JointGraph<Pose>& joint,
                                                const std::vector<int>& component,
                                                const std::vector<TeamLoop<Pose>>& loops,
                                                const std::vector<LoopGroup>& groups,
                                                const SegmentChains<Pose>& chains) {
  return FrameSearch<Pose>(joint, loops, groups, chains).run(component);
}

#define RADIOSLAM_LOOP_ALIGNMENT(Pose)                                                      \
  template std::vector<LoopAlignment<Pose>> align_by_loops(                                 \
      const JointGraph<Pose>&, const std::vector<int>&, const std::vector<TeamLoop<Pose>>&, \
      const std::vector<LoopGroup>&, const SegmentChains<Pose>&);
RADIOSLAM_LOOP_ALIGNMENT(SE2)
RADIOSLAM_LOOP_ALIGNMENT(SE3)
#undef RADIOSLAM_LOOP_ALIGNMENT

}  // namespace radioslam
