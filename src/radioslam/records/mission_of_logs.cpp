#include "radioslam/records/mission_of_logs.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "radioslam/records/logs_of_mission.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kLeastSpeed_mps = 0.5, kFastest = 3;  // of unknown motion, the latter in the mean speed
constexpr double kLeastUnknown_m = 1;

/// One robot's records, decoded.
struct RobotRecords {
  std::string id;
  DecodedRecords records;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> gaps;
};

/// The robot's keyframes in one frame, and the motion between any two that follow each other.
class KeyframeChain {
 public:
  /// Whether all its steps are known; those that are not have a wide covariance.
  std::size_t unknown_steps() const { return unknown_; }
  const std::vector<StampedPose<SE3>>& poses() const { return poses_; }
  const std::vector<OdometryStepNoise>& steps() const { return steps_; }

  void add(const KeyframeRecord& keyframe) {
    if (!poses_.empty() && keyframe.stamp <= poses_.back().stamp) return void(++out_of_order_);
    if (poses_.empty()) {
      poses_.push_back({keyframe.stamp, keyframe.T_before_this});
    } else if (keyframe.number == number_ + 1) {
      const SE3 pose = poses_.back().pose * keyframe.T_before_this;
      travelled_m_ += keyframe.T_before_this.translation().norm();
      known_s_ += seconds_between(poses_.back().stamp, keyframe.stamp);
      if (keyframe.covariance) add_step(keyframe.stamp, *keyframe.covariance);
      poses_.push_back({keyframe.stamp, pose});
    } else {
      add_unknown_step(keyframe.stamp);
    }
    number_ = keyframe.number;
    index_[number_] = poses_.size() - 1;
  }

  /// The pose of a measurement; nothing if its keyframe is not known.
  std::optional<SE3> pose(const PoseAt& at) const {
    const auto found = index_.find(at.keyframe);
    if (found == index_.end() || at.stamp < poses_[found->second].stamp) return std::nullopt;
    return poses_[found->second].pose * at.T_keyframe_body;
  }

  std::size_t out_of_order() const { return out_of_order_; }

 private:
  void add_step(Stamp stamp, const SE3::Jacobian& covariance) {
    const Stamp before = poses_.back().stamp;
    steps_.push_back({before, stamp, covariance / seconds_between(before, stamp)});
  }

  void add_unknown_step(Stamp stamp) {
    const double dt_s = seconds_between(poses_.back().stamp, stamp);
    const double speed = known_s_ > 0 ? travelled_m_ / known_s_ : 0;
    const double wide_m = kLeastUnknown_m + dt_s * std::max(kLeastSpeed_mps, kFastest * speed);
    add_step(stamp, isotropic_covariance(wide_m, std::numbers::pi));
    poses_.push_back({stamp, poses_.back().pose});
    ++unknown_;
  }

  std::vector<StampedPose<SE3>> poses_;
  std::vector<OdometryStepNoise> steps_;
  std::map<std::uint32_t, std::size_t> index_;  ///< of a keyframe by its number
  std::uint32_t number_ = 0;
  double travelled_m_ = 0, known_s_ = 0;
  std::size_t unknown_ = 0, out_of_order_ = 0;
};

/// A measurement with the place that it has in the team's lists.
template <class Measured>
struct Placed {
  Stamp stamp;
  std::size_t robot = 0, number = 0;
  Measured measured;
};
template <class Measured>
std::vector<Measured> in_order(std::vector<Placed<Measured>> placed) {
  std::sort(placed.begin(), placed.end(), [](const auto& a, const auto& b) {
    return std::tie(a.stamp, a.robot, a.number) < std::tie(b.stamp, b.robot, b.number);
  });
  std::vector<Measured> result;
  for (auto& of : placed) result.push_back(std::move(of.measured));
  return result;
}

/// Whether the names differ in a number at their ends alone.
bool are_numbered(const std::vector<RobotRecords>& robots) {
  std::set<std::string> names;
  for (const RobotRecords& robot : robots) {
    const std::size_t last = robot.id.find_last_not_of("0123456789") + 1;
    if (last == robot.id.size()) return false;
    names.insert(robot.id.substr(0, last));
  }
  return names.size() == 1;
}

