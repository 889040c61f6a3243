// Two-way channel: product of the channels measured at both ends of a link, free of the oscillators' phases.
//
// A packet and its reply are measured g seconds apart by two cards whose carriers differ by f. In the product
// h_ij h_ji the carrier phases cancel up to exp(j 2 pi f g), and the path's phase doubles. As the reply waits
// for a free channel, g jitters by tens to hundreds of microseconds: radians of phase at 10 kHz. Both cards
// count microseconds; the difference c of their counters is g plus the clocks' drift, which is removed as a
// polynomial in time fitted to a low quantile of c (quantile regression). The carrier offset f is where the
// products of successive exchanges, at almost the same position, agree best:
//   f = argmax |sum_k p_(k+1) conj(p_k) exp(-j 2 pi f (c_(k+1) - c_k))|.
// The maximum, normalised, is the coherence; replies of another robot have none. Under random phases, n phase
// differences reach a coherence c at one of M tried frequencies with probability M exp(-n c^2) (Rayleigh); an
// offset within chance is discarded. Source: product of channels as in WSR (Jadhav et al., section 4); the
// jitter is described in docs/decisions. Units: us, Hz. Cost: exchanges x offsets tried.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/mission/csi.hpp"

namespace radioslam {

// Packet detection delays: estimates and removes the linear phase slope over the subcarriers.
//
// A card detects each packet slightly early or late, which adds a delay of its own to the channel. It is
// estimated against a reference m,
//   t_k = argmax_t |sum_s h(k, s) conj(m(k, s)) exp(j 2 pi f_s t)|,
// over a table of delays with parabolic interpolation. Only the paths' relative delays remain.

/// exp(j 2 pi f_s t) for evenly spaced delays t from -max_s to max_s.
class DelayTable {
 public:
  DelayTable(const std::vector<double>& subcarrier_hz, double max_s, double step_s);

  /// subcarriers x delays
  const Eigen::MatrixXcd& turns() const { return turns_; }
  double delay_s(Eigen::Index column) const { return -max_s_ + step_s_ * static_cast<double>(column); }
  /// Delay at which |product turns()| is largest, interpolated between the columns.
  double best_delay_s(const Eigen::RowVectorXcd& product) const;

 private:
  double max_s_, step_s_;
  Eigen::MatrixXcd turns_;
};

/// Advances a row by a delay: h(s) exp(j 2 pi f_s t).
void advance(Eigen::Ref<Eigen::RowVectorXcd> row, const std::vector<double>& subcarrier_hz, double delay_s);

/// Weight of the newest row in the running mean that the next row is aligned with: an averaging time in which
/// a walking robot moves a fifth of a wavelength, at 120 packets per second.
inline constexpr double kNewestRatio = 0.15;

/// Aligns each row with an exponential mean of the rows before it, the latest with weight `newest_ratio`.
void align_to_predecessors(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                           const DelayTable& delays, double newest_ratio);

/// Aligns each row with the same row of `model`.
void align_to_model(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                    const DelayTable& delays, const Eigen::MatrixXcd& model);

// One-way channel as the square root of the two-way product.
//
// By reciprocity the product is h^2 (docs/decisions): under multipath it contains the product of every
// pair of paths, while its square root contains the paths only, up to a sign per exchange and subcarrier. As
// the channel changes little between neighbours, their relative signs are known; they are propagated along a
// maximum spanning tree of |Re(h_a conj h_b)| over the grid of exchanges and subcarriers. A deep fade may
// flip the sign of what is behind it, unless the tree leads around the fade. Cost: N log N for N exchanges x
// subcarriers.

/// h with h^2 = product, up to one global sign.
Eigen::MatrixXcd square_root_channel(const Eigen::MatrixXcd& product);

struct TwoWayParams {
  int drift_degree = 3;
  double undelayed_ratio = 0.15;
  double max_jitter_us = 1000;
  double max_offset_hz = 100e3;  ///< 20 ppm at 5 GHz
  double max_pause_s = 0.02;
  double min_coherence = 0.3;  ///< 21 recorded links: 0.90-0.96; replies of another robot: 0.05-0.09
  int centre_subcarriers = 4;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(drift_degree, "", 0, 10,
                    "degree of the polynomial in time that models the drift between the two cards' clocks");
    RADIOSLAM_FIELD(
        undelayed_ratio, "", 0.01, 0.99,
        "fraction of the replies below the fitted clock drift, i.e. sent without waiting for a free channel");
    RADIOSLAM_FIELD(max_jitter_us, "us", 1, 1e6,
                    "largest deviation of a reply from the fitted clock drift; later replies belong to "
                    "another transmission attempt");
    RADIOSLAM_FIELD(max_offset_hz, "Hz", 100, 1e6, "largest carrier frequency offset searched");
    RADIOSLAM_FIELD(
        max_pause_s, "s", 1e-4, 10,
        "largest pause between exchanges whose phases are compared; at least 1.5 times the median pause");
    RADIOSLAM_FIELD(min_coherence, "", 0, 1,
                    "smallest phase coherence at which replies are accepted; lower values admit replies to "
                    "another robot");
    RADIOSLAM_FIELD(centre_subcarriers, "", 1, 1000,
                    "number of subcarriers around the carrier whose mean phase is compared");
  }
};

struct TwoWayChannel {
  std::vector<Stamp> stamps;        ///< of the packets at the receiver, increasing
  Eigen::MatrixXcd product;         ///< exchanges x subcarriers, jitter removed
  double frequency_offset_hz = 0;   ///< 0 where the exchanges do not determine it
  std::optional<double> coherence;  ///< of successive exchanges, 0 to 1; absent with too few exchanges
  double coherence_before = 0;      ///< coherence without removing the jitter
  std::size_t paired = 0;           ///< exchanges with packet and reply
  std::size_t rejected = 0;         ///< paired exchanges rejected for their jitter
};

enum class TwoWayFailure {
  kTooFewExchanges,   ///< fewer than three remain
  kOtherSubcarriers,  ///< the two ends measured different subcarriers
  kIncoherent         ///< phases do not agree: replies to another robot, or exchanges too far apart
};

struct TwoWayResult {
  std::optional<TwoWayChannel> channel;
  TwoWayFailure reason = TwoWayFailure::kTooFewExchanges;  ///< valid where there is no channel
};

/// Pairs the packets that `receiver` received from `sender` with the sender's captured replies by counter;
/// antenna 0, stream 0. Counters that occur twice in a capture are skipped. From a hundred exchanges on,
/// coherence is required: `min_coherence` if they are closer than max_pause_s, otherwise significance at the
/// 1 % level.
TwoWayResult two_way_channel(const CsiCapture& receiver, MacAddress sender, const CsiCapture& answers,
                             const TwoWayParams& params);

}  // namespace radioslam
