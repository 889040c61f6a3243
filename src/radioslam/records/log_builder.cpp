#include "radioslam/records/log_builder.hpp"

#include <algorithm>
#include <functional>

#include "radioslam/mission/odometry_edge.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxAmendedSteps = 16;  // of a record
constexpr double kSame_m = 1e-4, kSame_rad = 1e-5;

bool are_equal(const SE3& a, const SE3& b) {
  const SE3::Tangent off = (a.inverse() * b).log();
  return off.head<3>().norm() < kSame_m && off.tail<3>().norm() < kSame_rad;
}

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

/// Of the motion between two keyframes, without the floor of an edge, which whoever reads the log adds.
SE3::Jacobian covariance_between(const Trajectory<SE3>& odometry, const OdometryNoise& noise,
                                 const StampedPose<SE3>& from, const StampedPose<SE3>& to) {
  OdometryEdge<SE3> edge;
  StampedPose<SE3> reached = from;
  auto next = std::upper_bound(odometry.begin(), odometry.end(), from.stamp,
                               [](Stamp at, const auto& sample) { return at < sample.stamp; });
  for (; next != odometry.end() && next->stamp < to.stamp; ++next) {
    append_sample(edge, reached, *next, noise);
    reached = *next;
  }
  append_sample(edge, reached, to, noise);
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

}  // namespace

LogBuilder::LogBuilder(const Mission& names, const Robot& robot, const KeyframeParams& params)
    : names_(names), robot_(robot), choice_(robot, params) {
  say(facts_of(names, robot));
  for (const Anchor& anchor : names.anchors) say(AnchorRecord{anchor});
}

void LogBuilder::add(const StampedPose<SE3>& odometry) {
  if (robot_.keyframes.empty()) {
    auto occasion = occasions_.begin();
    for (; occasion != occasions_.end() && occasion->first < odometry.stamp; ++occasion)
      if (last_sample_ && *last_sample_ <= occasion->first) choice_.add(occasion->second);
    occasions_.erase(occasions_.begin(), occasion);
    choice_.add(odometry);
  }
  last_sample_ = odometry.stamp;
  settle();
}

void LogBuilder::add(const Occasion& occasion) {
  if (!is_final(occasion.stamp)) occasions_.emplace(occasion.stamp, occasion);
}

void LogBuilder::add(const RangeMeasurement& range, RobotIndex self) {
  const bool is_first = range.i.robot.valid();
  const LinkEnd &own = is_first ? range.i : range.j, &other = is_first ? range.j : range.i;
  Occasion occasion{range.stamp};
  occasion.sigma_m = range.sigma_m;
  add(occasion);
  if (own.robot == self)
    wait(range.stamp, range.stamp,
         RangeRecord{{}, own.antenna, own.lever_arm_m, peer(other), !is_first, range.range_m, range.sigma_m});
}

void LogBuilder::add(const AoaMeasurement& angles) {
  for (const AoaPath& path : angles.paths) add(occasion_of(angles.stamp, path));
  wait(angles.stamp, angles.stamp, AnglesRecord{{}, peer(angles.transmitter), angles.paths});
}

void LogBuilder::add(const PositionFix& fix) {
  Occasion occasion{fix.stamp};
  occasion.sigma_m = fix.sigma_m;
  add(occasion);
  wait(fix.stamp, fix.stamp, FixRecord{{}, fix.position_m, fix.sigma_m});
}

void LogBuilder::add(const WifiScan& scan) { wait(scan.stamp, scan.stamp, scan); }

void LogBuilder::add(const PoseMatch& match, RobotIndex self) {
  if (match.robot_j == self) add(occasion_of(match.stamp_j, match.covariance));
  if (match.robot_i != self) return;
  add(occasion_of(match.stamp_i, match.covariance));
  add(match.stamp_i, std::max(match.stamp_i, match.stamp_j),
      ClosureRecord{
          {}, names_.robots[match.robot_j.index()].id, match.stamp_j, match.T_i_j, match.covariance, {}, {}});
}

void LogBuilder::add(Stamp stamp, Stamp known, ClosureRecord record) {
  wait(stamp, known, std::move(record));
}

void LogBuilder::add(Stamp stamp, DescriptorRecord record) { wait(stamp, stamp, std::move(record)); }

void LogBuilder::finish() {
  if (robot_.keyframes.empty()) choice_.finish();
  is_finished_ = true;
  settle();
}

void LogBuilder::amend(const Trajectory<SE3>& odometry, const OdometryNoise& noise) {
  AmendmentRecord record;
  const auto say_steps = [&] {
    if (!record.steps.empty()) say(std::exchange(record, {}));
  };
  for (std::size_t k = 1; k < said_.size(); ++k) {
    const auto a = odometry.at(said_[k - 1].stamp), b = odometry.at(said_[k].stamp);
    if (!a || !b || are_equal(a->inverse() * *b, said_[k - 1].pose.inverse() * said_[k].pose)) {
      say_steps();
      continue;
    }
    if (record.steps.empty()) record.first = static_cast<std::uint32_t>(k);
    record.steps.push_back({a->inverse() * *b, covariance_between(odometry, noise, {said_[k - 1].stamp, *a},
                                                                  {said_[k].stamp, *b})});
    if (record.steps.size() == kMaxAmendedSteps) say_steps();
  }
  say_steps();
}

