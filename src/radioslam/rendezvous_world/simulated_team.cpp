#include "radioslam/rendezvous_world/simulated_team.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/parallel.hpp"

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSquareMetresPerRobot = 200;
constexpr double kArrived_m = 0.5;
constexpr double kObstacleRange_m = 3;
constexpr double kObstacleAzimuths_rad[] = {-kPi / 3, -kPi / 6, 0, kPi / 6, kPi / 3};
constexpr double kTalkInterval_s = 1e-3;
constexpr double kOutlier_m[] = {2, 3}, kOutlierTurn_rad[] = {kPi / 9, 2 * kPi / 9};
constexpr double kOutlierSigmas[] = {2, 3};
constexpr double kLeastStep_m = 1e-6;
constexpr std::uint64_t kSeeds = 2147483647;

double side_of(const RendezvousRunParams& params) {
  return params.side_m > 0 ? params.side_m : std::sqrt(kSquareMetresPerRobot * params.robots);
}

std::string name_of(std::size_t robot) {
  std::string digits = std::to_string(robot + 1);
  return "r" + std::string(5 - std::min<std::size_t>(5, digits.size()), '0') + digits;
}

Eigen::Vector2d drawn_direction(Rng& rng) {
  const double azimuth = rng.uniform(-kPi, kPi);
  return {std::cos(azimuth), std::sin(azimuth)};
}

SE2 with_noise(const SE2& pose, double sigma_m, double sigma_rad, Rng& rng) {
  const double x = rng.normal(0, sigma_m), y = rng.normal(0, sigma_m), turn = rng.normal(0, sigma_rad);
  return {pose.translation() + Eigen::Vector2d(x, y), pose.angle() + turn};
}

bool sends_data(const SimulatedRobot& robot) {
  return std::any_of(robot.outbox.begin(), robot.outbox.end(),
                     [](const OutgoingMessage& message) { return message.reach == Reach::kData; });
}

template <class Action>
void for_all(std::vector<SimulatedRobot>& robots, const Action& action) {
  parallel_for(robots.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) action(k);
  });
}

}  // namespace

Arena arena_of(const RendezvousRunParams& params, std::uint64_t seed) {
  return {side_of(params), params.obstacles, Rng(seed).split("arena")};
}

SimulatedTeam::SimulatedTeam(const RendezvousRunParams& params, const RendezvousRunOptions& options)
    : params_(params),
      options_(options),
      rng_(options.seed),
      arena_(arena_of(params, options.seed)),
      radio_(arena_.walls(), params.radio, rng_.split("radio")) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(params.robots); ++k) {
    SimulatedRobot robot;
    Rng start = rng_.split("start").split(k);
    robot.motion = rng_.split("motion").split(k);
    robot.sensing = rng_.split("sensing").split(k);
    robot.name = name_of(k);
    robot.truth = SE2(arena_.free_place(start), start.uniform(-kPi, kPi));
    robot.waypoint = arena_.free_place(robot.motion);
    robot.trajectory = {robot.truth};
    RobotStart event;
    if (params.starts_known) event.pose = robot.truth;
    RendezvousParams of_robot = params.robot;
    of_robot.seed = static_cast<int>(options.seed % kSeeds);
    robot.agent = std::make_unique<RendezvousRobot>(robot.name, event, of_robot);
    names_[robot.name] = k;
    robots_.push_back(std::move(robot));
  }
}

void SimulatedTeam::step() {
  time_s_ = static_cast<double>(++iteration_);
  for_all(robots_, [&](std::size_t k) { move(robots_[k]); });
  for_all(robots_, [&](std::size_t k) { sense(k); });
  for_all(robots_, [&](std::size_t k) { listen(k); });
  exchange(false);
  for (int round = 0; round < params_.talk_rounds && anybody_sends_data(); ++round) {
    time_s_ += kTalkInterval_s;
    exchange(true);
  }
}