/// Gives keyframes the motion that the robot last said.
void amend(DecodedRecords& records) {
  std::map<std::uint32_t, AmendedStep> amended;
  for (const auto& record : records)
    if (const auto* of = std::get_if<AmendmentRecord>(record.get()))
      for (std::size_t k = 0; k < of->steps.size(); ++k)
        amended[of->first + static_cast<std::uint32_t>(k)] = of->steps[k];
  if (amended.empty()) return;
  for (auto& record : records)
    if (const auto* said = std::get_if<KeyframeRecord>(record.get()))
      if (const auto found = amended.find(said->number); found != amended.end()) {
        KeyframeRecord keyframe = *said;
        keyframe.T_before_this = found->second.T_before_this;
        keyframe.covariance = found->second.covariance;
        record = std::make_shared<const Record>(std::move(keyframe));
      }
}

template <class Kind, class Take>
void for_each(const RobotRecords& robot, const Take& take) {
  for (std::size_t n = 0; n < robot.records.size(); ++n)
    if (const auto* record = std::get_if<Kind>(robot.records[n].get())) take(*record, n);
}

/// Indices in the mission.
struct TeamNames {
  std::map<std::string, std::size_t> anchors, robots;

  /// Nothing if the robot or anchor is not known.
  std::optional<LinkEnd> end_of(const LinkPeer& peer) const {
    LinkEnd end;
    end.antenna = peer.antenna;
    end.lever_arm_m = peer.lever_arm_m;
    const auto& names = peer.is_anchor ? anchors : robots;
    const auto found = names.find(peer.name);
    if (found == names.end()) return std::nullopt;
    if (peer.is_anchor)
      end.anchor = AnchorIndex(found->second);
    else
      end.robot = RobotIndex(found->second);
    return end;
  }
};

/// Adds the robots' measurements to a mission that has these robots, anchors and access points.
class LoggedMeasurements {
 public:
  LoggedMeasurements(const TeamNames& names, Mission& mission) : names_(names), mission_(mission) {}

  /// Returns what was left out, and why.
  std::vector<std::string> add(const RobotRecords& of, std::size_t r, const KeyframeChain& chain) {
    unknown_.clear();
    untied_ = unheard_ = 0;
    const auto tied = [&](const auto& take) {
      return [this, &chain, &take](const auto& record, std::size_t n) {
        chain.pose(record.at) ? take(record, n) : void(++untied_);
      };
    };
    for_each<RangeRecord>(of, tied([&](const RangeRecord& range, std::size_t n) { add(range, r, n); }));
    for_each<AnglesRecord>(of, tied([&](const AnglesRecord& angles, std::size_t n) { add(angles, r, n); }));
    for_each<ClosureRecord>(of,
                            tied([&](const ClosureRecord& closure, std::size_t n) { add(closure, r, n); }));
    Robot& robot = mission_.robots[r];
    for_each<FixRecord>(of, tied([&](const FixRecord& fix, std::size_t) {
                          robot.fixes.push_back({fix.at.stamp, fix.position_m, fix.sigma_m});
                        }));
    const auto access_points = access_points_of(of);
    for_each<FingerprintRecord>(of, tied([&](const FingerprintRecord& fingerprint, std::size_t) {
                                  robot.wifi.push_back(scan_of(fingerprint, access_points));
                                }));
    sort_by_time(robot.fixes);
    sort_by_time(robot.wifi);
    return notes();
  }

  void finish(LoggedMission& result) && {
    result.mission.ranges = in_order(std::move(ranges_));
    result.mission.aoa_measurements = in_order(std::move(angles_));
    result.mission.matches = in_order(std::move(matches_));
    result.closures = in_order(std::move(scanned_));
  }

 private:
  using AccessPoints = std::map<std::uint32_t, WifiReading>;  ///< without a signal strength

