#include "radioslam/radio/captures/csi_tracks.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/units.hpp"

namespace radioslam {
namespace {

std::string plural(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

double distance_m(const SE3& a, const SE3& b) { return (a.translation() - b.translation()).norm(); }

constexpr std::int64_t kHostDelay_ns =
    kNanosecondsPerSecond;                 // largest delay with which a host stamps a reply
constexpr double kClockSigmas = 3;         // significance of an offset, in sigmas
constexpr double kMaxClockSigma_s = 0.05;  // larger sigmas come from slow changes of speed, which bias
constexpr double kMinClock_s = 0.02;       // smaller offsets do not matter at walking speed
constexpr std::size_t kMaxClocks = 4;      // estimates per robot

}  // namespace

std::string explain(TwoWayFailure reason) {
  switch (reason) {
    case TwoWayFailure::kOtherSubcarriers:
      return "the two ends measured different subcarriers";
    case TwoWayFailure::kIncoherent:
      return "phases of packets and replies do not agree: replies to another robot, or too far apart in time";
    case TwoWayFailure::kTooFewExchanges:
      break;
  }
  return "fewer than three packets have a captured reply";
}

std::string explain(AoaFailure reason) {
  switch (reason) {
    case AoaFailure::kNoMotion:
      return "the antenna hardly moved";
    case AoaFailure::kNoOdometry:
      return "no odometry at the packets' stamps";
    case AoaFailure::kTooWide:
      return "the aperture is larger than csi.max_aperture_m";
    case AoaFailure::kZeroChannel:
      return "all channels are zero";
    case AoaFailure::kTooFewPackets:
      break;
  }
  return "too few packets";
}

void note_missing_csi(const Mission& mission, const Robot& robot, const CsiCapture& capture,
                      std::vector<std::string>& notes) {
  if (carrier_hz_of(*robot.csi, capture) == 0)
    notes.push_back("robot " + robot.id +
                    "'s CSI captures were ignored: neither they nor mission.yaml give the WiFi channel");
  if (!robot.csi->address)
    notes.push_back("packets sent by robot " + robot.id +
                    " were ignored: mission.yaml has no mac for its card");
  std::size_t unknown = 0;
  for (const CsiPacket& packet : capture.packets) {
    const auto sent = [&](const Robot& other) {
      return other.csi && other.csi->address && packet.sender == other.csi->address;
    };
    if (std::none_of(mission.robots.begin(), mission.robots.end(), sent)) ++unknown;
  }
  if (unknown > 0)
    notes.push_back(plural(unknown, "packet") + " of robot " + robot.id +
                    "'s CSI captures were ignored: their sender's mac belongs to no robot");
}

std::string note_of_clock(const std::string& robot, const ClockOffset& clock) {
  std::ostringstream note;
  note << std::fixed << std::setprecision(3) << "robot " << robot << "'s CSI captures were shifted by "
       << clock.offset_s << " s to match its odometry's clock (sigma " << clock.sigma_s << " s)";
  return note.str();
}

void note_refusals(const Mission& mission, const CsiRefusals& refusals, std::vector<std::string>& notes) {
  for (const auto& [what, count] : refusals) {
    const auto& [receiver, transmitter, reason] = what;
    notes.push_back("robot " + mission.robots[receiver].id + " measured no angle of arrival of robot " +
                    mission.robots[transmitter].id + " in " + plural(count, "window") + ": " + reason);
  }
}

CsiCapture merge_captures(const CsiRecording& csi, const std::string& robot,
                          std::vector<std::string>& notes) {
  CsiCapture all;
  std::size_t others = 0;
  for (const CsiCapture& capture : csi.captures) {
    for (const auto& warning : capture.warnings) notes.push_back(warning);
    if (all.packets.empty()) {
      all = capture;
      continue;
    }
    if (capture.subcarrier_hz != all.subcarrier_hz)
      ++others;
    else
      all.packets.insert(all.packets.end(), capture.packets.begin(), capture.packets.end());
  }
  if (others > 0)
    notes.push_back(std::to_string(others) + " captures of robot " + robot +
                    " were skipped: their subcarriers differ from those of the first capture");
  std::stable_sort(all.packets.begin(), all.packets.end(),
                   [](const CsiPacket& a, const CsiPacket& b) { return a.stamp < b.stamp; });
  return all;
}

CsiCapture captured_during(const CsiCapture& capture, Stamp begin, Stamp end) {
  CsiCapture part;
  part.subcarrier_hz = capture.subcarrier_hz;
  part.carrier_hz = capture.carrier_hz;
  const auto first = std::lower_bound(capture.packets.begin(), capture.packets.end(), begin,
                                      [](const CsiPacket& packet, Stamp s) { return packet.stamp < s; });
  const auto last = std::upper_bound(first, capture.packets.end(), end,
                                     [](Stamp s, const CsiPacket& packet) { return s < packet.stamp; });
  part.packets.assign(first, last);
  return part;
}

double carrier_hz_of(const CsiRecording& csi, const CsiCapture& capture) {
  return csi.carrier_hz > 0 ? csi.carrier_hz : capture.carrier_hz.value_or(0);
}

std::vector<TimeWindow> still_times(const Trajectory<SE3>& odometry, double reach_m) {
  std::vector<TimeWindow> times;
  for (std::size_t first = 0; first < odometry.size();) {
    std::size_t last = first;
    while (last + 1 < odometry.size() && distance_m(odometry[first].pose, odometry[last + 1].pose) <= reach_m)
      ++last;
    if (last > first) times.push_back({odometry[first].stamp, odometry[last].stamp});
    first = last + 1;
  }
  return times;
}

std::vector<TimeWindow> path_windows(const Trajectory<SE3>& odometry, const TimeWindow& during,
                                     double length_m, double min_m) {
  std::vector<Stamp> stamps;
  std::vector<double> path_m;
  const SE3* before = nullptr;
  for (const auto& [stamp, pose] : odometry) {
    if (stamp < during.begin || during.end < stamp) continue;
    path_m.push_back(path_m.empty() ? 0 : path_m.back() + distance_m(*before, pose));
    stamps.push_back(stamp);
    before = &pose;
  }
  std::vector<TimeWindow> windows;
  if (path_m.empty() || path_m.back() < min_m) return windows;
  const auto count = std::max<long>(1, std::lround(path_m.back() / length_m));
  const double each_m = path_m.back() / static_cast<double>(count);
  for (long n = 0; n < count; ++n) {
    const auto at = [&](double metres) {
      const auto k = std::lower_bound(path_m.begin(), path_m.end(), metres * (1 - 1e-12)) - path_m.begin();
      return stamps[std::min(static_cast<std::size_t>(k), stamps.size() - 1)];
    };
    windows.push_back({at(each_m * static_cast<double>(n)), at(each_m * static_cast<double>(n + 1))});
  }
  return windows;
}

std::vector<TimeWindow> turns_of(const Trajectory<SE3>& odometry, double turn_rad) {
  std::vector<TimeWindow> turns;
  double turned_rad = 0;
  std::size_t first = 0;
  for (std::size_t k = 1; k < odometry.size(); ++k) {
    turned_rad += odometry[k - 1].pose.rotation().angularDistance(odometry[k].pose.rotation());
    if (turned_rad < turn_rad) continue;
    turns.push_back({odometry[first].stamp, odometry[k].stamp});
    turned_rad = 0;
    first = k;
  }
  return turns;
}

CsiTracks::CsiTracks(const Mission& mission, const CsiStageParams& params, std::vector<std::string>& notes)
    : mission_(mission), params_(params) {
  for (const Robot& robot : mission.robots) {
    captures_.push_back(robot.csi ? merge_captures(*robot.csi, robot.id, notes) : CsiCapture{});
    still_.push_back(robot.csi ? still_times(robot.odometry, params.still_m) : std::vector<TimeWindow>{});
  }
  for (std::size_t i = 0; i < captures_.size(); ++i)
    if (!captures_[i].packets.empty()) note_missing_csi(mission, mission.robots[i], captures_[i], notes);
}

void CsiTracks::set_clocks(std::vector<std::string>& notes) {
  std::vector<std::optional<ClockOffset>> clocks(captures_.size());
  parallel_for(captures_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) clocks[i] = clock_of(i);
  });
  for (std::size_t i = 0; i < clocks.size(); ++i)
    if (clocks[i]) set_clock(i, *clocks[i], notes);
}

