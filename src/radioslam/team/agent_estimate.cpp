#include "radioslam/team/agent_estimate.hpp"

#include <algorithm>
#include <cstdio>
#include <deque>
#include <set>
#include <utility>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kUnknown = 2;  // strides between clouds that are asked for where nothing aligns two robots

/// A short name of a text, the same on every machine (FNV-1a).
std::string digest_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  char name[17];
  std::snprintf(name, sizeof(name), "%016llx", static_cast<unsigned long long>(hash));
  return name;
}

template <class Pose>
std::optional<std::size_t> number_of(const JointGraph<Pose>& joint, const std::string& robot) {
  for (std::size_t r = 0; r < joint.robots.size(); ++r)
    if (joint.robots[r].id == robot) return r;
  return std::nullopt;
}

template <class Pose>
Eigen::Vector3d position_of(const std::vector<Pose>& poses, PoseId at) {
  return as_se3(poses[at.index()], 0).translation();
}

/// The robot's keyframes where this holds, so far apart.
template <class Pose, class Holds>
std::vector<Stamp> apart(const std::vector<Pose>& poses, const RobotVariables& robot, double stride_m,
                         const Holds& holds) {
  std::vector<Stamp> stamps;
  std::optional<Eigen::Vector3d> last;
  for (std::size_t k = 0; k < robot.poses.size(); ++k) {
    const Eigen::Vector3d here = position_of(poses, robot.poses[k]);
    if ((last && (here - *last).norm() < stride_m) || !holds(here)) continue;
    last = here;
    stamps.push_back(robot.stamps[k]);
  }
  return stamps;
}

/// What a job on scans works with.
template <class Pose>
struct ScanWork {
  const std::string& self;
  const ScansSoFar& own;
  const std::map<std::string, ScansSoFar>& others;
  const std::shared_ptr<const RecognisedPlaces>& tried;
  const GrowingLogs& logs;
  const std::shared_ptr<const TeamSolution<Pose>>& last;
  const std::map<std::string, LoggedKeyframes>& keyframes;
  std::size_t registrations;
};

/// Closures within the robot, and those between robots that an estimate with these scans verifies.
template <class Pose>
ScanResult compare_scans(const ScanWork<Pose>& work, const RunParams& params) {
  ScanResult result{work.own, work.tried, {}};
  const LoggedMission logged = work.logs.mission();
  const auto& robots = logged.mission.robots;
  MeasuredScans measured;
  std::size_t self = robots.size();
  for (std::size_t r = 0; r < robots.size(); ++r) {
    const LoggedKeyframes& known = work.keyframes.at(robots[r].id);
    if (robots[r].id == work.self) {
      self = r;
      if (!result.own.has_any(known)) return result;
      auto search = loop_search(params.scans, params.places.descriptors, logged.mission.dimension);
      search.most = work.others.empty() ? work.registrations : (work.registrations + 1) / 2;
      add_updated(result.own, known, search, {}, measured);
      continue;
    }
    auto& of = measured.robots.emplace_back();
    if (const auto scans = work.others.find(robots[r].id); scans != work.others.end())
      of = scans->second.among(known, true);
  }
  if (self == robots.size()) return result;
  std::vector<VerifiedClosure> closures = closures_of_scans(measured.closures);
  const ScanLoops& own = result.own.loops();
  result.has_left_out = own.has_left_out;
  if (has_comparable_scans(measured)) {
    TeamSolution<Pose> before = *work.last;
    if (work.tried) before.places = work.tried;
    const std::size_t most =
        (before.places ? before.places->attempts.size() : 0) + work.registrations - own.registrations;
    RunOptions options{.lists_overlaps = false};
    options.verifications =
        VerificationBudget{most, VerificationBudget::Order::kWorth, params.places.least_worth, false};
    const auto solution =
        estimate<Pose>(TeamView{logged, measured}, &before, Effort::kJudge, params, options);
    result.tried = solution.places;
    result.has_left_out = result.has_left_out || solution.places->attempts.size() >= most;
    closures.insert(closures.end(), solution.places->closures.begin(), solution.places->closures.end());
  }
  for (const auto& [closure, judgement] : closures) {
    const bool is_first = closure.robot_i == RobotIndex(self);
    if (judgement.status != ClosureStatus::kAccepted || (!is_first && closure.robot_j != RobotIndex(self)))
      continue;
    ClosureRecord said{{},
                       robots[(is_first ? closure.robot_j : closure.robot_i).index()].id,
                       is_first ? closure.stamp_j : closure.stamp_i,
                       closure.T_i_j,
                       inverse<SE3::Jacobian>(closure.information),
                       judgement.statistic,
                       judgement.doubt};
    if (!is_first) {
      const SE3::Jacobian A = said.T_i_j.adjoint();
      said.covariance = A * said.covariance * A.transpose();
      said.T_i_j = said.T_i_j.inverse();
    }
    result.closures.emplace_back(is_first ? closure.stamp_i : closure.stamp_j, std::move(said));
  }
  return result;
}

template <class Pose>
class AgentEstimateOf : public AgentEstimate {
 public:
  AgentEstimateOf(const RunParams& params, const StreamParams& stream) : params_(params), known_(stream) {}

  void hear(const std::string& robot, const std::string& record) override {
    if (auto decoded = decode_record(record)) waiting_[robot].push_back(*std::move(decoded));
  }