  void add(const RangeRecord& range, std::size_t r, std::size_t n) {
    auto other = names_.end_of(range.other);
    if (!other) return void(unknown_.insert(range.other.name));
    LinkEnd own{RobotIndex(r), {}, range.antenna, range.lever_arm_m};
    if (range.is_other_first) std::swap(own, *other);
    ranges_.push_back({range.at.stamp, r, n, {range.at.stamp, own, *other, range.range_m, range.sigma_m}});
  }
  void add(const AnglesRecord& angles, std::size_t r, std::size_t n) {
    const auto transmitter = names_.end_of(angles.transmitter);
    if (!transmitter) return void(unknown_.insert(angles.transmitter.name));
    angles_.push_back({angles.at.stamp, r, n, {angles.at.stamp, RobotIndex(r), *transmitter, angles.paths}});
  }
  void add(const ClosureRecord& closure, std::size_t r, std::size_t n) {
    const auto other = names_.robots.find(closure.other);
    if (other == names_.robots.end()) return void(unknown_.insert(closure.other));
    const RobotIndex i(r), j(other->second);
    if (i == j && closure.at.stamp == closure.stamp_other) return;  // says nothing
    if (closure.inlier_ratio)
      return scanned_.push_back({closure.at.stamp,
                                 r,
                                 n,
                                 {i, j, closure.at.stamp, closure.stamp_other, closure.T_i_j,
                                  closure.covariance, *closure.inlier_ratio, closure.doubt}});
    matches_.push_back({closure.at.stamp,
                        r,
                        n,
                        {i, j, closure.at.stamp, closure.stamp_other, closure.T_i_j, closure.covariance}});
  }

  AccessPoints access_points_of(const RobotRecords& of) const {
    const std::vector<std::string>& known = mission_.access_points;
    AccessPoints result;
    for_each<AccessPointRecord>(of, [&](const AccessPointRecord& heard, std::size_t) {
      const auto found = std::lower_bound(known.begin(), known.end(), heard.bssid);
      result[heard.number] = {AccessPointIndex(static_cast<std::size_t>(found - known.begin())),
                              heard.frequency_mhz, 0};
    });
    return result;
  }

  WifiScan scan_of(const FingerprintRecord& fingerprint, const AccessPoints& access_points) {
    WifiScan scan{fingerprint.at.stamp, {}};
    for (const HeardAccessPoint& heard : fingerprint.readings) {
      const auto found = access_points.find(heard.number);
      if (found == access_points.end()) {
        ++unheard_;
        continue;
      }
      scan.readings.push_back(found->second);
      scan.readings.back().rssi_dbm = heard.rssi_dbm;
    }
    std::stable_sort(scan.readings.begin(), scan.readings.end(),
                     [](const auto& a, const auto& b) { return a.access_point < b.access_point; });
    return scan;
  }

  template <class Measured>
  static void sort_by_time(std::vector<Measured>& measured) {
    std::stable_sort(measured.begin(), measured.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    for (const std::string& name : unknown_)
      notes.push_back("measurements to " + name + " are left out: its log is not among these");
    if (untied_ > 0)
      notes.push_back(std::to_string(untied_) +
                      " measurements are left out: the keyframes before them are missing");
    if (unheard_ > 0)
      notes.push_back(std::to_string(unheard_) +
                      " signal strengths are left out: the names of their access points are missing");
    return notes;
  }

  const TeamNames& names_;
  Mission& mission_;
  std::set<std::string> unknown_;
  std::size_t untied_ = 0, unheard_ = 0;
  std::vector<Placed<RangeMeasurement>> ranges_;
  std::vector<Placed<AoaMeasurement>> angles_;
  std::vector<Placed<PoseMatch>> matches_;
  std::vector<Placed<ScannedClosure>> scanned_;
};

class MissionBuilder {
 public:
  explicit MissionBuilder(const TeamLog& team) {
    for (const auto& [id, log] : team.robots()) {
      RobotRecords& robot = robots_.emplace_back(RobotRecords{id, {}, log.gaps()});
      for (const auto& [number, bytes] : log.records)
        if (auto record = decode_record(bytes))
          robot.records.push_back(std::make_shared<const Record>(*std::move(record)));
    }
    prepare();
  }
  explicit MissionBuilder(const std::map<std::string, DecodedRecords>& team) {
    for (const auto& [id, records] : team) robots_.push_back({id, records, {}});
    prepare();
  }

