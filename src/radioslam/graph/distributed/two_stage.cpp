#include "radioslam/graph/distributed/two_stage.hpp"

#include <algorithm>

#include "radioslam/graph/distributed/active_graph.hpp"

namespace radioslam {
namespace {

template <class Pose>
std::vector<RobotNumber> neighbour_numbers(const RobotGraph<Pose>& robot) {
  std::vector<RobotNumber> numbers;
  for (const NeighbourRobot& neighbour : robot.neighbours) numbers.push_back(neighbour.robot);
  return numbers;
}

}  // namespace

template <class Pose>
TwoStageSolver<Pose>::TwoStageSolver(RobotGraph<Pose> robot, const TwoStageParams& params)
    : params_(params),
      robot_(std::move(robot)),
      frames_(robot_, params.frames),
      gossip_(robot_),
      stages_(neighbour_numbers(robot_)),
      steps_(robot_.graph.poses.size(), Pose::Tangent::Zero()) {
  if (robot_.neighbours.empty()) stages_.end(StageEnd::kFinish);
}

template <class Pose>
std::vector<Pose> TwoStageSolver<Pose>::poses() const {
  std::vector<Pose> poses;
  for (std::size_t p = 0; p < robot_.own_poses; ++p)
    poses.push_back(robot_.graph.poses[p] * Pose::exp(steps_[p]));
  return poses;
}

template <class Pose>
std::vector<Message<Pose>> TwoStageSolver<Pose>::round(const std::vector<Message<Pose>>& heard) {
  std::vector<bool> fits;
  for (const auto& message : heard) fits.push_back(hear(message));
  if (const auto end = stages_.heard_end(); end && turns_ && !stages_.finished()) go_on(*end);
  for (std::size_t k = 0; k < heard.size(); ++k)
    if (!fits[k] || !take_values(heard[k])) ++refused_;
  if (!stages_.finished()) {
    const Activity activity = act();
    const bool at_rest = stages_.count(activity, turns_ ? rounds_at_rest() : ~std::uint32_t{0});
    if (at_rest) go_on(stage() == kPoses && !stages_.moved() ? StageEnd::kFinish : StageEnd::kNext);
  }
  return messages();
}

// ---- what neighbours say ----

template <class Pose>
bool TwoStageSolver<Pose>::hear(const Message<Pose>& message) {
  if (neighbour_index(robot_, message.from) == robot_.neighbours.size() || !message.stage) return false;
  gossip_.hear(message.from, message.topology);
  if (!message.stage->finished) unaware_.push_back(message.from);
  return stages_.hear(message.from, *message.stage);
}

/// Those of another stage are late and count for nothing.
template <class Pose>
bool TwoStageSolver<Pose>::take_values(const Message<Pose>& message) {
  if (message.stage->stage != stages_.stage() || stages_.finished()) return true;
  const bool expected_matrices = message.matrices.empty() || stage() == kRotations;
  const bool expected_steps = message.steps.empty() || stage() == kPoses;
  const bool expected_poses = !message.seen || stage() != kRotations;
  if (!expected_matrices || !expected_steps || !expected_poses) return false;
  if (!message.matrices.empty()) return take_items(message.from, message.matrices, rotations_);
  if (!message.steps.empty()) return take_items(message.from, message.steps, steps_);
  return !message.seen || frames_.hear(robot_, message.from, *message.seen);
}

template <class Pose>
template <class Value>
bool TwoStageSolver<Pose>::take_items(RobotNumber from, const std::vector<Value>& items,
                                      std::vector<Value>& values) {
  const auto& copies = robot_.neighbours[neighbour_index(robot_, from)].copies;
  if (items.size() != copies.size()) return false;
  for (std::size_t k = 0; k < items.size(); ++k) values[copies[k]] = items[k];
  return true;
}

// ---- from stage to stage ----

template <class Pose>
void TwoStageSolver<Pose>::go_on(StageEnd end) {
  keep_result();
  stages_.end(end);
  tell_ = begins_ = true;
  prepared_ = false;
  if (stage() == kRotations && !network_) build_active();
}

/// What the stage has found becomes part of the robot's poses.
template <class Pose>
void TwoStageSolver<Pose>::keep_result() {
  for (std::size_t p = 0; p < robot_.own_poses; ++p) {
    Pose& pose = robot_.graph.poses[p];
    if (stage() == kRotations && !active_.pose_fixed[p])
      pose = make_pose(pose.translation(), nearest_rotation(PoseMatrix<Pose>(rotations_[p].transpose())));
    if (stage() == kPoses) pose = pose * Pose::exp(steps_[p]);
  }
  steps_.assign(steps_.size(), Pose::Tangent::Zero());
}

/// The frames are agreed on: with them, what counts and what stays.
template <class Pose>
void TwoStageSolver<Pose>::build_active() {
  active_ = active_graph(robot_, frames_.usable_factors(robot_));
  std::vector<bool> has_first(robot_.parts, false);
  for (std::size_t p = 0; p < robot_.own_poses; ++p) {
    const std::uint32_t part = robot_.part_of[p];
    active_.pose_fixed[p] = !has_first[part] && frames_.frame_of_part(part).same({robot_.robot, part, 0});
    has_first[part] = true;
  }
  network_.emplace(active_, active_.pose_fixed);
  system_.emplace(active_);
  for (const Pose& pose : active_.poses) rotations_.push_back(pose.rotation_matrix().transpose());
}

/// Once all neighbours' values are there; false where the robot's own part of the system is singular.
template <class Pose>
bool TwoStageSolver<Pose>::prepare() {
  active_.poses = robot_.graph.poses;
  if (stage() == kRotations) return network_->set_terms(rotation_terms(active_));
  if (stage() == kPoses) return system_->linearise(active_);
  PoseMatrices<Pose> rotations;
  for (const Pose& pose : active_.poses) rotations.push_back(pose.rotation_matrix());
  return network_->set_terms(translation_terms(active_, rotations));
}

// ---- moves ----

template <class Pose>
Activity TwoStageSolver<Pose>::act() {
  if (stage() == kFrames) return agree_on_frames();
  if (!begins_ && !prepared_ && stages_.together()) {
    failed_ = failed_ || !prepare();
    prepared_ = true;
  }
  if (!turns_->moves(robot_.robot, round_)) return Activity::kWaited;
  tell_ = true;
  if (!prepared_ || failed_) return Activity::kWaited;
  if (stage() == kRotations) return move_rotations();
  return stage() == kTranslations ? move_translations() : move_poses();
}

template <class Pose>
Activity TwoStageSolver<Pose>::agree_on_frames() {
  const bool moved = frames_.adopt(robot_);
  tell_ = tell_ || moved;
  if (gossip_.complete() && !turns_) turns_.emplace(gossip_.reachable());
  bool heard_all = true;
  for (std::size_t p = robot_.own_poses; p < robot_.graph.poses.size(); ++p)
    heard_all = heard_all && frames_.frame_of(robot_, p);
  return !moved && heard_all && turns_ ? Activity::kRested : Activity::kMoved;
}

template <class Pose>
Activity TwoStageSolver<Pose>::move_rotations() {
  const auto solved = network_->solve(Pose::kDim, rotations_);
  if (!solved) return Activity::kMoved;
  const double before = network_->cost(Pose::kDim, rotations_), after = network_->cost(Pose::kDim, *solved);
  for (std::size_t p = 0; p < robot_.own_poses; ++p)
    rotations_[p] += params_.relaxation * ((*solved)[p] - rotations_[p]);
  return small(before - after, after, params_.start_decrease) ? Activity::kRested : Activity::kMoved;
}

template <class Pose>
Activity TwoStageSolver<Pose>::move_translations() {
  PoseMatrices<Pose> translations(robot_.graph.poses.size(), PoseMatrix<Pose>::Zero());
  for (std::size_t p = 0; p < translations.size(); ++p)
    translations[p].col(0) = robot_.graph.poses[p].translation();
  const auto solved = network_->solve(1, translations);
  if (!solved) return Activity::kMoved;
  const double before = network_->cost(1, translations), after = network_->cost(1, *solved);
  for (std::size_t p = 0; p < robot_.own_poses; ++p) {
    Pose& pose = robot_.graph.poses[p];
    typename Pose::Tangent change = Pose::Tangent::Zero();
    change.template head<Pose::kDim>() = params_.relaxation * pose.rotation_matrix().transpose() *
                                         ((*solved)[p].col(0) - translations[p].col(0));
    pose = pose * Pose::exp(change);
  }
  return small(before - after, after, params_.start_decrease) ? Activity::kRested : Activity::kMoved;
}

template <class Pose>
Activity TwoStageSolver<Pose>::move_poses() {
  const double decrease = system_->move(steps_, params_.pose_relaxation);
  double share = params_.first_decrease;
  for (std::uint32_t s = kPoses; s < stages_.stage(); ++s) share /= 10;
  if (small(decrease, system_->cost(), params_.settled_decrease)) return Activity::kRested;
  return small(decrease, system_->cost(), share) ? Activity::kSlowed : Activity::kMoved;
}

template <class Pose>
bool TwoStageSolver<Pose>::small(double decrease, double cost, double share) const {
  return decrease <= std::max(share * cost, params_.absolute_decrease);
}

// ---- messages ----

template <class Pose>
void TwoStageSolver<Pose>::tell_values(const NeighbourRobot& neighbour, Message<Pose>& message) const {
  if (stage() == kRotations) {
    for (const std::uint32_t pose : neighbour.seen) message.matrices.push_back(rotations_[pose]);
  } else if (stage() == kPoses && prepared_) {
    for (const std::uint32_t pose : neighbour.seen) message.steps.push_back(steps_[pose]);
  } else {
    message.seen = frames_.seen_by(robot_, neighbour);
  }
}

/// After the end, only to those who have not heard of it.
template <class Pose>
std::vector<Message<Pose>> TwoStageSolver<Pose>::messages() {
  std::vector<Message<Pose>> messages;
  for (const NeighbourRobot& neighbour : robot_.neighbours) {
    const bool unaware = std::find(unaware_.begin(), unaware_.end(), neighbour.robot) != unaware_.end();
    if (stages_.finished() && !unaware && !tell_) continue;
    auto& message = messages.emplace_back();
    message.from = robot_.robot;
    message.to = neighbour.robot;
    message.round = round_;
    message.topology = gossip_.news_for(neighbour.robot);
    message.stage = stages_.news();
    if (tell_ && !stages_.finished()) tell_values(neighbour, message);
  }
  tell_ = begins_ = false;
  unaware_.clear();
  ++round_;
  return messages;
}

template class TwoStageSolver<SE2>;
template class TwoStageSolver<SE3>;

}  // namespace radioslam
