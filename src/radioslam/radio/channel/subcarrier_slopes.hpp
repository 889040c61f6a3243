// Packet detection delays: estimates and removes the linear phase slope over the subcarriers.
//
// A card detects each packet slightly early or late, which adds a delay of its own to the channel. It is
// estimated against a reference m,
//   t_k = argmax_t |sum_s h(k, s) conj(m(k, s)) exp(j 2 pi f_s t)|,
// over a table of delays with parabolic interpolation. Only the paths' relative delays remain.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace radioslam {

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

}  // namespace radioslam
