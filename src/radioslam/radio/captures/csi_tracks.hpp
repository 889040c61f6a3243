// Channel tracks from a mission's CSI captures, one per window of a receiver's motion and transmitter.
//
// A receiver with one antenna uses windows of its path in which the transmitter stood still, and the packets
// of both ends, so that the oscillators' phases cancel (two_way_channel.hpp). A receiver with two antennas
// uses windows of its rotation, however the transmitter moved (antenna_pair_track). Captures and odometry may
// have different clocks: where a robot stopped or started while another replied, the offset is estimated, and
// corrected where it is significant.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/radio/captures/clock_offset.hpp"
#include "radioslam/radio/captures/csi_params.hpp"

namespace radioslam {

// Notes for the user about CSI captures: which were ignored, which were shifted to the odometry's clock, and
// where no angle of arrival was measured, with the reason.

std::string explain(TwoWayFailure reason);
std::string explain(AoaFailure reason);

/// Notes a missing WiFi channel, a missing MAC address, and packets whose sender is no robot of the mission.
void note_missing_csi(const Mission& mission, const Robot& robot, const CsiCapture& capture,
                      std::vector<std::string>& notes);

/// Note that the robot's captures were shifted to its odometry's clock.
std::string note_of_clock(const std::string& robot, const ClockOffset& clock);

/// Number of windows without an AoA estimate, by receiver, transmitter and reason.
using CsiRefusals = std::map<std::tuple<std::size_t, std::size_t, std::string>, std::size_t>;

void note_refusals(const Mission& mission, const CsiRefusals& refusals, std::vector<std::string>& notes);

// Merges a robot's CSI captures into one in time order, and extracts time ranges of it.
//
// Captures whose subcarriers differ from the first one's are skipped with a note. Merging sorts the packets;
// a time range is found in logarithmic time and copied.

/// A robot's packets in time order; captures with other subcarriers than the first are skipped.
CsiCapture merge_captures(const CsiRecording& csi, const std::string& robot, std::vector<std::string>& notes);

/// The packets between `begin` and `end`, both included.
CsiCapture captured_during(const CsiCapture& capture, Stamp begin, Stamp end);

/// Carrier frequency by the mission, else by the capture; 0 where neither has it.
double carrier_hz_of(const CsiRecording& csi, const CsiCapture& capture);

/// Time windows for AoA measurements: windows of a receiver's path or rotation, and when a transmitter stood
/// still.
struct TimeWindow {
  Stamp begin, end;
};

/// Windows in which the body stayed within `reach_m` of its position at their begin.
std::vector<TimeWindow> still_times(const Trajectory<SE3>& odometry, double reach_m);

/// Windows of equal path length within `during`, each about `length_m` long; none if the path is shorter than
/// `min_m`.
std::vector<TimeWindow> path_windows(const Trajectory<SE3>& odometry, const TimeWindow& during,
                                     double length_m, double min_m);

/// Windows in which the body turned by about `turn_rad`, however it moved.
std::vector<TimeWindow> turns_of(const Trajectory<SE3>& odometry, double turn_rad);

/// A measurement to attempt.
struct CsiAttempt {
  std::size_t receiver, transmitter;
  TimeWindow window;
  bool is_two_way;
};

struct CsiTrack {
  std::optional<ChannelTrack> track;
  std::string reason;  ///< why there is no track
};

class CsiTracks {
 public:
  /// Both must outlive this. Captures that are not used are added to `notes`.
  CsiTracks(const Mission& mission, const CsiStageParams& params, std::vector<std::string>& notes);

  /// Shifts captures to the clock of their robot's odometry where the offset is significant.
  void set_clocks(std::vector<std::string>& notes);

  /// Ordered by receiver, then by transmitter.
  std::vector<CsiAttempt> attempts() const;

  CsiTrack track_of(const CsiAttempt& attempt) const;

 private:
  std::optional<ClockOffset> clock_of(std::size_t i) const;
  void set_clock(std::size_t i, const ClockOffset& clock, std::vector<std::string>& notes);
  bool receives(std::size_t i, std::size_t j) const;
  void add_attempts(std::vector<CsiAttempt>& list, std::size_t i, std::size_t j) const;

  const Mission& mission_;
  const CsiStageParams& params_;
  std::vector<CsiCapture> captures_;
  std::vector<std::vector<TimeWindow>> still_;
};

}  // namespace radioslam
