#include "radioslam/graph/distributed/block_coordinate.hpp"

#include <algorithm>
#include <cmath>

#include "radioslam/graph/distributed/active_graph.hpp"

namespace radioslam {

template <class Pose>
BlockCoordinateSolver<Pose>::BlockCoordinateSolver(RobotGraph<Pose> robot,
                                                   const BlockCoordinateParams& params)
    : params_(params),
      robot_(std::move(robot)),
      frames_(robot_, params.frames),
      heard_until_(robot_.neighbours.size(), 0) {
  poses_ = robot_.trajectory();
}

template <class Pose>
std::vector<Message<Pose>> BlockCoordinateSolver<Pose>::round(const std::vector<Message<Pose>>& heard) {
  for (const auto& message : heard) hear(message);
  const bool adopted = frames_.adopt(robot_);
  if (adopted) {
    poses_ = robot_.trajectory();
    momentum_ = 1;
  }
  if (auto usable = frames_.usable_factors(robot_); usable != usable_ || !equations_) {
    usable_ = std::move(usable);
    prepare();
  }
  // Neighbours have not heard of a frame that was adopted just now.
  small_steps_ = !usable_.empty() && step() && !adopted ? small_steps_ + 1 : 0;
  settled_ = robot_.neighbours.empty() || (small_steps_ > params_.max_age && all_heard());
  return frames_.seen_by_all(robot_, round_++);
}

/// What was said before something already heard is late, and nothing new.
template <class Pose>
void BlockCoordinateSolver<Pose>::hear(const Message<Pose>& message) {
  const std::size_t n = neighbour_index(robot_, message.from);
  if (n == robot_.neighbours.size() || !message.seen) {
    ++refused_;
    return;
  }
  if (message.round < heard_until_[n]) return;
  if (frames_.hear(robot_, message.from, *message.seen))
    heard_until_[n] = message.round + 1;
  else
    ++refused_;
}

template <class Pose>
void BlockCoordinateSolver<Pose>::prepare() {
  active_ = active_graph(robot_, usable_);
  equations_.emplace(active_);
}

/// Lately: what was said last has not changed much since.
template <class Pose>
bool BlockCoordinateSolver<Pose>::all_heard() const {
  return std::all_of(heard_until_.begin(), heard_until_.end(),
                     [&](std::uint32_t until) { return round_ - until <= params_.max_age; });
}

template <class Pose>
bool BlockCoordinateSolver<Pose>::step() {
  active_.poses = robot_.graph.poses;
  const auto bounded = majorized_step(robot_, usable_, active_, *equations_);
  if (!bounded.step) return false;
  const Eigen::VectorXd& gradient = bounded.gradient;
  const bool is_small = -gradient.dot(*bounded.step) <=
                        std::max(params_.settled_decrease * bounded.cost, params_.absolute_decrease);
  equations_->apply(*bounded.step, active_);
  // Momentum that points uphill is dropped (O'Donoghue and Candes 2015).
  double uphill = 0;
  for (std::size_t p = 0; p < robot_.own_poses; ++p) {
    const auto block = equations_->blocks().poses[p];
    if (block < 0) continue;
    const auto at = static_cast<Eigen::Index>(equations_->matrix().offset(static_cast<std::size_t>(block)));
    uphill += gradient.segment<Pose::kDof>(at).dot((poses_[p].inverse() * active_.poses[p]).log());
  }
  const double next = uphill <= 0 ? (1 + std::sqrt(1 + 4 * momentum_ * momentum_)) / 2 : 1;
  const double ahead = next > 1 ? (momentum_ - 1) / next : 0;
  for (std::size_t p = 0; p < robot_.own_poses; ++p) {
    const Pose& moved = active_.poses[p];
    robot_.graph.poses[p] = moved * Pose::exp(ahead * (poses_[p].inverse() * moved).log());
    poses_[p] = moved;
  }
  momentum_ = next;
  return is_small;
}

template class BlockCoordinateSolver<SE2>;
template class BlockCoordinateSolver<SE3>;

}  // namespace radioslam
