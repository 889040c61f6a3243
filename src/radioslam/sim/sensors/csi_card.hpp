// Simulated WiFi card: carrier offset, clock and measurement errors on top of the channel.
//
// The carriers of two cards differ by a constant and a random walk; the resulting phase has opposite signs in
// the two directions of an exchange. Each card counts its own microseconds. It detects a packet slightly
// late, which adds a phase slope over the subcarriers, and records eight bits per number after an automatic
// gain.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {

/// All parameters except those of the room. Field names are unique within a scenario.
struct CsiCardParams {
  double carrier_offset_hz = 5000;
  double carrier_walk_hz_per_sqrt_s = 20;
  double clock_rate_ppm = 10;
  bool random_phase = true;
  double sigma_chain_phase_rad = 0;
  double answer_delay_us = 300;
  double answer_jitter_us = 20;
  double late_answer_ratio = 0.05;
  double late_answer_us = 200;
  double detection_delay_ns = 100;
  double snr_db = 30;
  double snr_distance_m = 5;
  bool quantised = true;
  double loss_ratio = 0.02;
  double late_stamp_ratio = 0.05;
  double late_stamp_ms = 1;
  double stamp_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(carrier_offset_hz, "Hz", 0, 1e5,
                    "standard deviation of the cards' carrier offset (default: 1 ppm)");
    RADIOSLAM_FIELD(carrier_walk_hz_per_sqrt_s, "Hz/sqrt(s)", 0, 1e4,
                    "random walk of every carrier's frequency");
    RADIOSLAM_FIELD(clock_rate_ppm, "1e-6", 0, 1000, "standard deviation of the clocks' rate errors");
    RADIOSLAM_FIELD(random_phase, "", 0, 1, "whether every exchange draws a new oscillator phase");
    RADIOSLAM_FIELD(
        sigma_chain_phase_rad, "rad", 0, 100,
        "standard deviation of the constant phase of every receive chain; 0: calibrated antennas");
    RADIOSLAM_FIELD(answer_delay_us, "us", 0, 1e4, "smallest delay from a packet to its answer");
    RADIOSLAM_FIELD(answer_jitter_us, "us", 0, 1e4, "mean additional delay of an answer");
    RADIOSLAM_FIELD(late_answer_ratio, "", 0, 1, "ratio of answers delayed by a busy channel");
    RADIOSLAM_FIELD(late_answer_us, "us", 0, 1e4, "mean additional delay of answers on a busy channel");
    RADIOSLAM_FIELD(detection_delay_ns, "ns", 0, 1600,
                    "largest detection delay of a packet; 1600: guard interval");
    RADIOSLAM_BASIC_FIELD(
        snr_db, "dB", -20, 100,
        "signal-to-noise ratio per subcarrier of an unobstructed direct path of length snr_distance_m");
    RADIOSLAM_FIELD(snr_distance_m, "m", 0.1, 1000, "path length at which snr_db holds");
    RADIOSLAM_FIELD(quantised, "", 0, 1, "whether channels are rounded to 8 bits after the automatic gain");
    RADIOSLAM_BASIC_FIELD(loss_ratio, "", 0, 1, "ratio of packets that are lost, in each direction");
    RADIOSLAM_FIELD(late_stamp_ratio, "", 0, 1, "ratio of packets that the host stamps late");
    RADIOSLAM_FIELD(late_stamp_ms, "ms", 0, 1000, "mean delay of late host stamps");
    RADIOSLAM_FIELD(stamp_offset_s, "s", 0, 10,
                    "time by which the host's stamps are ahead of the odometry's");
  }
};

/// One card's oscillator and clock over a mission.
class CsiCard {
 public:
  /// From time 0 to `end_s`; the carrier is constant after that.
  CsiCard(const CsiCardParams& params, double end_s, const Rng& rng);

  /// Frequency offset of the carrier.
  double carrier_offset_hz(double t_s) const;
  /// Integral of the offset since time 0, in turns.
  double carrier_turns(double t_s) const;
  std::uint32_t clock_us(double t_s) const;
  /// Constant phase of an antenna's receive chain.
  std::complex<double> chain_phase(std::size_t antenna) const;

 private:
  std::size_t knot_before(double t_s) const;

  std::vector<double> offset_hz_;  ///< at knots, linear in between
  std::vector<double> turns_;      ///< at the same knots
  double clock_start_us_ = 0, clock_rate_ = 1;
  std::vector<double> chain_phase_rad_;
};

/// Thermal noise power per subcarrier, where a path of amplitude 1 has power 1.
double noise_power(const CsiCardParams& params);

/// The channel with noise, after the automatic gain; antennas x subcarriers.
Eigen::MatrixXcf measured_channel(const Eigen::MatrixXcd& channel, const CsiCardParams& params, Rng rng);

}  // namespace radioslam
