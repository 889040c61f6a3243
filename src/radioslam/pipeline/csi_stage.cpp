#include "radioslam/pipeline/csi_stage.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <tuple>

#include "radioslam/base/parallel.hpp"
#include "radioslam/pipeline/csi_windows.hpp"
#include "radioslam/radio/clock_offset.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kHostDelay_ns = 1'000'000'000;  // an answer is written down within
constexpr double kElevationSigmas = 2;                 // of the azimuth: an elevation less sure is none
constexpr double kClockSigmas = 3;                     // by which an offset shows
constexpr double kSurestClock_s = 0.05;  // a speed that varies gently misleads with wider sigmas
constexpr double kLeastClock_s = 0.02;   // what a walk hardly shows is left as it is
constexpr std::size_t kMostClocks = 4;   // estimates for each robot

/// One measurement to be tried.
struct Attempt {
  std::size_t receiver, transmitter;
  TimeWindow window;
  bool is_two_way;
};

/// What came of it.
struct Attempted {
  std::optional<ArrivalEstimate> estimate;
  std::string reason;  ///< where there is none
};

std::string reason_text(NoTwoWay reason) {
  switch (reason) {
    case NoTwoWay::kOtherSubcarriers:
      return "the two ends measured other subcarriers";
    case NoTwoWay::kIncoherent:
      return "the other end's packets do not answer these, or too slowly: their phases do not agree";
    case NoTwoWay::kTooFewExchanges:
      break;
  }
  return "fewer than three packets were answered";
}

std::string reason_text(NoArrival reason) {
  switch (reason) {
    case NoArrival::kNoMotion:
      return "the antenna hardly moved";
    case NoArrival::kNoOdometry:
      return "there is no odometry at the packets' times";
    case NoArrival::kTooWide:
      return "the way is wider than csi.most_extent_m";
    case NoArrival::kSilent:
      return "the channel is zero throughout";
    case NoArrival::kTooFewPackets:
      break;
  }
  return "too few packets";
}

std::string plural(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

/// A robot's packets in time order, in one form; other forms than the first are left out.
CsiCapture merged(const CsiRecording& csi, const std::string& robot, std::vector<std::string>& notes) {
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
                    " were left out: they measure other subcarriers than the first");
  std::stable_sort(all.packets.begin(), all.packets.end(),
                   [](const CsiPacket& a, const CsiPacket& b) { return a.stamp < b.stamp; });
  return all;
}

