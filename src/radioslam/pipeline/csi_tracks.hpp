// A mission's captures as tracks of channels, each along a robot's way while another answered or sent.
//
// A receiver with one antenna takes pieces of its way during which the transmitter stood, and both ends'
// packets, so that the oscillators' phases cancel (two_way_channel.hpp); one with two antennas takes its
// turns, however the transmitter moved (antenna_pair_track). Captures are stamped by another clock than the
// odometry: where a robot stopped or started while another answered, the offset is estimated, and the
// captures moved by it where it shows.
//
// An attempt without a track has a reason in words.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/csi_params.hpp"
#include "radioslam/pipeline/csi_windows.hpp"
#include "radioslam/radio/clock_offset.hpp"

namespace radioslam {

/// One measurement to be tried.
struct CsiAttempt {
  std::size_t receiver, transmitter;
  TimeWindow window;
  bool is_two_way;
};

struct CsiTrack {
  std::optional<ChannelTrack> track;
  std::string reason;  ///< where there is none
};

class CsiTracks {
 public:
  /// Both must outlive this. `notes` get what takes no part.
  CsiTracks(const Mission& mission, const CsiStageParams& params, std::vector<std::string>& notes);

  /// Moves captures to the clock of their robot's odometry, where the offset shows.
  void set_clocks(std::vector<std::string>& notes);

  /// In the order of receivers, and then of transmitters.
  std::vector<CsiAttempt> attempts() const;

  CsiTrack track_of(const CsiAttempt& attempt) const;

 private:
  std::optional<ClockOffset> clock_of(std::size_t i) const;
  void set_clock(std::size_t i, const ClockOffset& clock, std::vector<std::string>& notes);
  bool hears(std::size_t i, std::size_t j) const;
  void add_attempts(std::vector<CsiAttempt>& list, std::size_t i, std::size_t j) const;

  const Mission& mission_;
  const CsiStageParams& params_;
  std::vector<CsiCapture> captures_;
  std::vector<std::vector<TimeWindow>> still_;
};

}  // namespace radioslam