bool SimulatedTeam::all_have_walked() const {
  return params_.metres_each > 0 && std::all_of(robots_.begin(), robots_.end(), [&](const auto& robot) {
           return left_m(robot) < kLeastStep_m;
         });
}

double SimulatedTeam::left_m(const SimulatedRobot& robot) const {
  return params_.metres_each > 0 ? params_.metres_each - robot.walked_m : params_.step_m * 1e9;
}

/// Where a robot would go, before obstacles.
Eigen::Vector2d SimulatedTeam::wanted(SimulatedRobot& robot) {
  if (robot.movement.kind == Movement::Kind::kStay) return robot.truth.translation();
  if (robot.movement.kind == Movement::Kind::kMove) {
    const Eigen::Vector2d offset = robot.raw.inverse() * robot.movement.target;
    const double length = std::min(offset.norm(), params_.robot.max_step_m);
    return length > 0 ? robot.truth * (length * offset.normalized()) : robot.truth.translation();
  }
  const Eigen::Vector2d place = robot.truth.translation();
  if ((robot.waypoint - place).norm() < kArrived_m) robot.waypoint = arena_.free_place(robot.motion);
  const Eigen::Vector2d offset = robot.waypoint - place;
  return place + std::min(1.0, params_.step_m / offset.norm()) * offset;
}

void SimulatedTeam::move(SimulatedRobot& robot) {
  const Eigen::Vector2d from = robot.truth.translation();
  const Eigen::Vector2d target = wanted(robot);
  Eigen::Vector2d to = arena_.reach(from, target);
  const double length = std::min((to - from).norm(), left_m(robot));
  if (robot.movement.kind == Movement::Kind::kExplore &&
      (to - from).norm() + kArrived_m < (target - from).norm())
    robot.waypoint = arena_.free_place(robot.motion);
  if (length < kLeastStep_m) return;
  to = from + length * (to - from).normalized();
  const SE2 before = robot.truth;
  robot.truth = SE2(to, std::atan2(to.y() - from.y(), to.x() - from.x()));
  robot.walked_m += length;
  robot.trajectory.push_back(robot.truth);
  const SE2 step =
      with_noise(before.inverse() * robot.truth, params_.sigma_t_m, params_.sigma_r_rad, robot.motion);
  robot.raw = robot.raw * step;
  robot.agent->move({time_s_, step, params_.sigma_t_m, params_.sigma_r_rad});
}

SE2 SimulatedTeam::measured(const SE2& T_i_j, Rng& rng, bool& wrong) const {
  SE2 pose = with_noise(T_i_j, params_.sigma_t_m, params_.sigma_r_rad, rng);
  Rng error = rng.split("outlier").split(rng.next());
  wrong = error.uniform() < params_.share_of_outliers();
  if (!wrong) return pose;
  const bool gross = params_.outlier_kind == "gross";
  const double sigmas = error.uniform(kOutlierSigmas[0], kOutlierSigmas[1]);
  const double offset_m = gross ? error.uniform(kOutlier_m[0], kOutlier_m[1]) : sigmas * params_.sigma_t_m;
  const double turn = gross ? error.uniform(kOutlierTurn_rad[0], kOutlierTurn_rad[1])
                            : error.uniform(kOutlierSigmas[0], kOutlierSigmas[1]) * params_.sigma_r_rad;
  const Eigen::Vector2d offset = offset_m * drawn_direction(error);
  return {pose.translation() + offset, pose.angle() + (error.uniform() < 0.5 ? -turn : turn)};
}