std::vector<CsiAttempt> CsiTracks::attempts() const {
  std::vector<CsiAttempt> list;
  for (std::size_t i = 0; i < mission_.robots.size(); ++i)
    for (std::size_t j = 0; j < mission_.robots.size(); ++j)
      if (i != j && receives(i, j)) add_attempts(list, i, j);
  return list;
}

CsiTrack CsiTracks::track_of(const CsiAttempt& attempt) const {
  const CsiRecording& receiver = *mission_.robots[attempt.receiver].csi;
  const CsiRecording& sender = *mission_.robots[attempt.transmitter].csi;
  const CsiCapture heard =
      captured_during(captures_[attempt.receiver], attempt.window.begin, attempt.window.end);
  const double carrier_hz = carrier_hz_of(receiver, heard);
  if (!attempt.is_two_way)
    return {antenna_pair_track(heard, sender.address, carrier_hz, receiver.antennas_m, 0, 1),
            "no packets received by two antennas"};
  CsiCapture answers =
      captured_during(captures_[attempt.transmitter], {attempt.window.begin.ns - kHostDelay_ns},
                      {attempt.window.end.ns + kHostDelay_ns});
  // Packets that it received from other robots are no replies.
  std::erase_if(answers.packets, [&](const CsiPacket& packet) {
    return packet.sender && receiver.address && packet.sender != receiver.address;
  });
  auto both = two_way_track(heard, *sender.address, answers, carrier_hz, receiver.antennas_m.front(),
                            params_.aoa.two_way);
  return {std::move(both.track), explain(both.reason)};
}

