// The channel between two cards from packets both ways, free of what their oscillators add.
//
// A packet and its answer are measured by two cards whose carriers differ by f, seconds g apart. In the
// product h_ij h_ji of the two channels the carriers' offsets cancel but for exp(j 2 pi f g), and the path's
// phase doubles. The answer waits for the air to be free, so g jitters by tens to hundreds of microseconds,
// which at 10 kHz turns the phase by radians. Both cards count microseconds: the difference c of their
// counters is g plus what the clocks drift apart, which is smooth and taken off as a polynomial in time
// that a given share of the answers lies below (quantile regression). And f is where the products of
// successive exchanges, taken at two places hardly apart, agree best:
//   f = argmax |sum_k p_(k+1) conj(p_k) exp(-j 2 pi f (c_(k+1) - c_k))|.
// The largest sum, over the exchanges, is the coherence: another robot's packets have none. Of phases at
// random n turns give M tried frequencies a coherence of c or more with a chance of M exp(-n c^2) (Rayleigh):
// what chance explains is no frequency. Source: the product of channels as in WSR (Jadhav et al., section 4);
// the jitter is ours. Units: us, Hz. Cost: exchanges x offsets tried.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

struct TwoWayParams {
  int drift_degree = 3;           ///< of the clocks' drift, over the ten seconds of a capture
  double undelayed_share = 0.15;  ///< of the answers lies below that polynomial
  double most_jitter_us = 1000;   ///< an answer further off is to another attempt of the packet
  double most_offset_hz = 100e3;  ///< of the carriers, as far as the cards leave it: 20 ppm at 5 GHz
  double longest_pause_s = 0.02;  ///< successive exchanges are nearer than this, or one and a half usual ones
  double least_coherence = 0.3;   ///< 21 recorded links have 0.90-0.96, answers of another end 0.05-0.09
  int centre_subcarriers = 4;     ///< whose mean phase is compared

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"drift_degree", "", 0, 10, "of the polynomial in time that the clocks drift apart by"},
          self.drift_degree);
    visit(Field{"undelayed_share", "", 0.01, 0.99, "of the answers lies below that polynomial"},
          self.undelayed_share);
    visit(Field{"most_jitter_us", "us", 1, 1e6, "answers further from their usual time are left out"},
          self.most_jitter_us);
    visit(Field{"most_offset_hz", "Hz", 100, 1e6, "largest difference of the carriers"}, self.most_offset_hz);
    visit(Field{"longest_pause_s", "s", 1e-4, 10,
                "successive exchanges are nearer than this, or than 1.5 times the usual pause"},
          self.longest_pause_s);
    visit(Field{"least_coherence", "", 0, 1, "answers whose phases agree less are another end's"},
          self.least_coherence);
    visit(Field{"centre_subcarriers", "", 1, 1000, "subcarriers whose mean phase is compared"},
          self.centre_subcarriers);
  }
};

struct TwoWayChannel {
  std::vector<Stamp> stamps;        ///< of the receiver's half of every exchange, increasing
  Eigen::MatrixXcd product;         ///< exchanges x subcarriers, the jitter undone
  double frequency_offset_hz = 0;   ///< 0 where the exchanges do not tell it
  std::optional<double> coherence;  ///< of successive exchanges, 0 to 1; absent where too few tell
  double coherence_before = 0;      ///< the same with the jitter in it
  std::size_t paired = 0;           ///< exchanges with both halves
  std::size_t late = 0;             ///< of them, left out for their jitter
};

enum class NoTwoWay {
  kTooFewExchanges,   ///< fewer than three are left
  kOtherSubcarriers,  ///< the two ends measured different ones
  kIncoherent         ///< of enough exchanges the phases do not agree: another end's, or too far apart
};

struct TwoWayResult {
  std::optional<TwoWayChannel> channel;
  NoTwoWay reason = NoTwoWay::kTooFewExchanges;  ///< where there is none
};

/// Pairs the packets that `receiver` heard from `sender` with those that the sender heard back, by counter;
/// antenna 0, stream 0. Counters that a capture has twice are left out. Coherence is asked for where a
/// hundred exchanges tell it: `least_coherence` where they are nearer than longest_pause_s, else more than
/// chance gives once in a hundred times.
TwoWayResult two_way_channel(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers,
                             const TwoWayParams& params);

}  // namespace radioslam