  std::optional<EstimateJob> job(Stamp now) override {
    if (is_made_) return std::nullopt;
    take_until(Stamp{now.ns - Stamp::from_seconds(kCut_s).ns}, now);
    auto request = known_.request(now);
    if (!request) return std::nullopt;
    std::string key = last_key_ + '@' + std::to_string(now.ns);
    for (const auto& [robot, records] : heard_) key += ';' + robot + '=' + std::to_string(records);
    key = digest_of(key);
    is_made_ = true;
    made_key_ = key;
    made_at_ = now;
    return EstimateJob{std::move(key), [request = *std::move(request), &params = params_] {
                         return AnyGrownEstimate(estimate<Pose>(request, params));
                       }};
  }

  std::vector<TeamEvent> take(const AnyGrownEstimate& result, Stamp now) override {
    const auto& grown = std::get<GrownEstimate<Pose>>(result);
    if (!is_made_ || grown.at != made_at_) return {};  // asked for before all began anew
    is_made_ = false;
    const bool is_new = grown.solution != nullptr;
    known_.take(grown);
    if (!is_new) return {};
    last_key_ = made_key_;
    return frames_.move_to(known_.last()->team, now, known_.keyframes());
  }

  std::optional<ScanJob> scan_job(const std::string& self, const ScansSoFar& own,
                                  const std::map<std::string, ScansSoFar>& others,
                                  std::shared_ptr<const RecognisedPlaces> tried,
                                  std::size_t registrations) const override {
    if (!known_.last()) return std::nullopt;
    return ScanJob{[self, own, others, tried = std::move(tried), logs = known_.logs(), last = known_.last(),
                    keyframes = known_.keyframes(), registrations, &params = params_] {
      return compare_scans<Pose>({self, own, others, tried, logs, last, keyframes, registrations}, params);
    }};
  }

  std::vector<Stamp> near(const std::string& self, const std::string& other, double range_m,
                          double stride_m) const override {
    if (!known_.last()) return {};
    const TeamEstimate<Pose>& team = known_.last()->team;
    const auto own = number_of(team.joint, self), of = number_of(team.joint, other);
    if (!own || !of) return {};
    const RobotVariables& robot = team.joint.robots[*of];
    std::set<Stamp> near;
    if (team.alignment.component[*own] != team.alignment.component[*of])
      return apart(team.joint.team.graph.poses, robot, kUnknown * stride_m, [](const auto&) { return true; });
    const auto add = [&](const std::vector<Pose>& poses) {
      const auto& way = team.joint.robots[*own].poses;
      const auto stamps = apart(poses, robot, stride_m, [&](const Eigen::Vector3d& here) {
        return std::any_of(way.begin(), way.end(),
                           [&](PoseId at) { return (position_of(poses, at) - here).norm() < range_m; });
      });
      near.insert(stamps.begin(), stamps.end());
    };
    add(team.joint.team.graph.poses);
    for (std::size_t k = 0; k < team.alignment.alternatives.size(); ++k)
      if (team.alignment.alternative_weights[k] >= kMinSearchedWeight) add(team.alignment.alternatives[k]);
    return {near.begin(), near.end()};
  }

  const PublishedFrames& frames() const override { return frames_; }
  const std::map<std::string, LoggedKeyframes>& keyframes() const override { return known_.keyframes(); }
  std::vector<EstimatedTrajectory> largest_frame() const override {
    if (!known_.last()) return {};
    return radioslam::largest_frame(known_.last()->team, frames_);
  }
  std::vector<JudgedClosure> closures() const override {
    std::vector<JudgedClosure> found;
    if (!known_.last()) return found;
    const TeamEstimate<Pose>& team = known_.last()->team;
    const auto add = [&](const std::vector<Closure>& closures, const std::vector<ClosureJudgement>& judged) {
      if (closures.size() != judged.size()) return;
      for (const ClosureResult& of : collect_closures(team.joint, closures, judged))
        found.push_back({team.joint.robots[of.robot_i.index()].id, team.joint.robots[of.robot_j.index()].id,
                         of.stamp_i, of.stamp_j, of.status == ClosureStatus::kAccepted});
    };
    add(team.measured.closures.scans, team.judgement.closures.scans);
    add(team.measured.closures.loops, team.judgement.closures.loops);
    add(team.measured.closures.sequences, team.judgement.closures.sequences);
    return found;
  }
  AnySolution solution() const override { return known_.last(); }
  std::size_t records() const override { return known_.known().records; }

 private:
  /// Of every robot, its log before the first keyframe after a time.
  void take_until(Stamp until, Stamp now) {
    for (auto& [robot, records] : waiting_) {
      const auto is_later = [until](const Record& record) {
        const auto* keyframe = std::get_if<KeyframeRecord>(&record);
        return keyframe && keyframe->stamp > until;
      };
      while (!records.empty() && !is_later(records.front())) {
        known_.hear(robot, std::move(records.front()), now);
        records.pop_front();
        ++heard_[robot];
      }
    }
  }

  const RunParams& params_;
  GrowingEstimate<Pose> known_;
  PublishedFrames frames_;
  std::map<std::string, std::deque<Record>> waiting_;
  std::map<std::string, std::size_t> heard_;
  bool is_made_ = false;
  Stamp made_at_;
  std::string last_key_, made_key_;  ///< of the last solution, and of the job that is made
};

}  // namespace

std::unique_ptr<AgentEstimate> agent_estimate(int dimension, const RunParams& params,
                                              const StreamParams& stream) {
  if (dimension == 2) return std::make_unique<AgentEstimateOf<SE2>>(params, stream);
  return std::make_unique<AgentEstimateOf<SE3>>(params, stream);
}

}  // namespace radioslam
