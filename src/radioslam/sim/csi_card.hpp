// What a WiFi card adds to the channel: its oscillator, its clock, and how it measures.
//
// Two cards' carriers differ, by a constant and a random walk; the phase that this puts on a packet is of one
// sign where one card hears the other, and of the other sign where it is heard. Each card counts microseconds
// of its own. It notices a packet a little late, which slopes the phase over the subcarriers, and writes down
// eight bits per number after an automatic gain.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"

namespace radioslam {

/// Everything that is not the room. Field names are unique among all of a scenario's.
struct CsiCardParams {
  double carrier_offset_hz = 5000;
  double carrier_walk_hz_per_sqrt_s = 20;
  double clock_rate_ppm = 10;
  bool random_phase = true;
  double sigma_chain_phase_rad = 0;
  double answer_delay_us = 300;
  double answer_jitter_us = 20;
  double late_answer_share = 0.05;
  double late_answer_us = 200;
  double detection_delay_ns = 100;
  double snr_db = 30;
  double snr_distance_m = 5;
  bool quantised = true;
  double loss_share = 0.02;
  double late_stamp_share = 0.05;
  double late_stamp_ms = 1;
  double stamp_offset_s = 0;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"carrier_offset_hz", "Hz", 0, 1e5, "standard deviation of the cards' carriers; 1 ppm"},
          self.carrier_offset_hz);
    visit(Field{"carrier_walk_hz_per_sqrt_s", "Hz/sqrt(s)", 0, 1e4, "random walk of every carrier"},
          self.carrier_walk_hz_per_sqrt_s);
    visit(Field{"clock_rate_ppm", "1e-6", 0, 1000, "standard deviation of the clocks' rates"},
          self.clock_rate_ppm);
    visit(Field{"random_phase", "", 0, 1, "whether the oscillators' phase is a new one at every exchange"},
          self.random_phase);
    visit(Field{"sigma_chain_phase_rad", "rad", 0, 100,
                "constant phase of every receive chain; 0: calibrated antennas"},
          self.sigma_chain_phase_rad);
    visit(Field{"answer_delay_us", "us", 0, 1e4, "from a packet to its answer, at least"},
          self.answer_delay_us);
    visit(Field{"answer_jitter_us", "us", 0, 1e4, "mean of what the answer waits beyond that"},
          self.answer_jitter_us);
    visit(Field{"late_answer_share", "", 0, 1, "share of the answers that the air keeps waiting"},
          self.late_answer_share);
    visit(Field{"late_answer_us", "us", 0, 1e4, "mean of what these wait on top"}, self.late_answer_us);
    visit(Field{"detection_delay_ns", "ns", 0, 1600, "a packet is noticed up to this late; 1600: guard time"},
          self.detection_delay_ns);
    visit(Field{"snr_db", "dB", -20, 100, "signal to noise per subcarrier of a straight path of"},
          self.snr_db);
    visit(Field{"snr_distance_m", "m", 0.1, 1000, "this length, unobstructed"}, self.snr_distance_m);
    visit(Field{"quantised", "", 0, 1, "whether numbers are rounded to 8 bits after the automatic gain"},
          self.quantised);
    visit(Field{"loss_share", "", 0, 1, "share of the packets without a record, each way"}, self.loss_share);
    visit(Field{"late_stamp_share", "", 0, 1, "share of the packets that the host stamps late"},
          self.late_stamp_share);
    visit(Field{"late_stamp_ms", "ms", 0, 1000, "mean of how late"}, self.late_stamp_ms);
    visit(Field{"stamp_offset_s", "s", 0, 10, "the host's stamps are this much ahead of the odometry's"},
          self.stamp_offset_s);
  }
};

/// One card's oscillator and clock over a mission.
class CsiCard {
 public:
  /// From time 0 to `end_s`; behind that the carrier stays as it is.
  CsiCard(const CsiCardParams& params, double end_s, const Rng& rng);

  /// How far the carrier is off.
  double carrier_offset_hz(double t_s) const;
  /// What that adds up to since time 0, in turns.
  double carrier_turns(double t_s) const;
  std::uint32_t clock_us(double t_s) const;
  /// What the receive chain of an antenna puts on its channel.
  std::complex<double> chain_phase(std::size_t antenna) const;

 private:
  std::size_t knot_before(double t_s) const;

  std::vector<double> offset_hz_;  ///< at knots, linear in between
  std::vector<double> turns_;      ///< at the same knots
  double clock_start_us_ = 0, clock_rate_ = 1;
  std::vector<double> chain_phase_rad_;
};

/// Power of the thermal noise per subcarrier, where a path of amplitude 1 has power 1.
double noise_power(const CsiCardParams& params);

/// The channel with noise and after the automatic gain; antennas x subcarriers.
Eigen::MatrixXcf measured_channel(const Eigen::MatrixXcd& channel, const CsiCardParams& params, Rng rng);

}  // namespace radioslam
