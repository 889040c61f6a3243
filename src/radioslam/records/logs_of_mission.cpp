#include "radioslam/records/logs_of_mission.hpp"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

/// The measurements of a robot, by the time at which they become records.
struct Timed {
  Stamp stamp;
  Record record;
};

FactsRecord facts_of(const Mission& mission, const Robot& robot) {
  FactsRecord facts;
  facts.dimension = mission.dimension;
  facts.noise = robot.odometry_noise;
  facts.noise.steps.clear();
  facts.heading = robot.heading;
  facts.sigma_heading_rad = robot.sigma_heading_rad;
  facts.initial_pose = robot.initial_pose;
  facts.lidar_range_m = robot.lidar_range_m;
  facts.lidar_view_rad = robot.lidar_view_rad;
  facts.fix_lever_m = robot.fix_lever_m;
  return facts;
}

/// Of the motion from one row to another, without the floor of an edge, which whoever reads the log adds.
SE3::Jacobian covariance_of(const Trajectory<SE3>& odometry, std::size_t first_row, std::size_t last_row,
                            const OdometryNoise& noise) {
  OdometryEdge<SE3> edge;
  for (std::size_t row = first_row; row < last_row; ++row)
    append_sample(edge, odometry[row], odometry[row + 1], noise);
  return edge.covariance;
}

/// As many readings as a record holds, in their order.
std::vector<WifiReading> strongest(std::vector<WifiReading> readings) {
  if (readings.size() <= kMaxReadings) return readings;
  std::vector<float> levels;
  for (const WifiReading& reading : readings) levels.push_back(reading.rssi_dbm);
  const auto last = levels.begin() + (kMaxReadings - 1);
  std::nth_element(levels.begin(), last, levels.end(), std::greater<>());
  const float least = *last;
  std::erase_if(readings, [least](const WifiReading& reading) { return reading.rssi_dbm < least; });
  readings.resize(std::min(readings.size(), kMaxReadings));
  return readings;
}

class RobotRecords {
 public:
  RobotRecords(const Mission& mission, std::size_t r, const KeyframeParams& params,
               const ScannedRecords& scanned)
      : mission_(mission),
        scanned_(scanned),
        robot_(mission.robots[r]),
        index_(r),
        nodes_(nodes_at(robot_.odometry, keyframes_of(mission, RobotIndex(r), params))) {}

  RobotLog log(std::size_t& left_out) {
    add_measurements();
    add_scanned();
    std::stable_sort(measured_.begin(), measured_.end(),
                     [](const Timed& a, const Timed& b) { return a.stamp < b.stamp; });
    RobotLog log{robot_.id, {}};
    const auto say = [&](const Record& record) {
      if (!is_valid(record)) return void(++left_out);
      std::string bytes = encode(record);
      if (bytes.size() > kMaxRecordBytes) return void(++left_out);
      log.records.push_back(std::move(bytes));
    };
    say(facts_of(mission_, robot_));
    for (const Anchor& anchor : mission_.anchors) say(AnchorRecord{anchor});
    std::size_t next = 0;
    for (const Timed& measured : measured_) {
      for (; next < nodes_.rows.size() && nodes_.stamps[next] <= measured.stamp; ++next) say(keyframe(next));
      say(measured.record);
    }
    for (; next < nodes_.rows.size(); ++next) say(keyframe(next));
    left_out += outside_;
    return log;
  }

 private:
  KeyframeRecord keyframe(std::size_t k) const {
    const std::size_t row = nodes_.rows[k], before = k > 0 ? nodes_.rows[k - 1] : row;
    const Trajectory<SE3>& odometry = nodes_.odometry;
    KeyframeRecord record;
    record.number = static_cast<std::uint32_t>(k);
    record.stamp = nodes_.stamps[k];
    record.T_before_this = k > 0 ? odometry[before].pose.inverse() * odometry[row].pose : odometry[row].pose;
    if (k > 0 && !robot_.odometry_noise.steps.empty())
      record.covariance = covariance_of(odometry, before, row, robot_.odometry_noise);
    return record;
  }

  std::optional<PoseAt> at(Stamp stamp) {
    if (!robot_.odometry.covers(stamp)) {
      ++outside_;
      return std::nullopt;
    }
    const std::size_t k = keyframe_before(nodes_.stamps, stamp);
    return PoseAt{static_cast<std::uint32_t>(k), stamp,
                  nodes_.odometry[nodes_.rows[k]].pose.inverse() * *robot_.odometry.at(stamp)};
  }

