#include "radioslam/graph/distributed/frames.hpp"

#include <algorithm>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// Where one factor puts a part: T_frame_part, and how well it knows.
template <class Pose>
struct Placement {
  Pose T_frame_part;
  Pose own;  ///< the part's pose of the factor
  typename Pose::Jacobian information;
  double information_weight = 1;
};

template <class Pose>
Placement<Pose> placement(const RobotGraph<Pose>& robot, const RelativePoseFactor<Pose>& factor) {
  const bool own_first = robot.is_own(factor.i);
  const Pose& own = robot.graph.poses[(own_first ? factor.i : factor.j).index()];
  const Pose& other = robot.graph.poses[(own_first ? factor.j : factor.i).index()];
  const Pose there = own_first ? other * factor.T_i_j.inverse() : other * factor.T_i_j;
  return {there * own.inverse(), own, factor.information, factor.weight};
}

/// Squared norm of the difference of two placements, at the first one's pose, with what odometry may have
/// drifted on the way from there to the second one's.
template <class Pose>
double disagreement(const Placement<Pose>& a, const Placement<Pose>& b, double drift_ratio) {
  const typename Pose::Tangent difference =
      ((a.T_frame_part * a.own).inverse() * (b.T_frame_part * a.own)).log();
  const double apart = (a.own.translation() - b.own.translation()).norm();
  // The heading that b measured carries over to a's place; both measured, and odometry lies between.
  typename Pose::Jacobian covariance = inverse(a.information);
  const typename Pose::Jacobian carried = (a.own.inverse() * b.own).adjoint();
  covariance += carried * inverse(b.information) * carried.transpose();
  constexpr int kTurn = Pose::kDof - Pose::kDim;
  covariance.template topLeftCorner<Pose::kDim, Pose::kDim>().diagonal().array() +=
      drift_ratio * drift_ratio * apart * apart;
  covariance.template bottomRightCorner<kTurn, kTurn>().diagonal().array() += drift_ratio * drift_ratio;
  return difference.dot(ldlt_solve(covariance, difference));
}

/// The mean of placements by their information, near the first.
template <class Pose>
Pose mean_placement(const std::vector<Placement<Pose>>& placements) {
  Pose mean = placements.front().T_frame_part;
  for (int round = 0; round < 3; ++round) {
    typename Pose::Jacobian h = Pose::Jacobian::Zero();
    typename Pose::Tangent g = Pose::Tangent::Zero();
    for (const auto& p : placements) {
      const typename Pose::Tangent error = ((p.T_frame_part * p.own).inverse() * (mean * p.own)).log();
      const typename Pose::Jacobian j = p.own.inverse().adjoint();
      h += p.information_weight * j.transpose() * p.information * j;
      g += p.information_weight * j.transpose() * p.information * error;
    }
    mean = mean * Pose::exp(-ldlt_solve(h, g));
  }
  return mean;
}

/// A measurement that was repeated counts once, by its weight.
template <class Pose>
double votes(const std::vector<Placement<Pose>>& placements) {
  double sum = 0;
  for (const auto& p : placements) sum += p.information_weight;
  return sum;
}

/// The placements that agree with the one that most agree with; the first of several.
template <class Pose>
std::vector<Placement<Pose>> elected(const std::vector<Placement<Pose>>& placements,
                                     const FrameVoteParams& params) {
  std::vector<Placement<Pose>> best;
  for (const auto& candidate : placements) {
    std::vector<Placement<Pose>> agreeing;
    for (const auto& other : placements)
      if (disagreement(candidate, other, params.drift_ratio) <= params.max_statistic)
        agreeing.push_back(other);
    if (votes(agreeing) > votes(best)) best = std::move(agreeing);
  }
  return best;
}

}  // namespace

template <class Pose>
FrameAgreement<Pose>::FrameAgreement(const RobotGraph<Pose>& robot, const FrameVoteParams& params)
    : params_(params), copy_frames_(robot.copies.size()) {
  for (std::uint32_t part = 0; part < robot.parts; ++part) frames_.push_back({robot.robot, part, 0});
}

template <class Pose>
std::vector<Frame> FrameAgreement<Pose>::frames(const RobotGraph<Pose>& robot) const {
  std::vector<Frame> frames;
  for (const std::uint32_t part : robot.part_of) frames.push_back(frames_[part]);
  return frames;
}

template <class Pose>
std::optional<Frame> FrameAgreement<Pose>::frame_of(const RobotGraph<Pose>& robot, std::size_t pose) const {
  if (pose < robot.own_poses) return frames_[robot.part_of[pose]];
  return copy_frames_[robot.copy_of(pose)];
}

template <class Pose>
bool FrameAgreement<Pose>::usable(const RobotGraph<Pose>& robot,
                                  const RelativePoseFactor<Pose>& factor) const {
  const auto i = frame_of(robot, factor.i.index()), j = frame_of(robot, factor.j.index());
  return i && j && i->same(*j);
}

template <class Pose>
std::vector<std::uint32_t> FrameAgreement<Pose>::usable_factors(const RobotGraph<Pose>& robot) const {
  std::vector<std::uint32_t> places;
  for (std::size_t k = robot.own_relative_poses; k < robot.graph.relative_poses.size(); ++k)
    if (usable(robot, robot.graph.relative_poses[k])) places.push_back(static_cast<std::uint32_t>(k));
  return places;
}

