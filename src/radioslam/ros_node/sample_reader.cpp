#include "radioslam/ros_node/sample_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "radioslam/base/input_error.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/io/mission/recorded_odometry.hpp"
#include "radioslam/io/ros/radioslam_messages.hpp"
#include "radioslam/io/ros/ros_ranges.hpp"

namespace radioslam {
namespace {

constexpr double kMostForce_mps2 = 1e4, kMostRate_radps = 1e3;
constexpr double kMostRange_m = 1e6, kMostFixDistance_m = 1e6, kMostDecibels = 1e4;
constexpr double kUnknownFix_m = 10;  // sigma
constexpr std::size_t kMostPaths = 64, kMostReadingsOfMessage = 4096, kMostPlaces = 1000;
constexpr double kKeptOdometry_s = 5, kLevel_rad = 0.1;

bool is_within(double number, double most) { return std::abs(number) < most; }

/// Direction of an angle of arrival, or nothing where it is out of bounds.
std::optional<AoaPath> in_body(AoaPath path, const SE3& T_body_sensor) {
  const double elevation_rad = path.elevation_rad.value_or(0);
  if (!is_within(path.azimuth_rad, 100) || !is_within(elevation_rad, 2) ||
      !(path.sigma_rad > 0 && path.sigma_rad < 100) || !is_within(path.power_db, kMostDecibels))
    return std::nullopt;
  const Eigen::Vector3d direction(std::cos(elevation_rad) * std::cos(path.azimuth_rad),
                                  std::cos(elevation_rad) * std::sin(path.azimuth_rad),
                                  std::sin(elevation_rad));
  const Eigen::Vector3d turned = T_body_sensor.rotation() * direction;
  path.azimuth_rad = std::atan2(turned.y(), turned.x());
  if (path.elevation_rad) path.elevation_rad = std::asin(std::clamp(turned.z(), -1.0, 1.0));
  return path;
}

bool is_level(const SE3& T_body_sensor) {
  return (T_body_sensor.rotation() * Eigen::Vector3d::UnitZ()).z() > std::cos(kLevel_rad);
}

}  // namespace

SampleReader::SampleReader(HeardNames& names, const SensorFrames& frames,
                           const std::optional<GeodeticPlace>& origin, bool is_simulated, NotesOnce& notes)
    : names_(names),
      frames_(frames),
      origin_(origin),
      notes_(notes),
      gate_(is_simulated),
      scans_([this](Stamp stamp, RosScan scan) { take_scan(stamp, scan); }) {}

void SampleReader::leave_out(const RobotTopic& topic, const std::string& what, const std::string& detail) {
  notes_.say("topic " + topic.name + ": " + what + " are left out", detail);
}

void SampleReader::read(const RobotTopic& topic, const RosArrival& arrival) {
  try {
    if (arrival.cdr.size() > kMostMessageBytes)
      return leave_out(topic, "messages of more than " + std::to_string(kMostMessageBytes >> 20U) + " MiB");
    if (gate_.passes(topic.name, RosMessageReader(arrival.message()).header().stamp, arrival.clock, notes_))
      read_timed(topic, arrival);
  } catch (const InputError& error) {
    leave_out(topic, "messages that cannot be read", std::string(" (the first: ") + error.what() + ")");
  }
}

void SampleReader::read_timed(const RobotTopic& topic, const RosArrival& arrival) {
  const RosMessage message = arrival.message();
  switch (topic.kind) {
    case RobotTopicKind::kOdometry:
      return read_odometry(topic, message);
    case RobotTopicKind::kScans:
      scan_topic_ = topic;
      is_planar_ = message.channel.type == kLaserScanType;
      scans_.take(message);
      if (scans_.unreadable() > 0) leave_out(topic, "scans that cannot be read");
      return;
    case RobotTopicKind::kImu:
      return read_imu(topic, message);
    case RobotTopicKind::kFix:
      return read_fix(topic, message);
    case RobotTopicKind::kRanges:
      return read_ranges(topic, message);
    case RobotTopicKind::kRangeTo:
      return read_range_to(topic, message);
    case RobotTopicKind::kAngles:
      return read_angles(topic, message);
    case RobotTopicKind::kWifi:
      return read_wifi(topic, message);
    case RobotTopicKind::kCsi:
      read_csi_packet(message);
      return notes_.say("topic " + topic.name +
                        ": packets are read but not used; an agent takes angles of arrival, which "
                        "`radioslam aoa` computes from the captures of both ends");
  }
}

void SampleReader::read_odometry(const RobotTopic& topic, const RosMessage& message) {
  const RosPose pose = read_ros_pose(message);
  if (!pose.pose) return leave_out(topic, "poses that are not finite, or have no orientation,");
  const Stamp stamp = pose.header.stamp;
  if (!gate_.is_new(topic.name, stamp, notes_)) return;
  if (!T_start_odometry_)
    T_start_odometry_ = from_start({{stamp, *pose.pose}}).front().pose * pose.pose->inverse();
  samples_.emplace_back(StampedPose<SE3>{stamp, *T_start_odometry_ * *pose.pose});
  const auto later = std::find_if(odometry_.begin(), odometry_.end(),
                                  [stamp](const auto& row) { return row.stamp > stamp; });
  odometry_.insert(later, {stamp, *pose.pose});
  while (seconds_between(odometry_.front().stamp, odometry_.back().stamp) > kKeptOdometry_s)
    odometry_.pop_front();
}

std::optional<SE3> SampleReader::odometry_at(Stamp stamp) const {
  const auto after = std::find_if(odometry_.begin(), odometry_.end(),
                                  [stamp](const auto& row) { return row.stamp >= stamp; });
  if (after == odometry_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->pose;
  if (after == odometry_.begin()) return std::nullopt;
  return Trajectory<SE3>({*(after - 1), *after}).at(stamp);
}

/// As RosCollector.
void SampleReader::take_scan(Stamp stamp, RosScan& scan) {
  if (scan.scan.points.size() > kMostPoints)
    return leave_out(scan_topic_, "scans of more than " + std::to_string(kMostPoints) + " points");
  if (!gate_.is_new(scan_topic_.name, stamp, notes_)) return;
  const SE3 T_body_laser = place_of(scan_topic_.name);
  const Eigen::Matrix3f R_body_laser = T_body_laser.rotation().toRotationMatrix().cast<float>();
  const Eigen::Vector3f t_body_laser = T_body_laser.translation().cast<float>();
  for (Eigen::Vector3f& point : scan.scan.points) {
    point = Eigen::Vector3f(R_body_laser * point + t_body_laser);
    if (is_planar_) point.z() = 0;
  }
  samples_.emplace_back(ScanSample{stamp, std::move(scan.scan)});
}

void SampleReader::read_imu(const RobotTopic& topic, const RosMessage& message) {
  const RosImu reading = read_ros_imu(message);
  if (!reading.is_complete) return leave_out(topic, "samples marked as without rates or forces");
  if (!(reading.specific_force_mps2.norm() < kMostForce_mps2) ||
      !(reading.angular_rate_radps.norm() < kMostRate_radps))
    return leave_out(topic, "samples that are not finite, or not possible,");
  if (!gate_.is_new(topic.name, reading.header.stamp, notes_)) return;
  const Eigen::Quaterniond R_body_imu = place_of(topic.name).rotation();
  samples_.emplace_back(ImuSample{reading.header.stamp, R_body_imu * reading.specific_force_mps2,
                                  R_body_imu * reading.angular_rate_radps});
}

void SampleReader::read_fix(const RobotTopic& topic, const RosMessage& message) {
  const RosFix fix = read_ros_fix(message);
  if (!fix.place) return leave_out(topic, "messages without a fix");
  if (!origin_)
    return notes_.say("topic " + topic.name +
                      ": position fixes are not used; --origin LAT,LON[,HEIGHT] states the origin of the "
                      "frame in which the whole team takes them");
  GeodeticPlace place = *fix.place;
  if (!std::isfinite(place.height_m)) place.height_m = origin_->height_m;
  const PositionFix local{fix.header.stamp, east_north_up_m(*origin_, place),
                          fix.sigma_m.value_or(kUnknownFix_m)};
  if (!(local.position_m.norm() < kMostFixDistance_m) || !(local.sigma_m > 0 && local.sigma_m < kMostRange_m))
    return leave_out(topic, "fixes more than 1000 km from the origin");
  samples_.emplace_back(local);
}

void SampleReader::add_range(const RobotTopic& topic, RangeMeasurement range, const std::string& other,
                             const std::string& other_antenna) {
  const auto end = names_.other_end(other, other_antenna, notes_);
  if (!end) return leave_out(topic, "ranges to the robot itself, or to what cannot be a name,");
  if (!(range.range_m >= 0 && range.range_m < kMostRange_m) ||
      !(range.sigma_m > 0 && range.sigma_m < kMostRange_m))
    return leave_out(topic, "ranges that are negative or not finite, or whose sigma is,");
  range.j = *end;
  samples_.emplace_back(std::move(range));
}

void SampleReader::read_ranges(const RobotTopic& topic, const RosMessage& message) {
  const RosRangeMeasurement range = read_range_measurement(message);
  const std::string& frame = range.header.frame;
  RangeMeasurement sample;
  sample.stamp = range.header.stamp;
  sample.i = names_.own_end(range.antenna, frame.empty() ? std::nullopt
                                                         : std::optional<Eigen::Vector3d>(
                                                               place_of(topic.name, frame).translation()));
  sample.range_m = range.range_m;
  sample.sigma_m = range.sigma_m == 0 ? kUnknownRangeSigma_m : range.sigma_m;
  add_range(topic, std::move(sample), range.other, range.other_antenna);
}

void SampleReader::read_range_to(const RobotTopic& topic, const RosMessage& message) {
  const RosRangeReading range = read_ros_range(message);
  if (!range.is_valid) return leave_out(topic, "ranges outside of the limits that they state");
  RangeMeasurement sample;
  sample.stamp = range.header.stamp;
  sample.i = names_.own_end({}, place_of(topic.name, range.header.frame).translation());
  sample.range_m = range.range_m;
  sample.sigma_m = range.sigma_m.value_or(kUnknownRangeSigma_m);
  add_range(topic, std::move(sample), topic.partner, {});
}

void SampleReader::read_angles(const RobotTopic& topic, const RosMessage& message) {
  const RosAngleMeasurement angles = read_angle_measurement(message);
  const SE3& T_body_sensor = place_of(topic.name, angles.header.frame);
  const auto end = names_.other_end(angles.transmitter, angles.transmitter_antenna, notes_);
  if (!end) return leave_out(topic, "angles to the robot itself, or to what cannot be a name,");
  AoaMeasurement sample{angles.header.stamp, names_.self(), *end, {}};
  if (angles.paths.size() > kMostPaths) return leave_out(topic, "angles of more than 64 paths");
  for (const AoaPath& path : angles.paths) {
    if (!path.elevation_rad && !is_level(T_body_sensor))
      return leave_out(topic, "angles without an elevation in a frame that is not level");
    if (const auto turned = in_body(path, T_body_sensor)) sample.paths.push_back(*turned);
  }
  if (sample.paths.size() < angles.paths.size() || sample.paths.empty())
    return leave_out(topic, "angles that are not finite, without paths or without sigmas");
  samples_.emplace_back(std::move(sample));
}

/// Of several readings of one access point at one frequency, the strongest.
void SampleReader::read_wifi(const RobotTopic& topic, const RosMessage& message) {
  const RosWifiScan scan = read_wifi_scan(message);
  if (scan.readings.size() > kMostReadingsOfMessage) return leave_out(topic, "scans of too many readings");
  std::map<std::pair<AccessPointIndex, float>, float> strongest;
  for (const RosWifiReading& reading : scan.readings) {
    const bool is_possible = reading.rssi_dbm < 0 && reading.rssi_dbm > -1000 && reading.frequency_mhz >= 0 &&
                             reading.frequency_mhz < 1e6F;
    const auto access_point = is_possible ? names_.access_point(reading.bssid) : std::nullopt;
    if (!access_point) {
      leave_out(topic, "readings without an address, or a level in dBm,");
      continue;
    }
    const auto [found, is_new] =
        strongest.emplace(std::pair(*access_point, reading.frequency_mhz), reading.rssi_dbm);
    if (!is_new) found->second = std::max(found->second, reading.rssi_dbm);
  }
  if (strongest.empty() || !gate_.is_new(topic.name, scan.header.stamp, notes_)) return;
  WifiScan sample{scan.header.stamp, {}};
  for (const auto& [of, rssi_dbm] : strongest) sample.readings.push_back({of.first, of.second, rssi_dbm});
  samples_.emplace_back(std::move(sample));
}

SE3 SampleReader::place_of(const std::string& topic) const {
  const auto found = places_.find(topic);
  return found == places_.end() ? SE3() : found->second;
}

const SE3& SampleReader::place_of(const std::string& topic, const std::string& frame) {
  if (frame_places_.size() > kMostPlaces) frame_places_.clear();
  auto found = frame_places_.find({topic, frame});
  if (found == frame_places_.end())
    found = frame_places_.emplace(std::pair(topic, frame), frames_.pose_of(topic, frame, notes_)).first;
  return found->second;
}

}  // namespace radioslam