  LoggedMission build() {
    leave_out_robots_without_odometry();
    if (robots_.empty()) throw std::runtime_error("no robot of these logs has two keyframes");
    collect_names();
    for (std::size_t r = 0; r < robots_.size(); ++r) add_robot(r);
    LoggedMeasurements measurements(names_, result_.mission);
    for (std::size_t r = 0; r < robots_.size(); ++r)
      for (const std::string& text : measurements.add(robots_[r], r, chains_[r])) note(robots_[r], text);
    std::move(measurements).finish(result_);
    return std::move(result_);
  }

 private:
  void prepare() {
    for (RobotRecords& robot : robots_) amend(robot.records);
    if (are_numbered(robots_))
      std::stable_sort(robots_.begin(), robots_.end(),
                       [](const auto& a, const auto& b) { return a.id.size() < b.id.size(); });
  }

  void note(const RobotRecords& robot, const std::string& text) {
    result_.notes.push_back("log of robot " + robot.id + ": " + text);
  }

  void leave_out_robots_without_odometry() {
    std::erase_if(robots_, [&](const RobotRecords& robot) {
      std::size_t keyframes = 0;
      for_each<KeyframeRecord>(robot, [&](const KeyframeRecord&, std::size_t) { ++keyframes; });
      if (keyframes < 2) note(robot, "no two keyframes; it is left out");
      return keyframes < 2;
    });
  }

  void collect_names() {
    std::map<std::string, Anchor> anchors;
    std::set<std::string> access_points;
    std::optional<int> dimension;
    for (const RobotRecords& robot : robots_) {
      for_each<FactsRecord>(robot, [&](const FactsRecord& facts, std::size_t) {
        if (dimension.value_or(facts.dimension) != facts.dimension)
          throw std::runtime_error("log of robot " + robot.id +
                                   ": it is of a mission in the plane, others are in space, or the reverse");
        dimension = facts.dimension;
      });
      for_each<AnchorRecord>(robot, [&](const AnchorRecord& of, std::size_t) {
        const Anchor& known = anchors.emplace(of.anchor.id, of.anchor).first->second;
        if (known.position_m != of.anchor.position_m || known.sigma_m != of.anchor.sigma_m)
          note(robot, "anchor " + of.anchor.id + " has another position than in the logs before");
      });
      for_each<AccessPointRecord>(
          robot, [&](const AccessPointRecord& heard, std::size_t) { access_points.insert(heard.bssid); });
    }
    Mission& mission = result_.mission;
    mission.dimension = dimension.value_or(2);
    for (auto& [id, anchor] : anchors) {
      names_.anchors.emplace(id, mission.anchors.size());
      mission.anchors.push_back(std::move(anchor));
    }
    mission.access_points.assign(access_points.begin(), access_points.end());
    for (const RobotRecords& robot : robots_) {
      names_.robots.emplace(robot.id, mission.robots.size());
      mission.robots.emplace_back().id = robot.id;
    }
  }

  void add_robot(std::size_t r) {
    const RobotRecords& of = robots_[r];
    Robot& robot = result_.mission.robots[r];
    KeyframeChain& chain = chains_.emplace_back();
    bool has_facts = false;
    for_each<FactsRecord>(of, [&](const FactsRecord& facts, std::size_t) {
      has_facts = true;
      robot.odometry_noise = facts.noise;
      robot.heading = facts.heading;
      robot.sigma_heading_rad = facts.sigma_heading_rad;
      robot.initial_pose = facts.initial_pose;
      robot.lidar_range_m = facts.lidar_range_m;
      robot.lidar_view_rad = facts.lidar_view_rad;
      robot.fix_lever_m = facts.fix_lever_m;
    });
    for_each<KeyframeRecord>(of, [&](const KeyframeRecord& keyframe, std::size_t) { chain.add(keyframe); });
    if (!has_facts) note(of, "the facts are missing: noise and sensors are the defaults");
    for (const auto& [first, last] : of.gaps)
      note(of, "records " + std::to_string(first) + " to " + std::to_string(last) + " are missing");
    if (chain.unknown_steps() > 0)
      note(of, "the motion is unknown where keyframes are missing, " + std::to_string(chain.unknown_steps()) +
                   " times");
    if (chain.out_of_order() > 0)
      note(of, std::to_string(chain.out_of_order()) +
                   " keyframes are not later than the one before and "
                   "are left out");
    set_odometry(of, chain, robot);
  }

