#include "radioslam/graph/distributed/alternating.hpp"

#include <algorithm>

#include "radioslam/graph/distributed/active_graph.hpp"

namespace radioslam {

template <class Pose>
AlternatingSolver<Pose>::AlternatingSolver(RobotGraph<Pose> robot, const AlternatingParams& params)
    : params_(params), robot_(std::move(robot)), frames_(robot_, params.frames) {}

template <class Pose>
bool AlternatingSolver<Pose>::settled() const {
  for (std::size_t p = robot_.own_poses; p < robot_.graph.poses.size(); ++p)
    if (!frames_.frame_of(robot_, p)) return false;
  return poses_rest_ && parts_rest_;
}

template <class Pose>
std::vector<Message<Pose>> AlternatingSolver<Pose>::round(const std::vector<Message<Pose>>& heard) {
  for (const auto& message : heard)
    if (!message.seen || !frames_.hear(robot_, message.from, *message.seen)) ++refused_;
  const bool adopted = frames_.adopt(robot_);
  if (auto usable = frames_.usable_factors(robot_); adopted || !equations_ || usable != usable_) {
    usable_ = std::move(usable);
    prepare();
  }
  active_.poses = robot_.graph.poses;
  if (round_ % 2 == 0)
    move_poses();
  else
    move_parts();
  return frames_.seen_by_all(robot_, round_++);
}

template <class Pose>
void AlternatingSolver<Pose>::prepare() {
  active_ = active_graph(robot_, usable_);
  equations_.emplace(active_);
  poses_rest_ = parts_rest_ = false;
}

template <class Pose>
void AlternatingSolver<Pose>::move_poses() {
  poses_rest_ = equations_->empty();
  if (poses_rest_) return;
  const auto bounded = majorized_step(robot_, usable_, active_, *equations_);
  cost_ = bounded.cost;
  if (!bounded.step) return;
  poses_rest_ = small(-bounded.gradient.dot(*bounded.step));
  equations_->apply(*bounded.step, active_);
  std::copy_n(active_.poses.begin(), robot_.own_poses, robot_.graph.poses.begin());
}

template <class Pose>
void AlternatingSolver<Pose>::move_parts() {
  double decrease = 0;
  for (std::size_t part = 0; part < robot_.parts; ++part)
    if (frames_.frame_of_part(part).origin != robot_.robot) decrease += move_part(part);
  parts_rest_ = small(decrease);
}

/// The step of the part, as seen from one of its poses: T_p <- T_a exp(xi) T_a^-1 T_p.
template <class Pose>
double AlternatingSolver<Pose>::move_part(std::size_t part) {
  typename Pose::Jacobian h = Pose::Jacobian::Zero();
  typename Pose::Tangent g = Pose::Tangent::Zero();
  const auto first = std::find(robot_.part_of.begin(), robot_.part_of.end(), part);
  const Pose T_a = active_.poses[static_cast<std::size_t>(first - robot_.part_of.begin())];
  for (std::size_t k = robot_.own_relative_poses; k < active_.relative_poses.size(); ++k) {
    const auto& f = active_.relative_poses[k];
    const bool own_first = robot_.is_own(f.i);
    const std::size_t own = (own_first ? f.i : f.j).index();
    if (robot_.part_of[own] != part) continue;
    const auto linear = linearise(active_, f);
    const typename Pose::Jacobian j =
        (own_first ? std::get<0>(linear.jacobians) : std::get<1>(linear.jacobians)) *
        (active_.poses[own].inverse() * T_a).adjoint();
    h += 2 * f.weight * j.transpose() * f.information * j;
    g += f.weight * j.transpose() * f.information * linear.residual;
  }
  const Eigen::LDLT<typename Pose::Jacobian> factor(h);
  if (factor.info() != Eigen::Success || !factor.isPositive()) return 0;
  const typename Pose::Tangent xi = factor.solve(-g);
  if (!xi.allFinite()) return 0;
  const Pose T = T_a * Pose::exp(xi) * T_a.inverse();
  for (std::size_t p = 0; p < robot_.own_poses; ++p)
    if (robot_.part_of[p] == part) robot_.graph.poses[p] = T * robot_.graph.poses[p];
  return -g.dot(xi);
}

template <class Pose>
bool AlternatingSolver<Pose>::small(double decrease) const {
  return decrease <= std::max(params_.settled_decrease * cost_, params_.absolute_decrease);
}

template class AlternatingSolver<SE2>;
template class AlternatingSolver<SE3>;

}  // namespace radioslam