  template <class OfKind>
  void add(Stamp stamp, OfKind record) {
    add(stamp, stamp, std::move(record));
  }
  /// A measurement that is known later than it was made.
  template <class OfKind>
  void add(Stamp stamp, Stamp known, OfKind record) {
    if (const auto pose = at(stamp)) {
      record.at = *pose;
      measured_.push_back({known, std::move(record)});
    }
  }

  LinkPeer peer(const LinkEnd& end) const {
    if (end.robot.valid())
      return {false, mission_.robots[end.robot.index()].id, end.antenna, end.lever_arm_m};
    return {true, mission_.anchors[end.anchor.index()].id, end.antenna, end.lever_arm_m};
  }

  /// The access point's number, which is said before it is heard for the first time.
  std::uint32_t number_of(Stamp stamp, const WifiReading& reading) {
    const auto [found, is_new] = numbers_.emplace(std::pair(reading.access_point, reading.frequency_mhz),
                                                  static_cast<std::uint32_t>(numbers_.size()));
    if (is_new)
      measured_.push_back(
          {stamp, AccessPointRecord{found->second, mission_.access_points[reading.access_point.index()],
                                    reading.frequency_mhz}});
    return found->second;
  }

  ClosureRecord closure_record(const auto& of) const {
    return {{}, mission_.robots[of.robot_j.index()].id, of.stamp_j, of.T_i_j, of.covariance, {}, {}};
  }

  void add_measurements() {
    for (const RangeMeasurement& range : mission_.ranges) {
      const bool is_first = range.i.robot.valid();
      const LinkEnd &own = is_first ? range.i : range.j, &other = is_first ? range.j : range.i;
      if (own.robot == RobotIndex(index_))
        add(range.stamp,
            RangeRecord{
                {}, own.antenna, own.lever_arm_m, peer(other), !is_first, range.range_m, range.sigma_m});
    }
    for (const AoaMeasurement& angles : mission_.aoa_measurements)
      if (angles.receiver == RobotIndex(index_))
        add(angles.stamp, AnglesRecord{{}, peer(angles.transmitter), angles.paths});
    for (const PositionFix& fix : robot_.fixes) add(fix.stamp, FixRecord{{}, fix.position_m, fix.sigma_m});
    for (const WifiScan& scan : robot_.wifi) {
      if (!robot_.odometry.covers(scan.stamp)) {
        ++outside_;
        continue;
      }
      FingerprintRecord fingerprint;
      for (const WifiReading& reading : strongest(scan.readings))
        fingerprint.readings.push_back({number_of(scan.stamp, reading), reading.rssi_dbm});
      std::stable_sort(fingerprint.readings.begin(), fingerprint.readings.end(),
                       [](const auto& a, const auto& b) { return a.number < b.number; });
      add(scan.stamp, std::move(fingerprint));
    }
    for (const PoseMatch& match : mission_.matches)
      if (match.robot_i == RobotIndex(index_))
        add(match.stamp_i, std::max(match.stamp_i, match.stamp_j), closure_record(match));
  }

  void add_scanned() {
    for (const ScannedClosure& closure : scanned_.closures)
      if (closure.robot_i == RobotIndex(index_)) {
        ClosureRecord record = closure_record(closure);
        record.inlier_ratio = closure.inlier_ratio;
        record.doubt = closure.doubt;
        add(closure.stamp_i, std::max(closure.stamp_i, closure.stamp_j), std::move(record));
      }
    for (const ScannedPlace& place : scanned_.places) {
      if (place.robot != RobotIndex(index_)) continue;
      DescriptorRecord record = place.grid;
      record.keyframe = static_cast<std::uint32_t>(keyframe_before(nodes_.stamps, place.stamp));
      measured_.push_back({place.stamp, std::move(record)});
    }
  }

  const Mission& mission_;
  const ScannedRecords& scanned_;
  const Robot& robot_;
  std::size_t index_;
  RobotNodes nodes_;
  std::vector<Timed> measured_;
  std::map<std::pair<AccessPointIndex, float>, std::uint32_t> numbers_;  ///< of access points
  std::size_t outside_ = 0;
};

}  // namespace

MissionLogs logs_of(const Mission& mission, const KeyframeParams& params, const ScannedRecords& scanned) {
  MissionLogs logs;
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    std::size_t left_out = 0;
    logs.robots.push_back(RobotRecords(mission, r, params, scanned).log(left_out));
    if (left_out > 0)
      logs.notes.push_back("log of robot " + mission.robots[r].id + ": " + std::to_string(left_out) +
                           " measurements are left out: outside its odometry, or beyond what a record holds");
  }
  return logs;
}

}  // namespace radioslam