  /// The keyframes, and the robot where it measured something in between.
  static void set_odometry(const RobotRecords& of, const KeyframeChain& chain, Robot& robot) {
    std::vector<StampedPose<SE3>> rows = chain.poses();
    const auto add = [&](const PoseAt& at) {
      const auto pose = chain.pose(at);
      if (pose && at.stamp < chain.poses().back().stamp) rows.push_back({at.stamp, *pose});
    };
    for (const auto& record : of.records)
      std::visit(
          [&](const auto& of_kind) {
            if constexpr (requires { of_kind.at; }) add(of_kind.at);
          },
          *record);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    rows.erase(std::unique(rows.begin(), rows.end(),
                           [](const auto& a, const auto& b) { return a.stamp == b.stamp; }),
               rows.end());
    robot.odometry = Trajectory<SE3>(std::move(rows));
    for (const StampedPose<SE3>& keyframe : chain.poses()) robot.keyframes.push_back(keyframe.stamp);
    robot.odometry_noise.steps = chain.steps();
  }

  std::vector<RobotRecords> robots_;
  LoggedMission result_;
  TeamNames names_;
  std::vector<KeyframeChain> chains_;  ///< of each robot
};

}  // namespace

LoggedMission mission_of(const TeamLog& team) { return MissionBuilder(team).build(); }

void GrowingLogs::add(const std::string& robot, Record record) {
  robots_[robot].push_back(std::make_shared<const Record>(std::move(record)));
}

LoggedMission GrowingLogs::mission() const { return MissionBuilder(robots_).build(); }

namespace {

/// For each robot of the mission, the one of the log.
std::vector<std::optional<std::size_t>> robots_in(const Mission& logged, const Mission& mission) {
  std::vector<std::optional<std::size_t>> indices(mission.robots.size());
  for (std::size_t r = 0; r < indices.size(); ++r)
    for (std::size_t k = 0; k < logged.robots.size(); ++k)
      if (logged.robots[k].id == mission.robots[r].id) indices[r] = k;
  return indices;
}

}  // namespace

LoggedMission by_logs(Mission mission, const KeyframeParams& params) {
  const MissionLogs logs = logs_of(mission, params);
  TeamLog team;
  for (const RobotLog& log : logs.robots) team.add(log);
  LoggedMission logged;
  try {
    logged = mission_of(team);
  } catch (const std::runtime_error&) {  // robots that do not move, and nothing else
    return {std::move(mission), {}, {}};
  }
  logged.notes.insert(logged.notes.end(), logs.notes.begin(), logs.notes.end());
  std::vector<RobotIndex> index(logged.mission.robots.size());
  const auto in_log = robots_in(logged.mission, mission);
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    if (!in_log[r]) continue;
    Robot &of = logged.mission.robots[*in_log[r]], &robot = mission.robots[r];
    index[*in_log[r]] = RobotIndex(r);
    std::erase_if(robot.fixes, [&](const PositionFix& fix) { return of.odometry.covers(fix.stamp); });
    robot.odometry = std::move(of.odometry);
    robot.odometry_noise = std::move(of.odometry_noise);
    robot.keyframes = std::move(of.keyframes);
    robot.fixes.insert(robot.fixes.end(), of.fixes.begin(), of.fixes.end());
    std::stable_sort(robot.fixes.begin(), robot.fixes.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    robot.wifi = std::move(of.wifi);
  }
  const auto renumber = [&](RobotIndex& robot) {
    if (robot.valid()) robot = index[robot.index()];
  };
  mission.anchors = std::move(logged.mission.anchors);
  mission.access_points = std::move(logged.mission.access_points);
  mission.ranges = std::move(logged.mission.ranges);
  for (RangeMeasurement& range : mission.ranges) renumber(range.i.robot), renumber(range.j.robot);
  mission.aoa_measurements = std::move(logged.mission.aoa_measurements);
  for (AoaMeasurement& angles : mission.aoa_measurements)
    renumber(angles.receiver), renumber(angles.transmitter.robot);
  mission.matches = std::move(logged.mission.matches);
  for (PoseMatch& match : mission.matches) renumber(match.robot_i), renumber(match.robot_j);
  logged.mission = std::move(mission);
  return logged;
}

}  // namespace radioslam