/// Estimate of smallest sigma over the longest windows in which the robot moved while another stood and
/// replied.
std::optional<ClockOffset> CsiTracks::clock_of(std::size_t i) const {
  std::vector<CsiAttempt> windows;
  for (std::size_t j = 0; j < mission_.robots.size(); ++j)
    if (i != j && receives(i, j))
      for (const TimeWindow& still : still_[j]) windows.push_back({i, j, still, true});
  std::stable_sort(windows.begin(), windows.end(), [](const CsiAttempt& a, const CsiAttempt& b) {
    return a.window.end.ns - a.window.begin.ns > b.window.end.ns - b.window.begin.ns;
  });
  std::optional<ClockOffset> best;
  for (std::size_t k = 0; k < std::min(windows.size(), kMaxClocks); ++k) {
    const CsiTrack candidate = track_of(windows[k]);
    if (!candidate.track) continue;
    const auto clock = estimate_clock_offset(*candidate.track, mission_.robots[i].odometry).clock;
    if (clock && (!best || clock->sigma_s < best->sigma_s)) best = clock;
  }
  return best;
}

void CsiTracks::set_clock(std::size_t i, const ClockOffset& clock, std::vector<std::string>& notes) {
  const double size_s = std::abs(clock.offset_s);
  if (clock.sigma_s > kMaxClockSigma_s) return;
  if (size_s < kMinClock_s || size_s < kClockSigmas * clock.sigma_s) return;
  const auto offset_ns = std::llround(clock.offset_s * kNanosecondsPerSecond);
  for (CsiPacket& packet : captures_[i].packets) packet.stamp.ns += offset_ns;
  notes.push_back(note_of_clock(mission_.robots[i].id, clock));
}

bool CsiTracks::receives(std::size_t i, std::size_t j) const {
  const Robot& receiver = mission_.robots[i];
  const Robot& sender = mission_.robots[j];
  if (!receiver.csi || !sender.csi || !sender.csi->address || carrier_hz_of(*receiver.csi, captures_[i]) == 0)
    return false;
  return std::any_of(captures_[i].packets.begin(), captures_[i].packets.end(),
                     [&](const CsiPacket& packet) { return packet.sender == sender.csi->address; });
}

void CsiTracks::add_attempts(std::vector<CsiAttempt>& list, std::size_t i, std::size_t j) const {
  const Robot& receiver = mission_.robots[i];
  const bool has_pair = receiver.csi->antennas_m.size() > 1;
  if (has_pair) {
    for (const TimeWindow& turn : turns_of(receiver.odometry, params_.window_turn_rad))
      list.push_back({i, j, turn, false});
    return;
  }
  for (const TimeWindow& still : still_[j])
    for (const TimeWindow& window :
         path_windows(receiver.odometry, still, params_.window_m, params_.aoa.min_aperture_m))
      list.push_back({i, j, window, true});
}

}  // namespace radioslam
