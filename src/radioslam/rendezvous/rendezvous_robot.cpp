#include "radioslam/rendezvous/rendezvous_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace radioslam {
namespace {

constexpr int kLeastTicks = 5;           ///< without a word before a robot counts as gone
constexpr int kLeastPatience = 20;       ///< decisions before a rendezvous is given up
constexpr int kStillTicks = 10;          ///< after which a partner that does not move is walked to
constexpr int kLooksInVain = 3;          ///< multiple of kappa after which two that cannot exchange data part
constexpr int kAnswerTicks = 5;          ///< in which a chosen partner should have answered
constexpr std::size_t kKeptNodes = 4;    ///< latest own poses whose packets are kept
constexpr std::size_t kKeptPackets = 4;  ///< for each of them
constexpr int kRepeatRounds = 2;         ///< until records that are not confirmed are sent again
constexpr int kRefreshTicks = 10;        ///< after which news of others alone are used
constexpr std::size_t kRestNodes = 3;    ///< poses between two calls
constexpr std::size_t kReceivers = 8;    ///< of data after one tick, besides robots in sight
constexpr std::size_t kMessageBytes = 38000;  ///< of records
constexpr double kMeetingRadius_m = 1.5;
constexpr double kPathLossExponent = 2.2;  ///< for a rough distance where nothing better is known
constexpr double kDecade_db = 10 * kPathLossExponent;
constexpr double kReferenceEsnr_db = 50;  ///< at a metre, roughly
constexpr double kNearest_m = 1;

std::uint64_t seed_of(const std::string& id, int seed) {
  std::uint64_t hash = 1469598103934665603ULL;
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return hash ^ static_cast<std::uint64_t>(seed);
}

/// Where a robot that starts at a time begins to count what it says: above all of a life before.
std::uint64_t first_number(double t_s) {
  constexpr double kPerSecond = 1000;
  return static_cast<std::uint64_t>(std::max(0.0, t_s) * kPerSecond);
}

/// Of the distance between a position and its estimate (m^2).
double expected_square(const UncertainPose<SE2>& pose) {
  return std::max(0.0, pose.covariance.topLeftCorner<2, 2>().trace());
}

double per_axis_sigma(const UncertainPose<SE2>& pose) { return std::sqrt(expected_square(pose) / 2); }

}  // namespace

RendezvousRobot::RendezvousRobot(const std::string& id, const RobotStart& start,
                                 const RendezvousParams& params)
    : id_(id),
      params_(params),
      policy_(policy_of(params)),
      monitor_(monitor_of(params)),
      q_db_(start.q_db.value_or(params.q_db)),
      delta_(start.delta.value_or(params.delta)),
      max_step_m_(start.max_step_m.value_or(params.max_step_m)),
      kappa_(start.kappa.value_or(params.kappa)),
      team_(id, start.t_s, start.pose, params.estimate, {params.direct_ratio, params.angle_threshold_rad}),
      published_(params.omega_t, params.omega_r, seed_of(id, params.seed), start.pose.value_or(SE2())),
      walk_(params),
      statuses_(first_number(start.t_s)),
      now_s_(start.t_s),
      start_s_(start.t_s) {}

void RendezvousRobot::move(const OdometryStep& step) {
  say_observations();
  now_s_ = step.t_s;
  walked_m_ += step.T_previous_body.translation().norm();
  team_.move(step.t_s, step.T_previous_body, step.sigma_m, step.sigma_rad);
  published_.move(step.T_previous_body, step.sigma_m, step.sigma_rad);
}

void RendezvousRobot::see(const SeenRobot& seen) {
  now_s_ = seen.t_s;
  if (seen.robot == id_) return;
  unsaid_.push_back(seen);
}

void RendezvousRobot::hear(const HeardPacket& packet) {
  now_s_ = packet.t_s;
  if (packet.from == id_) return;
  Link& link = links_[packet.from];
  link.heard_s = packet.t_s;
  link.heard_tick = ticks_;
  link.esnr_db = packet.esnr_db;
  link.node = team_.size() - 1;
  auto& packets = link.packets[link.node];
  if (packets.empty() || packets.back().t_s != packet.t_s) packets.push_back({packet.t_s, packet.paths});
  if (packets.size() > kKeptPackets) packets.pop_front();
  while (link.packets.size() > kKeptNodes) link.packets.erase(link.packets.begin());
  if (!packet.message) return;
  const auto& status = packet.message->status;
  if (status && (!link.status || status->number > link.status->number)) {
    if (!link.status || status->walked_m != link.status->walked_m) link.walked_tick = ticks_;
    link.status = {packet.message, &*status};
    team_.logs().note(status->knows);
    link.status_tick = ticks_;
  }
  team_.logs().accept(packet.message->records);
}

