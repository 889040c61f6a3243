#include "radioslam/study/rendezvous/rendezvous_run.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/rendezvous/rendezvous_robot.hpp"

namespace radioslam {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSquareMetresPerRobot = 200;
constexpr double kArrived_m = 0.5;
constexpr int kIterationsPerStep = 20;  ///< where metres count, not iterations: before a run is given up
constexpr double kObstacleRange_m = 3;
constexpr double kObstacleAzimuths_rad[] = {-kPi / 3, -kPi / 6, 0, kPi / 6, kPi / 3};
constexpr double kTalkInterval_s = 1e-3;
constexpr double kOutlier_m[] = {2, 3}, kOutlierTurn_rad[] = {kPi / 9, 2 * kPi / 9};
constexpr double kOutlierSigmas[] = {2, 3};
constexpr double kLeastStep_m = 1e-6;

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

/// A robot that hears another where they are now.
struct Heard {
  std::size_t from = 0;
  PacketReception reception;
};

struct SimulatedRobot {
  std::unique_ptr<RendezvousRobot> agent;
  SE2 truth, raw;
  std::vector<SE2> trajectory;  ///< true poses, per pose of its estimate
  Eigen::Vector2d waypoint = Eigen::Vector2d::Zero();
  double walked_m = 0;
  Movement movement;
  RobotState state;
  std::vector<OutgoingMessage> outbox;
  std::vector<Heard> heard;
  std::set<std::size_t> seen, seen_before;
  std::optional<double> crossed;  ///< error at which it passed the threshold
  int rendezvous = 0;
  Rng motion{0}, sensing{0};
};

class Simulation {
 public:
  Simulation(const RendezvousRunParams& params, const RendezvousRunOptions& options)
      : params_(params), options_(options), rng_(options.seed), arena_(arena_of(params, options.seed)),
        radio_(arena_.walls(), params.radio, rng_.split("radio")),
        cells_(static_cast<std::size_t>(std::ceil(arena_.side_m()))), covered_(cells_ * cells_, false) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(params.robots); ++k) {
      SimulatedRobot robot;
      Rng start = rng_.split("start").split(k);
      robot.motion = rng_.split("motion").split(k);
      robot.sensing = rng_.split("sensing").split(k);
      robot.truth = SE2(arena_.free_place(start), start.uniform(-kPi, kPi));
      robot.waypoint = arena_.free_place(robot.motion);
      robot.trajectory = {robot.truth};
      RobotStart event;
      if (params.starts_known) event.pose = robot.truth;
      RendezvousParams of_robot = params.robot;
      of_robot.seed = static_cast<int>(options.seed % 2147483647U);
      robot.agent = std::make_unique<RendezvousRobot>(name_of(k), event, of_robot);
      names_[name_of(k)] = k;
      robots_.push_back(std::move(robot));
    }
    run_.delta = robots_.front().agent->delta();
  }

  RendezvousRun run(const Progress& progress) {
    const auto begin = std::chrono::steady_clock::now();
    const int limit = params_.metres_each > 0
                          ? static_cast<int>(kIterationsPerStep * params_.metres_each / params_.step_m)
                          : params_.iterations;
    for (iteration_ = 1; iteration_ <= limit && !all_have_walked(); ++iteration_) {
      report_progress(progress, "iterations", static_cast<double>(iteration_ - 1) / limit);
      time_s_ = iteration_;
      move_all();
      sense_all();
      listen_all();
      exchange(false);
      for (int round = 0; round < params_.talk_rounds && anybody_sends_data(); ++round) {
        time_s_ += kTalkInterval_s;
        exchange(true);
      }
      record();
    }
    conclude();
    run_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return std::move(run_);
  }

 private:
  bool all_have_walked() const {
    return params_.metres_each > 0 && std::all_of(robots_.begin(), robots_.end(), [&](const auto& robot) {
             return left_m(robot) < kLeastStep_m;
           });
  }
  double left_m(const SimulatedRobot& robot) const {
    return params_.metres_each > 0 ? params_.metres_each - robot.walked_m : params_.step_m * 1e9;
  }

  /// Where a robot would go, before obstacles.
  Eigen::Vector2d wanted(SimulatedRobot& robot) {
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

  void move(SimulatedRobot& robot) {
    const Eigen::Vector2d from = robot.truth.translation();
    const Eigen::Vector2d target = wanted(robot);
    Eigen::Vector2d to = arena_.reach(from, target);
    const double length = std::min((to - from).norm(), left_m(robot));
    if (robot.movement.kind == Movement::Kind::kExplore && (to - from).norm() + kArrived_m < (target - from).norm())
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

  void move_all() {
    parallel_for(robots_.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) move(robots_[k]);
    });
  }

  SE2 measured(const SE2& T_i_j, Rng& rng, bool& wrong) const {
    SE2 pose = with_noise(T_i_j, params_.sigma_t_m, params_.sigma_r_rad, rng);
    Rng error = rng.split("outlier").split(rng.next());
    wrong = error.uniform() < params_.share_of_outliers();
    if (!wrong) return pose;
    const bool gross = params_.outlier_kind == "gross";
    const double sigmas = error.uniform(kOutlierSigmas[0], kOutlierSigmas[1]);
    const double offset_m =
        gross ? error.uniform(kOutlier_m[0], kOutlier_m[1]) : sigmas * params_.sigma_t_m;
    const double turn = gross ? error.uniform(kOutlierTurn_rad[0], kOutlierTurn_rad[1])
                              : error.uniform(kOutlierSigmas[0], kOutlierSigmas[1]) * params_.sigma_r_rad;
    const Eigen::Vector2d offset = offset_m * drawn_direction(error);
    return {pose.translation() + offset, pose.angle() + (error.uniform() < 0.5 ? -turn : turn)};
  }

  void sense(std::size_t k) {
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
      robot.agent->see({time_s_, name_of(j), pose, params_.sigma_t_m, params_.sigma_r_rad});
    }
    for (const double azimuth : kObstacleAzimuths_rad)
      if (const auto distance = arena_.wall_ahead(here, robot.truth.angle() + azimuth, kObstacleRange_m))
        robot.agent->meet_obstacle({time_s_, azimuth, *distance});
  }

  void sense_all() {
    parallel_for(robots_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) sense(k);
    });
  }

  void listen(std::size_t k) {
    SimulatedRobot& robot = robots_[k];
    std::vector<std::pair<double, std::size_t>> nearest;
    for (std::size_t j = 0; j < robots_.size(); ++j)
      if (j != k)
        nearest.emplace_back((robots_[j].truth.translation() - robot.truth.translation()).squaredNorm(), j);
    const std::size_t count = std::min(nearest.size(), static_cast<std::size_t>(params_.radio.max_heard));
    std::partial_sort(nearest.begin(), nearest.begin() + static_cast<std::ptrdiff_t>(count), nearest.end());
    robot.heard.clear();
    const Rng noise = rng_.split("packets").split(static_cast<std::uint64_t>(iteration_)).split(k);
    for (std::size_t place = 0; place < count; ++place) {
      const std::size_t from = nearest[place].second;
      PacketReception reception = radio_.receive(robots_[from].truth.translation(),
                                                 robot.truth.translation(), noise.split(from));
      if (reception.esnr_db >= 0) robot.heard.push_back({from, std::move(reception)});
    }
    std::sort(robot.heard.begin(), robot.heard.end(),
              [](const Heard& a, const Heard& b) { return a.from < b.from; });
  }

  void listen_all() {
    parallel_for(robots_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) listen(k);
    });
  }

  bool is_lost(std::size_t from, std::size_t to) const {
    return params_.loss_share > 0 &&
           rng_.split("losses").split(rounds_).split(from).split(to).uniform() < params_.loss_share;
  }

  void deliver(std::size_t k, bool beacons) {
    SimulatedRobot& robot = robots_[k];
    for (const Heard& heard : robot.heard) {
      if (is_lost(heard.from, k)) continue;
      HeardPacket packet{time_s_, name_of(heard.from), heard.reception.esnr_db, {}, {}};
      for (const PacketPath& path : heard.reception.paths)
        packet.paths.push_back({wrap_angle(path.azimuth_rad - robot.truth.angle()),
                                params_.radio.sigma_aoa_rad, path.power_db});
      bool said = false;
      for (const OutgoingMessage& message : robots_[heard.from].outbox) {
        if (!message.to.empty() && message.to != name_of(k)) continue;
        if (message.reach == Reach::kData && packet.esnr_db < params_.robot.q_db) continue;
        HeardPacket with_message = packet;
        with_message.message = message.message;
        robot.agent->hear(with_message);
        said = true;
      }
      if (beacons && !said) robot.agent->hear(packet);
    }
  }

  void exchange(bool talk) {
    ++rounds_;
    parallel_for(robots_.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) deliver(k, !talk);
    });
    parallel_for(robots_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        TickAnswer answer = robots_[k].agent->tick({time_s_, talk});
        robots_[k].outbox = std::move(answer.messages);
        robots_[k].state = std::move(answer.state);
        if (answer.movement) robots_[k].movement = *answer.movement;
      }
    });
  }

  bool anybody_sends_data() const {
    return std::any_of(robots_.begin(), robots_.end(), [](const SimulatedRobot& robot) {
      return std::any_of(robot.outbox.begin(), robot.outbox.end(),
                         [](const OutgoingMessage& message) { return message.reach == Reach::kData; });
    });
  }

  /// The squared error of the latest pose per degree of freedom, by its stated covariance.
  static std::optional<double> nees_of(const SimulatedRobot& robot) {
    const auto& latest = robot.agent->estimate().latest();
    if (!robot.agent->estimate().frame().empty()) return std::nullopt;
    const Eigen::LLT<SE2::Jacobian> factor(latest.covariance);
    if (factor.info() != Eigen::Success) return std::nullopt;
    const SE2::Tangent error = (latest.pose.inverse() * robot.truth).log();
    return error.dot(factor.solve(error)) / SE2::kDof;
  }

  void watch_threshold(std::size_t k) {
    SimulatedRobot& robot = robots_[k];
    const double error = robot.state.error;
    const int held = robot.agent->rendezvous_held();
    const bool optimized = held > robot.rendezvous;
    robot.rendezvous = held;
    if (robot.crossed && (error <= run_.delta || optimized)) {
      run_.crossings.push_back({iteration_, static_cast<int>(k), *robot.crossed, error});
      robot.crossed.reset();
    } else if (error > run_.delta) {
      robot.crossed = std::max(error, robot.crossed.value_or(0));
    }
  }

  void cover(const Eigen::Vector2d& place) {
    const auto reach = static_cast<std::ptrdiff_t>(std::ceil(params_.sensing_range_m));
    const auto cells = static_cast<std::ptrdiff_t>(cells_);
    const auto x = static_cast<std::ptrdiff_t>(place.x()), y = static_cast<std::ptrdiff_t>(place.y());
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, x - reach); i <= std::min(cells - 1, x + reach); ++i)
      for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, y - reach); j <= std::min(cells - 1, y + reach); ++j) {
        const Eigen::Vector2d centre(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
        if ((centre - place).norm() <= params_.sensing_range_m)
          covered_[static_cast<std::size_t>(i * cells + j)] = true;
      }
  }

  void record() {
    double sum = 0, squares = 0, sigma = 0;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      SimulatedRobot& robot = robots_[k];
      sum += robot.state.error;
      squares += robot.state.error * robot.state.error;
      sigma += robot.state.sigma_m;
      watch_threshold(k);
      cover(robot.truth.translation());
      if (const auto nees = nees_of(robot)) {
        nees_sum_ += *nees;
        ++nees_count_;
      }
      for (const std::size_t other : robot.seen)
        if (other > k && !robot.seen_before.contains(other)) ++run_.meetings;
    }
    const auto count = static_cast<double>(robots_.size());
    run_.error.push_back(sum / count);
    run_.error_std.push_back(std::sqrt(std::max(0.0, squares / count - sum / count * sum / count)));
    run_.sigma_m.push_back(sigma / count);
    if (options_.keep_moments) run_.moments.push_back(moments());
  }

  std::vector<RobotMoment> moments() const {
    std::vector<RobotMoment> list;
    for (const SimulatedRobot& robot : robots_) {
      RobotMoment moment{robot.truth,       robot.agent->estimate().latest().pose,
                         robot.state.error, robot.state.sigma_m,
                         robot.state.asking, !robot.seen.empty()};
      if (!robot.state.serving.empty())
        moment.serving = static_cast<std::int32_t>(names_.at(robot.state.serving));
      list.push_back(moment);
    }
    return list;
  }

  void conclude() {
    std::size_t poses = 0;
    double trans = 0, rot = 0, ratio = 0;
    int placed = 0;
    for (SimulatedRobot& robot : robots_) {
      const FinalTrajectory estimate = robot.agent->finish();
      for (std::size_t k = 0; k < estimate.rows.size(); ++k) {
        const SE2& pose = estimate.rows[k].pose;
        trans += (pose.translation() - robot.trajectory[k].translation()).squaredNorm();
        // |R^T R' - I|_F^2 = 4 (1 - cos) in the plane.
        rot += 4 * (1 - std::cos(pose.angle() - robot.trajectory[k].angle()));
        ++poses;
      }
      const RobotState last = robot.agent->state();
      if (last.sigma_m > 0) {
        const double error = (estimate.rows.back().pose.translation() - robot.truth.translation()).squaredNorm();
        ratio += error / (2 * last.sigma_m * last.sigma_m);
        ++placed;
      }
      if (robot.crossed) ++run_.open_crossings;
      run_.metres_walked += robot.walked_m;
    }
    run_.ate_trans_mean_squared = trans / static_cast<double>(poses);
    run_.ate_rot_mean_squared = rot / static_cast<double>(poses);
    run_.position_squared_per_axis_sigma = placed > 0 ? ratio / placed : 0;
    run_.nees = nees_count_ > 0 ? nees_sum_ / static_cast<double>(nees_count_) : 0;
    run_.iterations = iteration_ - 1;
    run_.covered_m2 = static_cast<double>(std::count(covered_.begin(), covered_.end(), true));
  }

  RendezvousRunParams params_;
  RendezvousRunOptions options_;
  Rng rng_;
  Arena arena_;
  PacketRadio radio_;
  std::vector<SimulatedRobot> robots_;
  std::map<std::string, std::size_t> names_;
  std::size_t cells_;
  std::vector<bool> covered_;
  int iteration_ = 0;
  std::uint64_t rounds_ = 0;
  double time_s_ = 0;
  double nees_sum_ = 0;
  std::size_t nees_count_ = 0;
  RendezvousRun run_;
};

}  // namespace

Arena arena_of(const RendezvousRunParams& params, std::uint64_t seed) {
  return {side_of(params), params.obstacles, Rng(seed).split("arena")};
}

RendezvousRun run_rendezvous(const RendezvousRunParams& params, const RendezvousRunOptions& options,
                             const Progress& progress) {
  return Simulation(params, options).run(progress);
}

}  // namespace radioslam
