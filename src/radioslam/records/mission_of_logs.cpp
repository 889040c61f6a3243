#include "radioslam/records/mission_of_logs.hpp"

#include <algorithm>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr double kLeastSpeed_mps = 0.5, kFastest = 3;  // of unknown motion, the latter in the mean speed
constexpr double kLeastUnknown_m = 1;

/// One robot's records, decoded.
struct RobotRecords {
  std::string id;
  std::vector<Record> records;
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

class MissionBuilder {
 public:
  explicit MissionBuilder(const TeamLog& team) {
    for (const auto& [id, log] : team.robots()) {
      RobotRecords& robot = robots_.emplace_back(RobotRecords{id, {}, log.gaps()});
      for (const auto& [number, bytes] : log.records)
        if (auto record = decode_record(bytes)) robot.records.push_back(*std::move(record));
    }
  }

  LoggedMission build() {
    leave_out_robots_without_odometry();
    if (robots_.empty()) throw std::runtime_error("no robot of these logs has two keyframes");
    collect_names();
    for (std::size_t r = 0; r < robots_.size(); ++r) add_robot(r);
    for (std::size_t r = 0; r < robots_.size(); ++r) add_measurements(r);
    result_.mission.ranges = in_order(std::move(ranges_));
    result_.mission.aoa_measurements = in_order(std::move(angles_));
    result_.mission.matches = in_order(std::move(matches_));
    return std::move(result_);
  }

 private:
  template <class Kind, class Take>
  static void for_each(const RobotRecords& robot, const Take& take) {
    for (std::size_t n = 0; n < robot.records.size(); ++n)
      if (const auto* record = std::get_if<Kind>(&robot.records[n])) take(*record, n);
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
      for_each<FingerprintRecord>(robot, [&](const FingerprintRecord& fingerprint, std::size_t) {
        for (const HeardAccessPoint& heard : fingerprint.readings) access_points.insert(heard.bssid);
      });
    }
    Mission& mission = result_.mission;
    mission.dimension = dimension.value_or(2);
    for (auto& [id, anchor] : anchors) {
      anchors_.emplace(id, mission.anchors.size());
      mission.anchors.push_back(std::move(anchor));
    }
    mission.access_points.assign(access_points.begin(), access_points.end());
    for (const RobotRecords& robot : robots_) {
      indices_.emplace(robot.id, mission.robots.size());
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
    for (const Record& record : of.records)
      std::visit(
          [&](const auto& of_kind) {
            if constexpr (requires { of_kind.at; }) add(of_kind.at);
          },
          record);
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
    rows.erase(std::unique(rows.begin(), rows.end(),
                           [](const auto& a, const auto& b) { return a.stamp == b.stamp; }),
               rows.end());
    robot.odometry = Trajectory<SE3>(std::move(rows));
    robot.odometry_noise.steps = chain.steps();
  }

  /// Nothing if the robot or anchor is not known.
  std::optional<LinkEnd> end_of(const LinkPeer& peer) const {
    LinkEnd end;
    end.antenna = peer.antenna;
    end.lever_arm_m = peer.lever_arm_m;
    const auto& names = peer.is_anchor ? anchors_ : indices_;
    const auto found = names.find(peer.name);
    if (found == names.end()) return std::nullopt;
    if (peer.is_anchor)
      end.anchor = AnchorIndex(found->second);
    else
      end.robot = RobotIndex(found->second);
    return end;
  }

  void add_measurements(std::size_t r) {
    const RobotRecords& of = robots_[r];
    Robot& robot = result_.mission.robots[r];
    const RobotIndex self(r);
    std::set<std::string> unknown;
    std::size_t untied = 0;
    const auto has_pose = [&](const PoseAt& at) {
      const bool has = chains_[r].pose(at).has_value();
      if (!has) ++untied;
      return has;
    };
    for_each<RangeRecord>(of, [&](const RangeRecord& range, std::size_t n) {
      if (!has_pose(range.at)) return;
      auto other = end_of(range.other);
      if (!other) return void(unknown.insert(range.other.name));
      LinkEnd own{self, {}, range.antenna, range.lever_arm_m};
      if (range.is_other_first) std::swap(own, *other);
      ranges_.push_back({range.at.stamp, r, n, {range.at.stamp, own, *other, range.range_m, range.sigma_m}});
    });
    for_each<AnglesRecord>(of, [&](const AnglesRecord& angles, std::size_t n) {
      if (!has_pose(angles.at)) return;
      const auto transmitter = end_of(angles.transmitter);
      if (!transmitter) return void(unknown.insert(angles.transmitter.name));
      angles_.push_back({angles.at.stamp, r, n, {angles.at.stamp, self, *transmitter, angles.paths}});
    });
    for_each<FixRecord>(of, [&](const FixRecord& fix, std::size_t) {
      if (has_pose(fix.at)) robot.fixes.push_back({fix.at.stamp, fix.position_m, fix.sigma_m});
    });
    for_each<FingerprintRecord>(of, [&](const FingerprintRecord& fingerprint, std::size_t) {
      if (has_pose(fingerprint.at)) robot.wifi.push_back(scan_of(fingerprint));
    });
    for_each<ClosureRecord>(of, [&](const ClosureRecord& closure, std::size_t n) {
      if (!has_pose(closure.at)) return;
      const auto other = indices_.find(closure.other);
      if (other == indices_.end()) return void(unknown.insert(closure.other));
      matches_.push_back({closure.at.stamp,
                          r,
                          n,
                          {self, RobotIndex(other->second), closure.at.stamp, closure.stamp_other,
                           closure.T_i_j, closure.covariance}});
    });
    for (const std::string& name : unknown)
      note(of, "measurements to " + name + " are left out: its log is not among these");
    if (untied > 0)
      note(of, std::to_string(untied) + " measurements are left out: the keyframes before them are missing");
  }

  WifiScan scan_of(const FingerprintRecord& fingerprint) const {
    const std::vector<std::string>& known = result_.mission.access_points;
    WifiScan scan{fingerprint.at.stamp, {}};
    for (const HeardAccessPoint& heard : fingerprint.readings) {
      const auto found = std::lower_bound(known.begin(), known.end(), heard.bssid);
      scan.readings.push_back({AccessPointIndex(static_cast<std::size_t>(found - known.begin())),
                               heard.frequency_mhz, heard.rssi_dbm});
    }
    std::stable_sort(scan.readings.begin(), scan.readings.end(),
                     [](const auto& a, const auto& b) { return a.access_point < b.access_point; });
    return scan;
  }

  std::vector<RobotRecords> robots_;
  LoggedMission result_;
  std::map<std::string, std::size_t> anchors_, indices_;
  std::vector<KeyframeChain> chains_;  ///< of each robot
  std::vector<Placed<RangeMeasurement>> ranges_;
  std::vector<Placed<AoaMeasurement>> angles_;
  std::vector<Placed<PoseMatch>> matches_;
};

}  // namespace

LoggedMission mission_of(const TeamLog& team) { return MissionBuilder(team).build(); }

}  // namespace radioslam