void RendezvousRobot::meet_obstacle(const ObstacleAhead& obstacle) {
  now_s_ = obstacle.t_s;
  obstacles_.add(team_.raw_poses().back(), obstacle);
}

/// Says the arrivals of another robot's packets at an own pose, of those next to a time.
void RendezvousRobot::say_angles(const std::string& robot, std::uint32_t node, Stamp stamp) {
  const auto link = links_.find(robot);
  if (link == links_.end()) return;
  const auto packets = link->second.packets.find(node);
  if (packets == link->second.packets.end()) return;
  const auto distance_s = [&](const KeptPacket& packet) {
    return std::abs(seconds_between(stamp, Stamp::from_seconds(packet.t_s)));
  };
  double nearest_s = std::numeric_limits<double>::infinity();
  for (const KeptPacket& packet : packets->second) nearest_s = std::min(nearest_s, distance_s(packet));
  for (KeptPacket& packet : packets->second) {
    if (packet.said || packet.paths.empty() || distance_s(packet) > nearest_s) continue;
    team_.hear(packet.t_s, robot, node, packet.paths);
    packet.said = true;
  }
}

/// Others as they were seen from the latest pose; and to what was seen from a pose, or of it, the angles
/// heard there.
void RendezvousRobot::say_observations() {
  for (const SeenRobot& seen : unsaid_) {
    team_.see(seen.t_s, seen.robot, seen.T_i_j, seen.sigma_m, seen.sigma_rad);
    const auto link = links_.find(seen.robot);
    const bool placed = link != links_.end() && is_placed(link->second);
    published_.see(seen.T_i_j, placed ? std::optional(link->second.status->pose) : std::nullopt);
  }
  unsaid_.clear();
  team_.logs().is_whole_until(Stamp::from_seconds(now_s_));
  for (const auto& [robot, log] : team_.logs().all()) {
    const auto& sightings = log.sightings();
    std::size_t& answered = answered_[robot];
    for (answered = std::min(answered, sightings.size()); answered < sightings.size(); ++answered) {
      const Sighting& seen = sightings[answered];
      if (robot == id_)
        say_angles(seen.robot, seen.keyframe, seen.stamp);
      else if (const auto node = team_.own().keyframe_at(seen.stamp); node && seen.robot == id_)
        say_angles(robot, *node, seen.stamp);
    }
  }
}

/// The news of others alone can wait, and so can a second solution in one talk, except where robots meet on
/// purpose.
void RendezvousRobot::update_estimate(bool talk) {
  say_observations();
  if (!talk) solved_in_talk_ = false;
  const bool own_news = team_.has_own_news();
  const bool meets = call_ || service_ || anchored_.role() == AnchoredExploration::Role::kReturning;
  if (own_news ? talk && !meets && solved_in_talk_ : ticks_ < refresh_tick_) return;
  solved_in_talk_ = talk || solved_in_talk_;
  refresh_tick_ = ticks_ + kRefreshTicks;
  const std::string frame = team_.frame();
  if (!team_.solve()) return;
  if (own_news) ++optimizations_;
  if (own_news || team_.frame() != frame) published_.optimized(team_);
}

bool RendezvousRobot::is_gone(const Link& link) const {
  return now_s_ - link.heard_s > params_.lost_after_s && ticks_ - link.heard_tick >= kLeastTicks;
}

bool RendezvousRobot::has_run_out(double since_s, int since_tick) const {
  return now_s_ - since_s > params_.patience_s && ticks_ - since_tick >= kLeastPatience;
}

const RendezvousRobot::Link* RendezvousRobot::present(const std::string& robot) const {
  const auto link = links_.find(robot);
  return link == links_.end() || is_gone(link->second) ? nullptr : &link->second;
}