CsiCapture during(const CsiCapture& capture, Stamp begin, Stamp end) {
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

double carrier_of(const CsiRecording& csi, const CsiCapture& capture) {
  return csi.carrier_hz > 0 ? csi.carrier_hz : capture.carrier_hz.value_or(0);
}

class CsiStage {
 public:
  CsiStage(const Mission& mission, const CsiStageParams& params, std::vector<std::string>& notes)
      : mission_(mission), params_(params) {
    for (const Robot& robot : mission.robots) {
      captures_.push_back(robot.csi ? merged(*robot.csi, robot.id, notes) : CsiCapture{});
      still_.push_back(robot.csi ? still_times(robot.odometry, params.still_m) : std::vector<TimeWindow>{});
    }
    for (std::size_t i = 0; i < captures_.size(); ++i)
      if (!captures_[i].packets.empty()) note_what_is_missing(i, notes);
  }

  /// Moves captures to the clock of their robot's odometry, where the offset shows.
  void set_clocks(std::vector<std::string>& notes) {
    std::vector<std::optional<ClockOffset>> clocks(captures_.size());
    parallel_for(captures_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) clocks[i] = clock_of(i);
    });
    for (std::size_t i = 0; i < clocks.size(); ++i)
      if (clocks[i]) set_clock(i, *clocks[i], notes);
  }

  std::vector<Attempt> attempts() const {
    std::vector<Attempt> list;
    for (std::size_t i = 0; i < mission_.robots.size(); ++i)
      for (std::size_t j = 0; j < mission_.robots.size(); ++j)
        if (i != j && hears(i, j)) add_attempts(list, i, j);
    return list;
  }

  Attempted measure(const Attempt& attempt) const {
    const Robot& receiver = mission_.robots[attempt.receiver];
    auto [track, reason] = track_of(attempt);
    if (!track) return {std::nullopt, std::move(reason)};
    ArrivalResult result = estimate_arrival(*track, receiver.odometry, attempt.window.begin,
                                            attempt.window.end, params_.arrival);
    if (!result.estimate) return {std::nullopt, reason_text(result.reason)};
    return {std::move(result.estimate), {}};
  }

 private:
  struct Track {
    std::optional<ChannelTrack> track;
    std::string reason;
  };

  void note_what_is_missing(std::size_t i, std::vector<std::string>& notes) const {
    const Robot& robot = mission_.robots[i];
    if (carrier_of(*robot.csi, captures_[i]) == 0)
      notes.push_back("robot " + robot.id +
                      "'s captures took no part: neither they nor mission.yaml tell the channel");
    if (!robot.csi->address)
      notes.push_back("what others heard of robot " + robot.id +
                      " took no part: mission.yaml has no mac of its card");
    std::size_t unknown = 0;
    for (const CsiPacket& packet : captures_[i].packets) {
      const auto sent = [&](const Robot& other) {
        return other.csi && other.csi->address && packet.sender == other.csi->address;
      };
      if (std::none_of(mission_.robots.begin(), mission_.robots.end(), sent)) ++unknown;
    }
    if (unknown > 0)
      notes.push_back(plural(unknown, "packet") + " of robot " + robot.id +
                      "'s captures took no part: no robot's card has the mac of their sender");
  }

  /// Of the longest ways that the robot moved while another stood and answered: the surest estimate.
  std::optional<ClockOffset> clock_of(std::size_t i) const {
    std::vector<Attempt> ways;
    for (std::size_t j = 0; j < mission_.robots.size(); ++j)
      if (i != j && hears(i, j))
        for (const TimeWindow& still : still_[j]) ways.push_back({i, j, still, true});
    std::stable_sort(ways.begin(), ways.end(), [](const Attempt& a, const Attempt& b) {
      return a.window.end.ns - a.window.begin.ns > b.window.end.ns - b.window.begin.ns;
    });
    std::optional<ClockOffset> surest;
    for (std::size_t k = 0; k < std::min(ways.size(), kMostClocks); ++k) {
      const Track way = track_of(ways[k]);
      if (!way.track) continue;
      const auto clock = estimate_clock_offset(*way.track, mission_.robots[i].odometry).clock;
      if (clock && (!surest || clock->sigma_s < surest->sigma_s)) surest = clock;
    }
    return surest;
  }

  void set_clock(std::size_t i, const ClockOffset& clock, std::vector<std::string>& notes) {
    const double size_s = std::abs(clock.offset_s);
    if (clock.sigma_s > kSurestClock_s) return;
    if (size_s < kLeastClock_s || size_s < kClockSigmas * clock.sigma_s) return;
    const auto offset_ns = std::llround(clock.offset_s * 1e9);
    for (CsiPacket& packet : captures_[i].packets) packet.stamp.ns += offset_ns;
    std::ostringstream note;
    note << std::fixed << std::setprecision(3) << "robot " << mission_.robots[i].id
         << "'s captures were moved by " << clock.offset_s << " s to its odometry's clock (sigma "
         << clock.sigma_s << " s)";
    notes.push_back(note.str());
  }

  bool hears(std::size_t i, std::size_t j) const {
    const Robot& receiver = mission_.robots[i];
    const Robot& sender = mission_.robots[j];
    if (!receiver.csi || !sender.csi || !sender.csi->address || carrier_of(*receiver.csi, captures_[i]) == 0)
      return false;
    return std::any_of(captures_[i].packets.begin(), captures_[i].packets.end(),
                       [&](const CsiPacket& packet) { return packet.sender == sender.csi->address; });
  }

  void add_attempts(std::vector<Attempt>& list, std::size_t i, std::size_t j) const {
    const Robot& receiver = mission_.robots[i];
    const bool has_pair = receiver.csi->antennas_m.size() > 1;
    if (has_pair) {
      for (const TimeWindow& turn : turns_of(receiver.odometry, params_.window_turn_rad))
        list.push_back({i, j, turn, false});
      return;
    }
    for (const TimeWindow& still : still_[j])
      for (const TimeWindow& piece :
           pieces_of_way(receiver.odometry, still, params_.window_m, params_.arrival.least_way_m))
        list.push_back({i, j, piece, true});
  }

  Track track_of(const Attempt& attempt) const {
    const CsiRecording& receiver = *mission_.robots[attempt.receiver].csi;
    const CsiRecording& sender = *mission_.robots[attempt.transmitter].csi;
    const CsiCapture heard = during(captures_[attempt.receiver], attempt.window.begin, attempt.window.end);
    const double carrier_hz = carrier_of(receiver, heard);
    if (!attempt.is_two_way)
      return {antenna_pair_track(heard, sender.address, carrier_hz, receiver.antennas_m, 0, 1),
              "no packets that two antennas heard"};
    CsiCapture answers = during(captures_[attempt.transmitter], {attempt.window.begin.ns - kHostDelay_ns},
                                {attempt.window.end.ns + kHostDelay_ns});
    // What it heard of others is no answer.
    std::erase_if(answers.packets, [&](const CsiPacket& packet) {
      return packet.sender && receiver.address && packet.sender != receiver.address;
    });
    auto both = two_way_track(heard, *sender.address, answers, carrier_hz, receiver.antennas_m.front(),
                              params_.arrival.two_way);
    return {std::move(both.track), reason_text(both.reason)};
  }

  const Mission& mission_;
  const CsiStageParams& params_;
  std::vector<CsiCapture> captures_;
  std::vector<std::vector<TimeWindow>> still_;
};