void SimulatedTeam::sense(std::size_t k) {
  SimulatedRobot& robot = robots_[k];
  robot.seen_before = std::move(robot.seen);
  robot.seen.clear();
  const Eigen::Vector2d here = robot.truth.translation();
  for (std::size_t j = 0; j < robots_.size(); ++j) {
    const SE2& other = robots_[j].truth;
    if (j == k || (other.translation() - here).norm() > params_.sensing_range_m) continue;
    if (!arena_.in_sight(here, other.translation())) continue;
    robot.seen.insert(j);
    bool wrong = false;
    const SE2 pose = measured(robot.truth.inverse() * other, robot.sensing, wrong);
    if (wrong && options_.leave_outliers_out) continue;
    robot.agent->see({time_s_, robots_[j].name, pose, params_.sigma_t_m, params_.sigma_r_rad});
  }
  for (const double azimuth : kObstacleAzimuths_rad)
    if (const auto distance = arena_.wall_ahead(here, robot.truth.angle() + azimuth, kObstacleRange_m))
      robot.agent->meet_obstacle({time_s_, azimuth, *distance});
}

void SimulatedTeam::listen(std::size_t k) {
  SimulatedRobot& robot = robots_[k];
  std::vector<std::pair<double, std::size_t>> nearest;
  for (std::size_t j = 0; j < robots_.size(); ++j)
    if (j != k)
      nearest.emplace_back((robots_[j].truth.translation() - robot.truth.translation()).squaredNorm(), j);
  const std::size_t count = std::min(nearest.size(), static_cast<std::size_t>(params_.radio.max_heard));
  std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
  robot.heard.clear();
  const Rng noise = rng_.split("packets").split(iteration_).split(k);
  for (std::size_t place = 0; place < count; ++place) {
    const std::size_t from = nearest[place].second;
    PacketReception reception =
        radio_.receive(robots_[from].truth.translation(), robot.truth.translation(), noise.split(from));
    if (reception.esnr_db >= 0) robot.heard.push_back({from, std::move(reception)});
  }
  std::sort(robot.heard.begin(), robot.heard.end(),
            [](const HeardRobot& a, const HeardRobot& b) { return a.from < b.from; });
}

bool SimulatedTeam::is_lost(std::size_t from, std::size_t to) const {
  return params_.loss_share > 0 &&
         rng_.split("losses").split(rounds_).split(from).split(to).uniform() < params_.loss_share;
}

/// What others say arrives; in a talk of those alone that have something new to say.
void SimulatedTeam::deliver(std::size_t k, bool talk) {
  SimulatedRobot& robot = robots_[k];
  robot.got_data = robot.got_anything = false;
  for (const HeardRobot& heard : robot.heard) {
    if ((talk && !robots_[heard.from].talks) || is_lost(heard.from, k)) continue;
    HeardPacket packet{time_s_, robots_[heard.from].name, heard.reception.esnr_db, {}, {}};
    for (const PacketPath& path : heard.reception.paths)
      packet.paths.push_back(
          {wrap_angle(path.azimuth_rad - robot.truth.angle()), params_.radio.sigma_aoa_rad, path.power_db});
    bool said = false;
    for (const OutgoingMessage& message : robots_[heard.from].outbox) {
      if (!message.to.empty() && message.to != robot.name) continue;
      if (message.reach == Reach::kData && packet.esnr_db < params_.robot.q_db) continue;
      packet.message = message.message;
      robot.agent->hear(packet);
      robot.got_data = robot.got_data || message.reach == Reach::kData;
      said = true;
    }
    if (!talk && !said) robot.agent->hear(packet);
    robot.got_anything = robot.got_anything || said;
  }
}

void SimulatedTeam::exchange(bool talk) {
  ++rounds_;
  for_all(robots_, [&](std::size_t k) { deliver(k, talk); });
  for_all(robots_, [&](std::size_t k) {
    SimulatedRobot& robot = robots_[k];
    robot.talks = false;
    if (talk && !robot.got_anything && !sends_data(robot)) return;
    TickAnswer answer = robot.agent->tick({time_s_, talk});
    robot.outbox = std::move(answer.messages);
    robot.state = std::move(answer.state);
    if (answer.movement) robot.movement = *answer.movement;
    robot.talks = robot.got_data || sends_data(robot);
  });
}

bool SimulatedTeam::anybody_sends_data() const {
  return std::any_of(robots_.begin(), robots_.end(), sends_data);
}

}  // namespace radioslam