/// How often this robot has seen another, whether or not they could exchange what they know.
int RendezvousRobot::seen_since(const std::string& robot, double since_s) const {
  const auto& list = team_.own().sightings();
  const Stamp since = Stamp::from_seconds(since_s);
  return static_cast<int>(std::count_if(list.begin(), list.end(), [&](const Sighting& each) {
    return each.robot == robot && each.stamp >= since;
  }));
}

bool RendezvousRobot::is_shunned(const std::string& robot) const {
  const auto until = shunned_.find(robot);
  return until != shunned_.end() && now_s_ < until->second;
}

bool RendezvousRobot::may_meet(const std::string& robot, const Link& link) const {
  return !is_gone(link) && !is_shunned(robot);
}

/// Whether it is known where another says it is.
bool RendezvousRobot::is_placed(const Link& link) const {
  return link.status && link.status->frame == team_.frame();
}

void RendezvousRobot::shun(const std::string& robot) { shunned_[robot] = now_s_ + params_.patience_s; }

double RendezvousRobot::error() const {
  return monitor_ == ErrorMonitor::kSeed ? published_.value() : expected_square(team_.since_contact());
}

/// Of the error, what came up since the last optimization: what another one could remove.
double RendezvousRobot::removable_error() const {
  return monitor_ == ErrorMonitor::kSeed ? published_.since_optimized() : error();
}

RobotState RendezvousRobot::state() const {
  RobotState state;
  state.error = error();
  state.sigma_m = per_axis_sigma(team_.latest());
  state.asking = call_.has_value();
  if (service_) state.serving = service_->caller;
  if (anchored_.role() == AnchoredExploration::Role::kReturning) state.serving = anchored_.leans_on();
  state.team = team_.team();
  for (const auto& [robot, link] : links_)
    if (is_placed(link) && !std::binary_search(state.team.begin(), state.team.end(), robot))
      state.team.insert(std::upper_bound(state.team.begin(), state.team.end(), robot), robot);
  return state;
}

/// Metres, by the positions that both know, or else roughly by the signal.
double RendezvousRobot::distance_to(const Link& link) const {
  if (is_placed(link))
    return std::max(kNearest_m, (link.status->pose.translation() - team_.latest().pose.translation()).norm());
  return std::max(kNearest_m, std::pow(10.0, (kReferenceEsnr_db - link.esnr_db) / kDecade_db));
}

MeetingOption RendezvousRobot::option_of(const std::string& robot, const Link& link) const {
  return {robot, link.esnr_db, link.status ? link.status->error : 0};
}

bool RendezvousRobot::wants_to_call() const {
  return policy_ == RendezvousPolicy::kActive && !service_ && team_.size() >= calls_after_node_ &&
         error() > delta_ && removable_error() > delta_ / 2;
}

void RendezvousRobot::follow_up_call() {
  if (!call_) {
    if (!wants_to_call()) return;
    call_ = Call{++calls_, error(), now_s_, ticks_, {}, 0, 0, false, false};
  }
  if (!call_->partner.empty()) {
    const Link* link = present(call_->partner);
    const bool done =
        team_.sightings_with(call_->partner, call_->since_s) >= static_cast<std::size_t>(kappa_);
    if (done) {
      ++rendezvous_held_;
      call_.reset();
      calls_after_node_ = team_.size() + kRestNodes;
      return;
    }
    if (link && link->status && link->status->serving == id_) call_->confirmed = true;
    const bool left = call_->confirmed && link && link->status && link->status->serving != id_ &&
                      link->status_tick > call_->partner_tick;
    const bool silent = !call_->confirmed && ticks_ - call_->partner_tick > kAnswerTicks &&
                        now_s_ - call_->partner_s > params_.lost_after_s / 2;
    const int moved_tick = link ? std::max(link->walked_tick, call_->partner_tick) : 0;
    if (call_->confirmed && !call_->goes && link && ticks_ - moved_tick > kStillTicks) {
      call_->goes = true;
      walk_.begin(q_db_);
    }
    const bool in_vain = seen_since(call_->partner, call_->partner_s) > kLooksInVain * kappa_;
    if (link && !left && !silent && !in_vain && !has_run_out(call_->partner_s, call_->partner_tick)) return;
    if (!left && !silent) shun(call_->partner);
    call_->partner.clear();
  }
  if (error() <= delta_)
    call_.reset();
  else
    choose_partner();
}

