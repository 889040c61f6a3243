#include "radioslam/graph/distributed/separators.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radioslam/graph/residuals.hpp"

namespace radioslam {

template <class Pose>
SeparatorsSolver<Pose>::SeparatorsSolver(RobotGraph<Pose> robot, const SeparatorsParams& params)
    : params_(params), robot_(std::move(robot)), frames_(robot_, params.frames), gossip_(robot_) {
  if (!repeats()) tell_poses();
  if (robot_.neighbours.empty()) finished_ = true;
  may_be_outlier_ = outlier_candidates(robot_);
  weights_.assign(robot_.graph.relative_poses.size(), 1);
  publish();
}

template <class Pose>
void SeparatorsSolver<Pose>::publish() {
  published_ = robot_.trajectory();
}

template <class Pose>
bool SeparatorsSolver<Pose>::hears_neighbours() const {
  return team_.empty() || std::all_of(robot_.neighbours.begin(), robot_.neighbours.end(),
                                      [&](const auto& neighbour) { return is_linked(neighbour.robot); });
}

template <class Pose>
std::vector<std::optional<double>> SeparatorsSolver<Pose>::weights() const {
  std::vector<std::optional<double>> weights(robot_.graph.relative_poses.size());
  for (const std::size_t k : held_list_) weights[k] = weights_[k];
  return weights;
}

template <class Pose>
std::vector<Message<Pose>> SeparatorsSolver<Pose>::round(const std::vector<Message<Pose>>& heard) {
  for (const auto& message : heard)
    if (!hear(message)) ++refused_;
  if (repeats()) keep_in_touch();
  if (gossip_.complete())
    if (auto team = gossip_.reachable(); team != team_) meet(std::move(team));
  if (!held_ && frames_.adopt(robot_)) tell_poses();
  if (!held_ && tree_ && in_one_frame()) prepare_sweeps();
  if (held_ && !finished_) advance();
  if (rounds_to_end_ == 0 || --rounds_to_end_ == 0) publish();
  return messages();
}

// ---- before the sweeps ----

template <class Pose>
bool SeparatorsSolver<Pose>::hear(const Message<Pose>& message) {
  const std::size_t n = neighbour_index(robot_, message.from);
  if (n == robot_.neighbours.size()) return false;
  last_heard_[message.from] = round_;
  gossip_.restore(message.from);
  gossip_.hear(message.from, message.topology);
  if (message.seen && awaits(*message.seen)) {
    // Poses that come after later ones are old; where teams may change, robots begin anew.
    auto& until = heard_until_[message.from];
    const bool is_late = !repeats() && message.round < until;
    if (!is_late && !frames_.hear(robot_, message.from, *message.seen)) return false;
    until = std::max(until, message.round + 1);
  }
  if (message.up && !hear_child(message.from, *message.up)) return false;
  return !message.down || hear_parent(message.from, *message.down);
}

/// During the sweeps copies move with the steps that their owners take, too. Before, where teams may change,
/// an owner's values may be from the middle of another team's sweeps.
template <class Pose>
bool SeparatorsSolver<Pose>::awaits(const SeenPoses<Pose>& seen) const {
  return !held_ && (!repeats() || (tree_ && seen.tree == tree_->id()));
}

/// Kept until this robot itself knows the tree, and answered again if the answer was lost.
template <class Pose>
bool SeparatorsSolver<Pose>::hear_child(RobotNumber from, const Elimination& up) {
  const auto answered = last_down_.find(from);
  if (answered != last_down_.end() && answered->second.tree == up.tree &&
      answered->second.sweep == up.sweep) {
    message_to(from).down = answered->second;
    return true;
  }
  const auto known = child_scalars_.find(from);
  if (!up.information && (known == child_scalars_.end() || known->second != up.gradient.size()))
    return tree_ && tree_->id() != up.tree;  // of another tree, it is only late
  const bool is_late = tree_ && up.tree == tree_->id() && up.sweep < sweep_.number;
  if (!is_late) early_[from] = up;
  return true;
}

template <class Pose>
bool SeparatorsSolver<Pose>::hear_parent(RobotNumber from, const Solution& down) {
  if (!tree_ || down.tree != tree_->id() || down.sweep != sweep_.number || !sweep_.waiting)
    return true;  // late
  const bool fits =
      tree_->parent(robot_.robot) == from && down.steps.size() == cluster_->passed_gradient().size();
  if (fits) go_down(down);
  return fits;
}

/// Repeats what was not answered, and gives up neighbours that say nothing.
template <class Pose>
void SeparatorsSolver<Pose>::keep_in_touch() {
  const bool again = round_ % params_.repeat_after == params_.repeat_after - 1;
  if (again && (sweep_.number == 0 || !gossip_.complete())) gossip_.tell_again();
  if (again && sweep_.number == 0 && tree_) tell_poses();
  for (const NeighbourRobot& neighbour : robot_.neighbours) {
    if (round_ - last_heard_[neighbour.robot] > params_.lost_after) gossip_.drop(neighbour.robot);
    if (round_ - last_sent_[neighbour.robot] >= params_.repeat_after) message_to(neighbour.robot);
  }
  if (again && sweep_.waiting && last_up_) message_to(tree_->parent(robot_.robot)).up = *last_up_;
}

template <class Pose>
void SeparatorsSolver<Pose>::tell_poses() {
  for (const NeighbourRobot& neighbour : robot_.neighbours) tell_poses_[neighbour.robot] = true;
}

/// Sweeps of another team end, wherever they are. Where teams may change, every one agrees on a frame of its
/// own: what is known of frames may be from robots that are gone.
template <class Pose>
void SeparatorsSolver<Pose>::meet(std::map<RobotNumber, RobotLinks> team) {
  team_ = std::move(team);
  tree_.emplace(team_);
  children_ = tree_->children(robot_.robot);
  held_.reset();
  sweep_ = {};
  sweep_.mu = params_.outliers.gate > 0 ? params_.outliers.first_mu() : 0;
  child_scalars_.clear();
  last_down_.clear();
  last_up_.reset();
  last_cost_ = std::numeric_limits<double>::infinity();
  finished_ = failed_ = false;
  if (!repeats()) return;
  std::vector<std::uint32_t> seen;
  for (const NeighbourRobot& neighbour : robot_.neighbours)
    if (is_linked(neighbour.robot)) seen.insert(seen.end(), neighbour.seen.begin(), neighbour.seen.end());
  std::sort(seen.begin(), seen.end());
  frames_.start_again(robot_, seen);
  tell_poses();
}

/// The frame of the lowest robot of the team.
template <class Pose>
bool SeparatorsSolver<Pose>::in_team_frame(std::size_t pose) const {
  const auto frame = frames_.frame_of(robot_, pose);
  return frame && frame->same({team_.begin()->first, 0, 0});
}

/// The team's, which no neighbour will leave. Parts that no robot of the team sees stay in their own.
template <class Pose>
bool SeparatorsSolver<Pose>::in_one_frame() const {
  const auto all_final = [&](const std::vector<std::uint32_t>& poses) {
    return std::all_of(poses.begin(), poses.end(), [&](std::uint32_t p) { return in_team_frame(p); });
  };
  return std::all_of(
      robot_.neighbours.begin(), robot_.neighbours.end(), [&](const NeighbourRobot& neighbour) {
        return !is_linked(neighbour.robot) || (all_final(neighbour.seen) && all_final(neighbour.copies));
      });
}

/// Between two robots, the factors are held by the one that has fewer poses to be told about; else by the
/// lower one in the tree.
template <class Pose>
bool SeparatorsSolver<Pose>::holds(const NeighbourRobot& neighbour) const {
  const std::size_t ours = neighbour.seen.size(), theirs = neighbour.copies.size();
  if (ours != theirs) return theirs < ours;
  const auto depth = tree_->depth(robot_.robot), other = tree_->depth(neighbour.robot);
  return depth != other ? depth > other : robot_.robot < neighbour.robot;
}

template <class Pose>
void SeparatorsSolver<Pose>::prepare_sweeps() {
  // Without the factors of parts in frames of their own: nothing would hold these.
  held_list_.clear();
  for (std::size_t k = 0; k < robot_.own_relative_poses; ++k)
    if (in_team_frame(robot_.graph.relative_poses[k].i.index())) held_list_.push_back(k);
  std::vector<bool> copy_held(robot_.copies.size(), false);
  for (const NeighbourRobot& neighbour : robot_.neighbours)
    if (is_linked(neighbour.robot) && holds(neighbour)) {
      held_list_.insert(held_list_.end(), neighbour.between.begin(), neighbour.between.end());
      for (const std::uint32_t copy : neighbour.copies) copy_held[robot_.copy_of(copy)] = true;
    }
  held_.emplace(robot_, held_list_, kept_poses(copy_held), tree_->is_root(robot_.robot));
}

/// Own poses in factors that others hold, and the copies held here.
template <class Pose>
std::vector<KeptPose> SeparatorsSolver<Pose>::kept_poses(const std::vector<bool>& copy_held) const {
  std::map<std::uint32_t, RobotNumber> solved_by;
  for (const NeighbourRobot& neighbour : robot_.neighbours)
    if (is_linked(neighbour.robot) && !holds(neighbour))
      for (const std::uint32_t pose : neighbour.seen) {
        const auto known = solved_by.try_emplace(pose, robot_.robot).first;
        known->second = tree_->common_ancestor(known->second, neighbour.robot);
      }
  std::vector<KeptPose> kept;
  for (const auto& [pose, by] : solved_by) kept.push_back({pose, {{robot_.robot, pose}, by}});
  for (std::size_t c = 0; c < copy_held.size(); ++c)
    if (copy_held[c]) kept.push_back({robot_.own_poses + c, {robot_.copies[c], kUnknownRobot}});
  return kept;
}

// ---- sweeps ----

/// Up as soon as every child has been heard.
template <class Pose>
void SeparatorsSolver<Pose>::advance() {
  while (!finished_ && !sweep_.waiting) {
    if (!sweep_.linearised) linearise();
    const auto is_there = [&](RobotNumber child) {
      const auto up = early_.find(child);
      return up != early_.end() && up->second.tree == tree_->id() && up->second.sweep == sweep_.number;
    };
    if (!std::all_of(children_.begin(), children_.end(), is_there)) return;
    for (const RobotNumber child : children_)
      sweep_.children[child] = std::move(early_.extract(child).mapped());
    if (!eliminate()) {
      finished_ = failed_ = true;  // damping has failed, or a message lied: what there is stays
      return;
    }
    if (!tree_->is_root(robot_.robot)) return go_up();
    go_down(decide(sums()));
  }
}

template <class Pose>
void SeparatorsSolver<Pose>::linearise() {
  std::vector<double> weights;
  double penalty = 0;
  if (sweep_.mu > 0) {
    for (const std::size_t k : held_list_) {
      const auto& factor = robot_.graph.relative_poses[k];
      const TruncatedWeight w = may_be_outlier_[k] ? truncated_weight(squared_norm(robot_.graph, factor),
                                                                      params_.outliers.gate, sweep_.mu)
                                                   : TruncatedWeight{};
      weights.push_back(w.weight);
      weights_[k] = w.weight;
      penalty += factor.weight * w.penalty;
    }
  }
  sweep_.cost = held_->linearise(robot_.graph.poses, weights) + penalty;
  sweep_.linearised = true;
}

/// Whether the poses can be those that factors tie to others than the child and the robots below it, as far
/// as this robot's own graph and the team's links say.
template <class Pose>
bool SeparatorsSolver<Pose>::can_share(RobotNumber child, const std::vector<SharedPose>& shared) const {
  const auto below = [&](RobotNumber robot) { return tree_->is_below(robot, child); };
  const auto fits = [&](const SharedPose& pose) {
    const RobotNumber owner = pose.key.robot;
    if (!team_.contains(owner) || (pose.solved_by != kUnknownRobot && !team_.contains(pose.solved_by)))
      return false;
    if (owner == robot_.robot)
      return std::any_of(robot_.neighbours.begin(), robot_.neighbours.end(), [&](const auto& neighbour) {
        return is_linked(neighbour.robot) && below(neighbour.robot) &&
               std::binary_search(neighbour.seen.begin(), neighbour.seen.end(), pose.key.pose);
      });
    bool tied_elsewhere = false;
    for (const RobotNumber other : team_.at(owner).neighbours)
      tied_elsewhere = tied_elsewhere || (other != robot_.robot && below(other) != below(owner));
    return tied_elsewhere ||
           (below(owner) && std::binary_search(robot_.copies.begin(), robot_.copies.end(), pose.key));
  };
  const auto is_later = [](const SharedPose& a, const SharedPose& b) { return a.key >= b.key; };
  return std::adjacent_find(shared.begin(), shared.end(), is_later) == shared.end() &&
         std::all_of(shared.begin(), shared.end(), fits);
}

template <class Pose>
bool SeparatorsSolver<Pose>::eliminate() {
  if (sweep_.relinearise) {
    if (!held_->eliminate(sweep_.damping)) return false;
    child_scalars_.clear();
    for (const auto& [child, up] : sweep_.children) {
      if (!up.information || !can_share(child, up.shared)) return false;
      child_scalars_[child] = up.gradient.size();
    }
    cluster_.emplace(robot_.robot, held_->kept(), sweep_.children, Pose::kDof);
    if (tree_->is_root(robot_.robot) && !cluster_->closed_at_root()) return false;
    if (!cluster_->factorize(held_->information(), sweep_.children)) return false;
  }
  for (const auto& [child, up] : sweep_.children)
    if (up.gradient.size() != child_scalars_.at(child)) return false;
  cluster_->set_gradient(held_->gradient(), sweep_.children);
  return true;
}

template <class Pose>
Elimination SeparatorsSolver<Pose>::sums() const {
  Elimination sum;
  sum.tree = tree_->id();
  sum.sweep = sweep_.number;
  sum.cost = sweep_.cost;
  sum.predicted_decrease = held_->predicted_decrease() + cluster_->predicted_decrease();
  for (const auto& [child, up] : sweep_.children) {
    sum.cost += up.cost;
    sum.predicted_decrease += up.predicted_decrease;
  }
  return sum;
}

template <class Pose>
void SeparatorsSolver<Pose>::go_up() {
  Elimination up = sums();
  up.gradient = cluster_->passed_gradient();
  if (sweep_.relinearise) {
    up.shared = cluster_->passed_poses();
    up.information.emplace(cluster_->passed_information(), Pose::kDof);
  }
  if (repeats()) last_up_ = up;
  message_to(tree_->parent(robot_.robot)).up = std::move(up);
  sweep_.waiting = true;
}

/// At the root: whether the last steps were good, and how the next sweep goes.
template <class Pose>
Solution SeparatorsSolver<Pose>::decide(const Elimination& team) {
  Solution solution;
  solution.tree = tree_->id();
  solution.sweep = sweep_.number;
  solution.mu = sweep_.mu;
  const double decrease = team.predicted_decrease / std::max(team.cost, 1e-300);
  const auto is_small = [&](double predicted, double cost) {
    return predicted <= std::max(params_.settled_decrease * cost, params_.absolute_decrease);
  };
  if (sweep_.mu > 0 && sweep_.mu < params_.outliers.last_mu) {
    solution.mu = std::min(params_.outliers.last_mu, sweep_.mu * params_.outliers.mu_factor);
    last_cost_ = std::numeric_limits<double>::infinity();  // of another problem
    return solution;
  }
  if (team.cost > last_cost_ * (1 + 1e-9)) {
    solution.end = is_small(last_predicted_, last_cost_) ? SweepEnd::kFinish : SweepEnd::kRestore;
    solution.damping = std::max(params_.first_damping, sweep_.damping * params_.damping_factor);
    return solution;
  }
  last_cost_ = team.cost;
  last_predicted_ = team.predicted_decrease;
  if (is_small(team.predicted_decrease, team.cost) && sweep_.damping == 0) solution.end = SweepEnd::kFinish;
  solution.relinearise = decrease > params_.relinearise_above || sweep_.damping > 0 || sweep_.mu > 0;
  solution.damping = sweep_.damping < params_.first_damping * 2 ? 0 : sweep_.damping / params_.damping_factor;
  return solution;
}

template <class Pose>
void SeparatorsSolver<Pose>::go_down(Solution solution) {
  if (tree_->is_root(robot_.robot)) solution.steps = Eigen::VectorXd::Zero(0);
  const Eigen::VectorXd steps = cluster_->steps(solution.steps);
  for (const RobotNumber child : children_) {
    Solution& down = message_to(child).down.emplace(solution);
    down.steps = cluster_->child_steps(child, steps);
    if (repeats()) last_down_[child] = down;
  }
  if (solution.end == SweepEnd::kRestore) {
    robot_.graph.poses = before_;
  } else {
    before_ = robot_.graph.poses;
    held_->apply(cluster_->own_steps(steps), robot_.graph.poses);
  }
  tell_poses_.clear();  // everybody has the values that the sweeps began with
  finished_ = solution.end == SweepEnd::kFinish;
  rounds_to_end_ = tree_->height() - tree_->depth(robot_.robot) + 1;
  Sweep next;
  next.number = sweep_.number + 1;
  next.relinearise = solution.relinearise;
  next.damping = solution.damping;
  next.mu = solution.mu;
  sweep_ = std::move(next);
}

// ---- messages ----

template <class Pose>
Message<Pose>& SeparatorsSolver<Pose>::message_to(RobotNumber robot) {
  auto& message = outgoing_[robot];
  message.from = robot_.robot;
  message.to = robot;
  message.round = round_;
  return message;
}

template <class Pose>
std::vector<Message<Pose>> SeparatorsSolver<Pose>::messages() {
  for (const NeighbourRobot& neighbour : robot_.neighbours) {
    if (auto news = gossip_.news_for(neighbour.robot); !news.empty())
      message_to(neighbour.robot).topology = std::move(news);
    if (tell_poses_[neighbour.robot]) {
      auto& seen = message_to(neighbour.robot).seen;
      seen = frames_.seen_by(robot_, neighbour);
      if (repeats()) seen->tree = tree_->id();
    }
    tell_poses_[neighbour.robot] = false;
  }
  std::vector<Message<Pose>> messages;
  for (auto& [robot, message] : outgoing_) {
    last_sent_[robot] = round_;
    messages.push_back(std::move(message));
  }
  outgoing_.clear();
  ++round_;
  return messages;
}

template class SeparatorsSolver<SE2>;
template class SeparatorsSolver<SE3>;

}  // namespace radioslam