template <class Pose>
void FrameAgreement<Pose>::start_again(const RobotGraph<Pose>& robot,
                                       const std::vector<std::uint32_t>& first) {
  copy_frames_.assign(copy_frames_.size(), std::nullopt);
  std::vector<bool> numbered(robot.parts, false);
  std::uint32_t next = 0;
  const auto number = [&](std::uint32_t part) {
    if (!numbered[part]) frames_[part] = {robot.robot, next++, 0};
    numbered[part] = true;
  };
  for (const std::uint32_t pose : first) number(robot.part_of[pose]);
  for (const std::uint32_t part : robot.part_of) number(part);
}

template <class Pose>
bool FrameAgreement<Pose>::hear(RobotGraph<Pose>& robot, RobotNumber from, const SeenPoses<Pose>& seen) {
  const std::size_t n = neighbour_index(robot, from);
  if (n == robot.neighbours.size()) return false;
  const NeighbourRobot& neighbour = robot.neighbours[n];
  const bool one_part = seen.part_of.empty() && seen.frames.size() == 1;
  if (seen.poses.size() != neighbour.copies.size()) return false;
  if (!one_part && seen.part_of.size() != seen.poses.size()) return false;
  for (std::size_t k = 0; k < seen.poses.size(); ++k) {
    robot.graph.poses[neighbour.copies[k]] = seen.poses[k];
    copy_frames_[robot.copy_of(neighbour.copies[k])] = seen.frames[one_part ? 0 : seen.part_of[k]];
  }
  return true;
}

template <class Pose>
bool FrameAgreement<Pose>::adopt(RobotGraph<Pose>& robot) {
  bool moved = false;
  for (std::uint32_t part = 0; part < robot.parts; ++part) moved = adopt_part(robot, part) || moved;
  return moved;
}

template <class Pose>
bool FrameAgreement<Pose>::adopt_part(RobotGraph<Pose>& robot, std::uint32_t part) {
  // Of the frames before the part's own, the first that enough factors lead to.
  std::vector<Frame> offered;
  const auto other_frame = [&](const RelativePoseFactor<Pose>& factor) -> std::optional<Frame> {
    const PoseId own = robot.is_own(factor.i) ? factor.i : factor.j;
    const PoseId other = robot.is_own(factor.i) ? factor.j : factor.i;
    if (robot.part_of[own.index()] != part) return std::nullopt;
    return frame_of(robot, other.index());
  };
  for (std::size_t k = robot.own_relative_poses; k < robot.graph.relative_poses.size(); ++k)
    if (const auto frame = other_frame(robot.graph.relative_poses[k]); frame && frame->before(frames_[part]))
      offered.push_back(*frame);
  std::sort(offered.begin(), offered.end(), [](const Frame& a, const Frame& b) {
    return std::tuple(a.origin, a.part, a.hops) < std::tuple(b.origin, b.part, b.hops);
  });
  for (std::size_t f = 0; f < offered.size(); ++f) {
    if (f > 0 && offered[f].same(offered[f - 1])) continue;
    std::vector<Placement<Pose>> placements;
    for (std::size_t k = robot.own_relative_poses; k < robot.graph.relative_poses.size(); ++k) {
      const auto& factor = robot.graph.relative_poses[k];
      if (const auto frame = other_frame(factor); frame && frame->same(offered[f]))
        placements.push_back(placement(robot, factor));
    }
    const auto agreeing = elected(placements, params_);
    if (votes(agreeing) < params_.min_votes * (1 - 1e-9)) continue;
    const Pose T = mean_placement(agreeing);
    for (std::size_t p = 0; p < robot.own_poses; ++p)
      if (robot.part_of[p] == part) robot.graph.poses[p] = T * robot.graph.poses[p];
    frames_[part] = {offered[f].origin, offered[f].part, offered[f].hops + 1};
    return true;
  }
  return false;
}

template <class Pose>
SeenPoses<Pose> FrameAgreement<Pose>::seen_by(const RobotGraph<Pose>& robot,
                                              const NeighbourRobot& neighbour) const {
  SeenPoses<Pose> seen;
  seen.frames = frames_;
  for (const std::uint32_t pose : neighbour.seen) {
    seen.poses.push_back(robot.graph.poses[pose]);
    if (robot.parts > 1) seen.part_of.push_back(robot.part_of[pose]);
  }
  return seen;
}

template <class Pose>
std::vector<Message<Pose>> FrameAgreement<Pose>::seen_by_all(const RobotGraph<Pose>& robot,
                                                             std::uint32_t round) const {
  std::vector<Message<Pose>> messages;
  for (const NeighbourRobot& neighbour : robot.neighbours) {
    auto& message = messages.emplace_back();
    message.from = robot.robot;
    message.to = neighbour.robot;
    message.round = round;
    message.seen = seen_by(robot, neighbour);
  }
  return messages;
}

template class FrameAgreement<SE2>;
template class FrameAgreement<SE3>;

}  // namespace radioslam