void RendezvousRobot::choose_partner() {
  std::vector<MeetingOption> offers;
  for (const auto& [robot, link] : links_)
    if (may_meet(robot, link) && link.status && link.status->offer_to == id_)
      offers.push_back(option_of(robot, link));
  const auto best = best_partner(offers, q_db_, params_.alpha);
  if (!best) return;
  call_->partner = *best;
  call_->partner_s = now_s_;
  call_->partner_tick = ticks_;
  call_->confirmed = call_->goes = false;
}

void RendezvousRobot::follow_up_service() {
  if (!service_) return;
  const Link* link = present(service_->caller);
  const bool chosen = link && link->status && link->status->call && link->status->partner == id_;
  service_->seen_chosen = service_->seen_chosen || chosen;
  const bool over = link && link->status && !chosen && service_->seen_chosen;
  if (link && !over && !has_run_out(service_->since_s, service_->since_tick)) return;
  if (!over) shun(service_->caller);
  service_.reset();
  calls_after_node_ = team_.size() + kRestNodes;
}

/// Whose call to follow; the robot sets out where the caller has taken its offer.
void RendezvousRobot::choose_caller() {
  offer_to_.clear();
  const bool waits = call_ && !call_->partner.empty();
  if (service_ || waits || policy_ != RendezvousPolicy::kActive) return;
  std::vector<MeetingOption> callers;
  for (const auto& [robot, link] : links_) {
    if (!may_meet(robot, link) || !link.status || !link.status->call) continue;
    if (link.status->partner == id_) {
      service_ = Service{robot, now_s_, ticks_, true};
      call_.reset();
      walk_.begin(q_db_, link.status->alpha);
      return;
    }
    if (!link.status->partner.empty()) continue;
    // Of two that call each other, the one that knows better where it is stands still.
    if (call_ && std::pair(call_->error, id_) < std::pair(link.status->call_error, robot)) continue;
    callers.push_back(option_of(robot, link));
  }
  if (const auto best = best_caller(callers)) offer_to_ = *best;
}

void RendezvousRobot::write_status(TickAnswer& answer) {
  RobotStatus status;
  status.number = ++statuses_;
  status.error = answer.state.error;
  status.sigma_m = answer.state.sigma_m;
  status.frame = team_.frame();
  status.pose = monitor_ == ErrorMonitor::kSeed ? published_.latest() : team_.latest().pose;
  if (call_) {
    status.call = call_->number;
    status.call_error = call_->error;
    status.alpha = params_.alpha;
    status.partner = call_->partner;
  }
  status.offer_to = offer_to_;
  status.serving = answer.state.serving;
  status.standing = anchored_.role() == AnchoredExploration::Role::kStanding;
  status.leans_on = anchored_.leans_on();
  status.walked_m = walked_m_;
  status.knows = team_.logs().versions(now_s_);
  auto message = std::make_shared<RobotMessage>();
  message->status = std::move(status);
  answer.messages.push_back({{}, Reach::kControl, std::move(message)});
}

bool RendezvousRobot::is_heard_now(const std::string& robot) const {
  const auto link = links_.find(robot);
  return link != links_.end() && ticks_ - link->second.heard_tick <= 1;
}

/// Whether a robot should be sent records of a log: it is not known to have them, and was not sent them just
/// now.
bool RendezvousRobot::lacks(Link& link, const std::string& log, const LogVersion& version) const {
  SentLog& sent = link.sent[log];
  if (sent.life != version.life) sent = {version.life};
  std::uint64_t confirmed = 0;
  if (link.status)
    if (const auto known = link.status->knows.find(log); known != link.status->knows.end()) {
      if (known->second.life > version.life) return false;
      if (known->second.life == version.life) confirmed = known->second.records;
    }
  if (confirmed > sent.confirmed || confirmed >= sent.end) {
    sent.round = rounds_;
    sent.confirmed = confirmed;
    sent.end = std::max(sent.end, confirmed);
  }
  const bool repeats = rounds_ - sent.round >= kRepeatRounds;
  if (repeats) {
    sent.round = rounds_;
    sent.confirmed = sent.end = confirmed;
  }
  // A robot that is heard says its records itself; they are passed on where that does not arrive.
  if (!repeats && log != id_ && is_heard_now(log)) sent.end = std::max(sent.end, version.records);
  return sent.end < version.records;
}