/// The direction in the body frame of a source seen from the body instead of the array's centre.
Eigen::Vector3d seen_from_body(const ArrivalEstimate& estimate, const ArrivalDirection& direction,
                               double curvature_per_m) {
  Eigen::Vector3d way = WaveSource{direction.azimuth_rad, direction.elevation_rad, 0}.direction();
  if (curvature_per_m > 0 && !estimate.centre_m.isZero(0))
    way += curvature_per_m * (estimate.centre_m - estimate.T_frame_body.translation());
  return (estimate.T_frame_body.rotation().conjugate() * way).normalized();
}

double azimuth_of(const Eigen::Vector3d& u) { return std::atan2(u.y(), u.x()); }

/// Another azimuth, and not just down for up.
bool is_aside(const ArrivalPeak& peak) {
  const double apart_rad = std::remainder(peak.mirror->azimuth_rad - peak.azimuth_rad, 2 * std::numbers::pi);
  return std::abs(apart_rad) > 2 * peak.sigma_rad;
}

bool tells_elevation(const ArrivalEstimate& estimate, const ArrivalPeak& peak) {
  return estimate.tells_height && (!peak.mirror || is_aside(peak)) &&
         peak.elevation_sigma_rad <= kElevationSigmas * peak.sigma_rad;
}

ArrivalPath path_of(const ArrivalEstimate& estimate, const ArrivalDirection& direction,
                    const ArrivalPeak& peak, int dimension) {
  const Eigen::Vector3d u = seen_from_body(estimate, direction, peak.curvature_per_m);
  ArrivalPath path{azimuth_of(u), std::nullopt, peak.sigma_rad, peak.power_db};
  if (dimension == 3 && tells_elevation(estimate, peak)) {
    path.elevation_rad = std::asin(std::clamp(u.z(), -1.0, 1.0));
    path.sigma_rad = std::max(peak.sigma_rad, peak.elevation_sigma_rad);
  }
  return path;
}

ArrivalMeasurement measurement_of(const Mission& mission, const Attempt& attempt,
                                  const ArrivalEstimate& estimate) {
  ArrivalMeasurement measured;
  measured.stamp = estimate.stamp;
  measured.receiver = RobotIndex(attempt.receiver);
  measured.transmitter.robot = RobotIndex(attempt.transmitter);
  measured.transmitter.lever_arm_m = mission.robots[attempt.transmitter].csi->antennas_m.front();
  for (const ArrivalPeak& peak : estimate.peaks) {
    // The strongest is named a ghost wrongly now and then, and losing it costs more than a false path.
    if (peak.is_ghost && &peak != &estimate.peaks.front()) continue;
    const ArrivalDirection direction{peak.azimuth_rad, peak.elevation_rad};
    measured.paths.push_back(path_of(estimate, direction, peak, mission.dimension));
    if (peak.mirror && is_aside(peak))
      measured.paths.push_back(path_of(estimate, *peak.mirror, peak, mission.dimension));
  }
  return measured;
}

