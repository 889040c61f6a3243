#include "radioslam/radio/channel/subcarrier_slopes.hpp"

#include <cmath>
#include <complex>
#include <numbers>

#include "radioslam/base/parabola.hpp"

namespace radioslam {

DelayTable::DelayTable(const std::vector<double>& subcarrier_hz, double max_s, double step_s)
    : max_s_(max_s),
      step_s_(step_s),
      turns_(static_cast<Eigen::Index>(subcarrier_hz.size()),
             2 * static_cast<Eigen::Index>(std::ceil(max_s / step_s)) + 1) {
  for (Eigen::Index s = 0; s < turns_.rows(); ++s)
    for (Eigen::Index t = 0; t < turns_.cols(); ++t)
      turns_(s, t) =
          std::polar(1.0, 2 * std::numbers::pi * subcarrier_hz[static_cast<std::size_t>(s)] * delay_s(t));
}

double DelayTable::best_delay_s(const Eigen::RowVectorXcd& product) const {
  const Eigen::RowVectorXd size = (product * turns_).cwiseAbs();
  Eigen::Index best = 0;
  size.maxCoeff(&best);
  if (best == 0 || best + 1 == size.cols()) return delay_s(best);
  return delay_s(best) + step_s_ * parabola_peak(size[best - 1], size[best], size[best + 1]);
}

void advance(Eigen::Ref<Eigen::RowVectorXcd> row, const std::vector<double>& subcarrier_hz, double delay_s) {
  for (Eigen::Index s = 0; s < row.size(); ++s)
    row[s] *= std::polar(1.0, 2 * std::numbers::pi * subcarrier_hz[static_cast<std::size_t>(s)] * delay_s);
}

namespace {

void align_row(Eigen::MatrixXcd& channel, Eigen::Index k, const Eigen::RowVectorXcd& reference,
               const std::vector<double>& subcarrier_hz, const DelayTable& delays) {
  Eigen::RowVectorXcd row = channel.row(k);
  advance(row, subcarrier_hz, delays.best_delay_s(row.cwiseProduct(reference.conjugate())));
  channel.row(k) = row;
}

}  // namespace

void align_to_predecessors(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                           const DelayTable& delays, double newest_ratio) {
  Eigen::RowVectorXcd reference = Eigen::RowVectorXcd::Ones(channel.cols());
  for (Eigen::Index k = 0; k < channel.rows(); ++k) {
    align_row(channel, k, reference, subcarrier_hz, delays);
    const double size = channel.row(k).cwiseAbs().mean();
    if (size == 0) continue;
    const Eigen::RowVectorXcd unit = channel.row(k) / size;
    reference = k == 0 ? unit : Eigen::RowVectorXcd((1 - newest_ratio) * reference + newest_ratio * unit);
  }
}

void align_to_model(Eigen::MatrixXcd& channel, const std::vector<double>& subcarrier_hz,
                    const DelayTable& delays, const Eigen::MatrixXcd& model) {
  for (Eigen::Index k = 0; k < channel.rows(); ++k)
    align_row(channel, k, model.row(k), subcarrier_hz, delays);
}

}  // namespace radioslam
