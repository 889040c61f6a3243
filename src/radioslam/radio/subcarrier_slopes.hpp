// A card notices a packet a little early or late, anew each time: a delay, which turns the channel's phase
// linearly over the subcarriers. It is taken off against a reference,
//   t_k = argmax_t |sum_s h(k, s) conj(m(k, s)) exp(j 2 pi f_s t)|,
// by a table of delays and a parabola between its entries. Only differences of the paths' delays are left.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace radioslam {

/// exp(j 2 pi f_s t) for evenly spaced delays t from -most to most.
class DelayTable {
 public:
  DelayTable(const std::vector<double>& subcarrier_hz, double most_s, double step_s);

  /// subcarriers x delays
  const Eigen::MatrixXcd& turns() const { return turns_; }
  double delay_s(Eigen::Index column) const { return -most_s_ + step_s_ * static_cast<double>(column); }
  /// Where |product turns()| is largest, refined between the columns.
  double best_delay_s(const Eigen::RowVectorXcd& product) const;

 private:
  double most_s_, step_s_;
  Eigen::MatrixXcd turns_;
};

/// Every row with a delay added to its phase: h(s) exp(j 2 pi f_s t).
void advance(Eigen::Ref<Eigen::RowVectorXcd> row, const std::vector<double>& subcarrier_hz, double delay_s);

/// Of the newest row in the mean that the next one is aligned with: as long as a walk of a wavelength's fifth
/// at 120 packets a second.
inline constexpr double kNewestShare = 0.15;

/// Aligns each row with a mean of the rows before it, of which the latest counts `newest_share`.
void align_to_predecessors(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                           const DelayTable& delays, double newest_share);

/// Aligns each row with the same row of `model`.
void align_to_model(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                    const DelayTable& delays, const Eigen::MatrixXcd& model);

}  // namespace radioslam