/// The profile turned into the body frame, on the same grid.
std::vector<float> turned_to_body(const ArrivalEstimate& estimate) {
  const Eigen::Vector3d forward = estimate.T_frame_body.rotation() * Eigen::Vector3d::UnitX();
  const auto n = std::ssize(estimate.profile);
  const auto shift = std::lround(azimuth_of(forward) / (2 * std::numbers::pi) * static_cast<double>(n));
  std::vector<float> turned;
  for (std::ptrdiff_t k = 0; k < n; ++k)
    turned.push_back(estimate.profile[static_cast<std::size_t>(((k + shift) % n + n) % n)]);
  return turned;
}

MeasuredArrivalResult profile_of(const Mission& mission, const Attempt& attempt,
                                 const ArrivalEstimate& estimate) {
  MeasuredArrivalResult result;
  result.receiver = mission.robots[attempt.receiver].id;
  result.transmitter = mission.robots[attempt.transmitter].id;
  result.stamp = estimate.stamp;
  for (const ArrivalPeak& peak : estimate.peaks)
    result.peaks.push_back(
        {azimuth_of(seen_from_body(estimate, {peak.azimuth_rad, peak.elevation_rad}, peak.curvature_per_m)),
         peak.sigma_rad, peak.power_db, peak.is_ghost});
  result.profile = turned_to_body(estimate);
  return result;
}

/// Pieces of way or turns without a direction, counted for each pair of robots and reason.
void add_refusals(const Mission& mission, const std::vector<Attempt>& attempts,
                  const std::vector<Attempted>& attempted, std::vector<std::string>& notes) {
  std::map<std::tuple<std::size_t, std::size_t, std::string>, std::size_t> counts;
  for (std::size_t k = 0; k < attempts.size(); ++k)
    if (!attempted[k].estimate)
      ++counts[{attempts[k].receiver, attempts[k].transmitter, attempted[k].reason}];
  for (const auto& [what, count] : counts) {
    const auto& [receiver, transmitter, reason] = what;
    notes.push_back("robot " + mission.robots[receiver].id + " did not measure where it heard " +
                    mission.robots[transmitter].id + " from on " + plural(count, "piece") +
                    " of its way: " + reason);
  }
}

}  // namespace

MeasuredCsi measure_csi(const Mission& mission, const CsiStageParams& params, const Progress& progress) {
  MeasuredCsi result;
  const auto has_csi = [](const Robot& robot) { return robot.csi && !robot.csi->captures.empty(); };
  if (std::none_of(mission.robots.begin(), mission.robots.end(), has_csi)) return result;
  CsiStage stage(mission, params, result.notes);
  if (params.clock_offset) stage.set_clocks(result.notes);
  std::vector<Attempt> attempts = stage.attempts();
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const Attempt& a, const Attempt& b) { return a.window.begin < b.window.begin; });
  std::vector<Attempted> attempted(attempts.size());
  constexpr std::size_t kRound = 16;
  for (std::size_t done = 0; done < attempts.size(); done += kRound) {
    report_progress(progress, "angles of arrival",
                    static_cast<double>(done) / static_cast<double>(attempts.size()));
    parallel_for(std::min(kRound, attempts.size() - done), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = done + begin; k < done + end; ++k) attempted[k] = stage.measure(attempts[k]);
    });
  }
  for (std::size_t k = 0; k < attempts.size(); ++k) {
    if (!attempted[k].estimate) continue;
    ArrivalMeasurement measured = measurement_of(mission, attempts[k], *attempted[k].estimate);
    result.profiles.push_back(profile_of(mission, attempts[k], *attempted[k].estimate));
    result.profiles.back().paths = measured.paths;
    result.arrivals.push_back(std::move(measured));
  }
  add_refusals(mission, attempts, attempted, result.notes);
  return result;
}

void add_estimated_azimuths(std::vector<MeasuredArrivalResult>& profiles,
                            const std::vector<RobotResult>& robots) {
  const auto pose_of = [&](const std::string& id, Stamp stamp) -> std::optional<SE3> {
    for (const RobotResult& robot : robots)
      if (robot.id == id && robot.placed) return robot.estimate.at(stamp);
    return std::nullopt;
  };
  for (MeasuredArrivalResult& profile : profiles) {
    const auto receiver = pose_of(profile.receiver, profile.stamp);
    const auto transmitter = pose_of(profile.transmitter, profile.stamp);
    if (receiver && transmitter)
      profile.estimated_azimuth_rad = azimuth_of(receiver->inverse() * transmitter->translation());
  }
}

}  // namespace radioslam