/// Robots that lack something and can be sent it now: those in sight, then those that are heard best.
std::vector<RendezvousRobot::Delivery> RendezvousRobot::deliveries(
    const std::map<std::string, LogVersion>& versions) {
  std::vector<Delivery> list;
  for (auto& [robot, link] : links_) {
    if (link.node + 1 != team_.size() || link.esnr_db < q_db_ || !is_heard_now(robot)) continue;
    Delivery delivery{!sees_now(robot), -link.esnr_db, robot, {}};
    for (const std::string& log : team_.logs().around(robot, params_.estimate.hops)) {
      const auto version = versions.find(log);
      if (version != versions.end() && lacks(link, log, version->second)) delivery.logs.push_back(log);
    }
    if (!delivery.logs.empty()) list.push_back(std::move(delivery));
  }
  std::stable_sort(list.begin(), list.end(), [](const Delivery& a, const Delivery& b) {
    return std::pair(a.out_of_sight, a.minus_esnr_db) < std::pair(b.out_of_sight, b.minus_esnr_db);
  });
  while (list.size() > kReceivers && list.back().out_of_sight) list.pop_back();
  return list;
}

/// To robots with enough signal, the records that they are not known to have.
void RendezvousRobot::write_data(TickAnswer& answer) {
  const auto status = answer.messages.back().message;
  for (const Delivery& delivery : deliveries(status->status->knows)) {
    auto message = std::make_shared<RobotMessage>();
    for (const std::string& log : delivery.logs) {
      if (message->records.size() >= kMessageBytes) break;
      std::uint64_t& end = links_.at(delivery.robot).sent[log].end;
      auto [bytes, next] = team_.logs().records(log, end, kMessageBytes - message->records.size());
      message->records += bytes;
      end = next;
    }
    answer.messages.push_back({delivery.robot, Reach::kData, std::move(message)});
  }
}

std::optional<ExpectedDirection> RendezvousRobot::expected_direction(const Link& link) const {
  if (!is_placed(link)) return std::nullopt;
  const SE2& own = team_.latest().pose;
  const Eigen::Vector2d offset = own.inverse() * link.status->pose.translation();
  const double distance_m = std::max(offset.norm(), kNearest_m);
  const double sigma_m = std::hypot(per_axis_sigma(team_.latest()), link.status->sigma_m);
  const double heading = std::sqrt(std::max(0.0, team_.latest().covariance(2, 2)));
  return ExpectedDirection{std::atan2(offset.y(), offset.x()), std::hypot(sigma_m / distance_m, heading),
                           distance_m - 2 * sigma_m};
}

bool RendezvousRobot::sees_now(const std::string& robot) const {
  const auto& sightings = team_.own().sightings();
  for (auto seen = sightings.rbegin(); seen != sightings.rend() && seen->keyframe + 1 == team_.size(); ++seen)
    if (seen->robot == robot) return true;
  return false;
}

std::vector<AnchorNeighbour> RendezvousRobot::anchor_neighbours() const {
  std::vector<AnchorNeighbour> list;
  for (const auto& [robot, link] : links_) {
    if (!may_meet(robot, link) || !link.status) continue;
    list.push_back({robot, link.status->standing, link.status->leans_on, link.status->error,
                    link.status->walked_m, distance_to(link)});
  }
  return list;
}

/// Whether to explore, to stand, or to come back.
void RendezvousRobot::take_turns() {
  const bool returned = anchored_.role() == AnchoredExploration::Role::kReturning;
  if (returned && team_.sightings_with(anchored_.leans_on(), return_s_) >= static_cast<std::size_t>(kappa_)) {
    ++rendezvous_held_;
    anchored_.met(walked_m_, anchor_neighbours());
  } else if (returned && has_run_out(return_s_, return_tick_)) {
    shun(anchored_.leans_on());
  }
  anchored_.decide(id_, removable_error(), walked_m_, anchor_neighbours(), {delta_, params_.anchor_range_m});
  if (anchored_.role() != AnchoredExploration::Role::kReturning || returned) return;
  return_s_ = now_s_;
  return_tick_ = ticks_;
  walk_.begin(q_db_);
}

