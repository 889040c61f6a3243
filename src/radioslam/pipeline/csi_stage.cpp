#include "radioslam/pipeline/csi_stage.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "radioslam/base/parallel.hpp"
#include "radioslam/pipeline/csi_windows.hpp"

namespace radioslam {
namespace {

constexpr std::int64_t kHostDelay_ns = 1'000'000'000;  // an answer is written down within

/// One measurement to be tried.
struct Attempt {
  std::size_t receiver, transmitter;
  TimeWindow window;
  bool is_two_way;
};

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
      if (!captures_.back().packets.empty() && carrier_of(*robot.csi, captures_.back()) == 0)
        notes.push_back("robot " + robot.id +
                        "'s captures took no part: neither they nor mission.yaml tell "
                        "the channel");
    }
  }

  std::vector<Attempt> attempts() const {
    std::vector<Attempt> list;
    for (std::size_t i = 0; i < mission_.robots.size(); ++i)
      for (std::size_t j = 0; j < mission_.robots.size(); ++j)
        if (i != j && hears(i, j)) add_attempts(list, i, j);
    return list;
  }

  std::optional<ArrivalEstimate> measure(const Attempt& attempt) const {
    const Robot& receiver = mission_.robots[attempt.receiver];
    const auto track = track_of(attempt);
    if (!track) return std::nullopt;
    return estimate_arrival(*track, receiver.odometry, attempt.window.begin, attempt.window.end,
                            params_.arrival)
        .estimate;
  }

 private:
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

  std::optional<ChannelTrack> track_of(const Attempt& attempt) const {
    const CsiRecording& receiver = *mission_.robots[attempt.receiver].csi;
    const CsiRecording& sender = *mission_.robots[attempt.transmitter].csi;
    const CsiCapture heard = during(captures_[attempt.receiver], attempt.window.begin, attempt.window.end);
    const double carrier_hz = carrier_of(receiver, heard);
    if (!attempt.is_two_way)
      return antenna_pair_track(heard, sender.address, carrier_hz, receiver.antennas_m, 0, 1);
    CsiCapture answers = during(captures_[attempt.transmitter], {attempt.window.begin.ns - kHostDelay_ns},
                                {attempt.window.end.ns + kHostDelay_ns});
    // What it heard of others is no answer.
    std::erase_if(answers.packets, [&](const CsiPacket& packet) {
      return packet.sender && receiver.address && packet.sender != receiver.address;
    });
    return two_way_track(heard, *sender.address, answers, carrier_hz, receiver.antennas_m.front(),
                         params_.arrival.two_way);
  }

  const Mission& mission_;
  const CsiStageParams& params_;
  std::vector<CsiCapture> captures_;
  std::vector<std::vector<TimeWindow>> still_;
};

/// The direction in the body frame of a source seen from the body instead of the array's centre.
Eigen::Vector3d seen_from_body(const ArrivalEstimate& estimate, double azimuth_rad, const ArrivalPeak& peak) {
  const Eigen::Vector3d u = WaveSource{azimuth_rad, peak.elevation_rad, 0}.direction();
  Eigen::Vector3d way = u;
  if (peak.curvature_per_m > 0 && !estimate.centre_m.isZero(0))
    way += peak.curvature_per_m * (estimate.centre_m - estimate.T_frame_body.translation());
  return (estimate.T_frame_body.rotation().conjugate() * way).normalized();
}

double azimuth_of(const Eigen::Vector3d& u) { return std::atan2(u.y(), u.x()); }

ArrivalPath path_of(const ArrivalEstimate& estimate, double azimuth_rad, const ArrivalPeak& peak,
                    int dimension) {
  const Eigen::Vector3d u = seen_from_body(estimate, azimuth_rad, peak);
  ArrivalPath path{azimuth_of(u), std::nullopt, peak.sigma_rad, peak.power_db};
  if (dimension == 3) path.elevation_rad = std::asin(std::clamp(u.z(), -1.0, 1.0));
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
    measured.paths.push_back(path_of(estimate, peak.azimuth_rad, peak, mission.dimension));
    if (peak.mirror_rad)
      measured.paths.push_back(path_of(estimate, *peak.mirror_rad, peak, mission.dimension));
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
    result.peaks.push_back({azimuth_of(seen_from_body(estimate, peak.azimuth_rad, peak)), peak.sigma_rad,
                            peak.power_db, peak.is_ghost});
  result.profile = turned_to_body(estimate);
  return result;
}

}  // namespace

MeasuredCsi measure_csi(const Mission& mission, const CsiStageParams& params, const Progress& progress) {
  MeasuredCsi result;
  const auto has_csi = [](const Robot& robot) { return robot.csi && !robot.csi->captures.empty(); };
  if (std::none_of(mission.robots.begin(), mission.robots.end(), has_csi)) return result;
  const CsiStage stage(mission, params, result.notes);
  std::vector<Attempt> attempts = stage.attempts();
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const Attempt& a, const Attempt& b) { return a.window.begin < b.window.begin; });
  std::vector<std::optional<ArrivalEstimate>> estimates(attempts.size());
  constexpr std::size_t kRound = 16;
  for (std::size_t done = 0; done < attempts.size(); done += kRound) {
    report_progress(progress, "angles of arrival",
                    static_cast<double>(done) / static_cast<double>(attempts.size()));
    parallel_for(std::min(kRound, attempts.size() - done), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = done + begin; k < done + end; ++k) estimates[k] = stage.measure(attempts[k]);
    });
  }
  for (std::size_t k = 0; k < attempts.size(); ++k) {
    if (!estimates[k]) continue;
    ArrivalMeasurement measured = measurement_of(mission, attempts[k], *estimates[k]);
    if (measured.paths.empty()) continue;
    result.arrivals.push_back(std::move(measured));
    result.profiles.push_back(profile_of(mission, attempts[k], *estimates[k]));
  }
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