std::vector<std::string> LogBuilder::take() { return std::exchange(records_, {}); }

void LogBuilder::wait(Stamp stamp, Stamp known, Measured measured) {
  waiting_.emplace(std::pair(stamp, counter_++), Waiting{known, std::move(measured)});
}

/// Says what is final, in the order in which it is known.
void LogBuilder::settle() {
  while (!waiting_.empty() && is_final(waiting_.begin()->first.first)) {
    auto first = waiting_.extract(waiting_.begin());
    place(first.key().first, first.key().second, std::move(first.mapped()));
  }
  while (!placed_.empty() && is_final(placed_.begin()->first.first)) {
    const auto first = placed_.extract(placed_.begin());
    const Stamp known = first.key().first;
    say_keyframes([known](Stamp stamp) { return stamp <= known; });
    say(first.mapped());
  }
  say_keyframes([this](Stamp stamp) { return is_final(stamp); });
}

void LogBuilder::place(Stamp stamp, std::size_t order, Waiting waiting) {
  if (const auto* scan = std::get_if<WifiScan>(&waiting.measured))
    return place_fingerprint(*scan, waiting.known, order);
  Record& record = std::get<Record>(waiting.measured);
  if (set_pose(stamp, record))
    placed_.emplace(std::pair(waiting.known, order), std::move(record));
  else
    ++left_out_;
}

/// With the numbers of its access points, which are said before they are heard for the first time.
void LogBuilder::place_fingerprint(const WifiScan& scan, Stamp known, std::size_t order) {
  const auto pose = at(scan.stamp);
  if (!pose) return void(++left_out_);
  FingerprintRecord fingerprint{*pose, {}};
  for (const WifiReading& reading : strongest(scan.readings)) {
    const auto [found, is_new] = numbers_.emplace(std::pair(reading.access_point, reading.frequency_mhz),
                                                  static_cast<std::uint32_t>(numbers_.size()));
    if (is_new)
      placed_.emplace(std::pair(known, order),
                      AccessPointRecord{found->second, names_.access_points[reading.access_point.index()],
                                        reading.frequency_mhz});
    fingerprint.readings.push_back({found->second, reading.rssi_dbm});
  }
  std::stable_sort(fingerprint.readings.begin(), fingerprint.readings.end(),
                   [](const auto& a, const auto& b) { return a.number < b.number; });
  placed_.emplace(std::pair(known, order), std::move(fingerprint));
}

bool LogBuilder::set_pose(Stamp stamp, Record& record) const {
  const auto pose = at(stamp);
  std::visit(
      [&](auto& of) {
        if constexpr (requires { of.at; }) of.at = pose.value_or(PoseAt{});
        if constexpr (requires { of.bins; }) of.keyframe = pose.value_or(PoseAt{}).keyframe;
      },
      record);
  return pose.has_value();
}

std::optional<PoseAt> LogBuilder::at(Stamp stamp) const {
  if (!robot_.odometry.covers(stamp)) {
    const auto after = std::upper_bound(said_.begin(), said_.end(), stamp,
                                        [](Stamp at, const auto& keyframe) { return at < keyframe.stamp; });
    if (after == said_.begin() || after == said_.end()) return std::nullopt;
    const Trajectory<SE3> way({*(after - 1), *after});
    return PoseAt{static_cast<std::uint32_t>(after - said_.begin() - 1), stamp,
                  way.front().pose.inverse() * *way.at(stamp)};
  }
  const std::size_t k = keyframe_before(keyframes(), stamp);
  const SE3 keyframe = k < said_.size() ? said_[k].pose : *robot_.odometry.at(keyframes()[k]);
  return PoseAt{static_cast<std::uint32_t>(k), stamp, keyframe.inverse() * *robot_.odometry.at(stamp)};
}

const std::vector<Stamp>& LogBuilder::keyframes() const {
  return robot_.keyframes.empty() ? choice_.keyframes() : robot_.keyframes;
}

LinkPeer LogBuilder::peer(const LinkEnd& end) const {
  if (end.robot.valid()) return {false, names_.robots[end.robot.index()].id, end.antenna, end.lever_arm_m};
  return {true, names_.anchors[end.anchor.index()].id, end.antenna, end.lever_arm_m};
}

void LogBuilder::say_keyframes(const std::function<bool(Stamp)>& until) {
  for (std::size_t k = said_.size(); k < keyframes().size() && until(keyframes()[k]); ++k) {
    const StampedPose<SE3> here{keyframes()[k], *robot_.odometry.at(keyframes()[k])};
    KeyframeRecord record;
    record.number = static_cast<std::uint32_t>(k);
    record.stamp = here.stamp;
    record.T_before_this = k > 0 ? said_.back().pose.inverse() * here.pose : here.pose;
    if (k > 0 && !robot_.odometry_noise.steps.empty())
      record.covariance = covariance_between(robot_.odometry, robot_.odometry_noise, said_.back(), here);
    said_.push_back(here);
    say(record);
  }
}

void LogBuilder::say(const Record& record) {
  if (!is_valid(record)) return void(++left_out_);
  std::string bytes = encode(record);
  if (bytes.size() > kMaxRecordBytes) return void(++left_out_);
  records_.push_back(std::move(bytes));
}

}  // namespace radioslam