Movement RendezvousRobot::walk_to(const std::string& robot) {
  const Link& link = links_.at(robot);
  // In sight without the signal for data, it goes on.
  if (sees_now(robot) && link.esnr_db >= q_db_) return {Movement::Kind::kStay};
  const auto packets = link.packets.find(team_.size() - 1);
  if (packets == link.packets.end()) return {Movement::Kind::kStay};
  const auto target = walk_.next(team_.raw_poses().back(), link.esnr_db, packets->second.back().paths,
                                 expected_direction(link), max_step_m_, obstacles_);
  if (!target) return {Movement::Kind::kStay};
  return {Movement::Kind::kMove, *target};
}

std::optional<Movement> RendezvousRobot::go_to_meeting_place() {
  const double due_s = start_s_ + (meetings_held_ + 1) * params_.meeting_every_s;
  if (now_s_ < due_s) return std::nullopt;
  const Eigen::Vector2d place(params_.meeting_x_m, params_.meeting_y_m);
  const Eigen::Vector2d offset = team_.latest().pose.inverse() * place;
  if (offset.norm() < kMeetingRadius_m && !at_place_s_) at_place_s_ = now_s_;
  const bool over =
      at_place_s_ ? now_s_ - *at_place_s_ >= params_.meeting_wait_s : now_s_ - due_s > params_.patience_s;
  if (over) {
    ++meetings_held_;
    while (start_s_ + (meetings_held_ + 1) * params_.meeting_every_s <= now_s_) ++meetings_held_;
    at_place_s_.reset();
    return std::nullopt;
  }
  if (at_place_s_) return Movement{Movement::Kind::kStay};
  const SE2& raw = team_.raw_poses().back();
  const double length_m = std::min(max_step_m_, offset.norm());
  const double heading = obstacles_.free_heading(
      raw.translation(), wrap_angle(raw.angle() + std::atan2(offset.y(), offset.x())), length_m);
  return Movement{Movement::Kind::kMove,
                  raw.translation() + length_m * Eigen::Vector2d(std::cos(heading), std::sin(heading))};
}

/// Whether it is worth waiting for somebody to answer: there are robots, which may be busy with others.
bool RendezvousRobot::may_be_answered() const {
  return !has_run_out(call_->since_s, call_->since_tick) &&
         std::any_of(links_.begin(), links_.end(),
                     [&](const auto& each) { return may_meet(each.first, each.second); });
}

Movement RendezvousRobot::decide() {
  if (service_) return walk_to(service_->caller);
  if (policy_ == RendezvousPolicy::kAnchored) {
    take_turns();
    if (anchored_.role() == AnchoredExploration::Role::kReturning) return walk_to(anchored_.leans_on());
    if (anchored_.waits()) return {Movement::Kind::kStay};
  }
  if (call_ && call_->goes && !call_->partner.empty()) return walk_to(call_->partner);
  if (call_ && (!call_->partner.empty() || may_be_answered())) return {Movement::Kind::kStay};
  if (policy_ == RendezvousPolicy::kScheduled)
    if (const auto movement = go_to_meeting_place()) return *movement;
  return {};
}

TickAnswer RendezvousRobot::tick(const DecisionTick& tick) {
  now_s_ = tick.t_s;
  update_estimate(tick.talk);
  TickAnswer answer;
  if (!tick.talk) ++ticks_;
  ++rounds_;
  follow_up_service();
  follow_up_call();
  choose_caller();
  if (!tick.talk) answer.movement = decide();
  answer.state = state();
  write_status(answer);
  write_data(answer);
  return answer;
}

FinalTrajectory RendezvousRobot::finish() {
  say_observations();
  team_.solve(RobotEstimate::Odometry::kWhole);
  const auto seconds = [](Stamp stamp) { return static_cast<double>(stamp.ns) / 1e9; };
  FinalTrajectory trajectory;
  for (std::size_t k = 0; k < team_.size(); ++k)
    trajectory.rows.push_back({seconds(team_.own().stamps()[k]), team_.poses()[k]});
  trajectory.frame = team_.frame();
  for (std::size_t k = 0; k < team_.own().sightings().size(); ++k)
    trajectory.measurements.push_back(
        {seconds(team_.own().sightings()[k].stamp), team_.own().sightings()[k].robot, team_.weight(k)});
  return trajectory;
}

}  // namespace radioslam
