#include "radioslam/radio/array_beams.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "radioslam/radio/beam_sums.hpp"

namespace radioslam {
namespace {

constexpr double kFaintest = 1e-3;  // of the strongest signal's power
constexpr std::size_t kBlock = 256;

/// The channel's strongest singular vectors: channel ~ signals * over_subcarriers.
struct Signals {
  Eigen::MatrixXcd signals;           ///< snapshots x signals, with their amplitudes
  Eigen::MatrixXcd over_subcarriers;  ///< signals x subcarriers, orthonormal rows
};

Signals strongest_signals(const Eigen::MatrixXcd& channel) {
  const Eigen::MatrixXcd gram = channel.adjoint() * channel;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> eigen(gram);
  Eigen::Index count = 0;
  const Eigen::Index most = std::min(gram.rows(), static_cast<Eigen::Index>(BeamInput::kMostSignals));
  while (count < most &&
         eigen.eigenvalues()[gram.rows() - 1 - count] >= kFaintest * eigen.eigenvalues()[gram.rows() - 1])
    ++count;
  const Eigen::MatrixXcd vectors = eigen.eigenvectors().rightCols(std::max<Eigen::Index>(count, 1));
  return {channel * vectors, vectors.adjoint()};
}

/// Power at the best delay of one beam's signals z.
struct Best {
  float power = 0;
  std::uint16_t delay = 0;
};

class DelaySearch {
 public:
  DelaySearch(const Eigen::MatrixXcd& over_subcarriers, const DelayTable& delays)
      : turns_((over_subcarriers * delays.turns()).cast<std::complex<float>>()) {}

  Best best(const std::complex<float>* z) const {
    Best result;
    const Eigen::Map<const Eigen::RowVectorXcf> beam(z, turns_.rows());
    for (Eigen::Index t = 0; t < turns_.cols(); ++t) {
      const float power = std::norm(beam.cwiseProduct(turns_.col(t).transpose()).sum());
      if (power > result.power) result = {power, static_cast<std::uint16_t>(t)};
    }
    return result;
  }

 private:
  Eigen::MatrixXcf turns_;  ///< signals x delays
};

BeamDirection direction_of(const WaveSource& source) {
  const Eigen::Vector3f u = source.direction().cast<float>();
  return {u.x(), u.y(), u.z(), static_cast<float>(source.curvature_per_m)};
}

}  // namespace

ArrayBeams array_beams(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays) {
  ArrayBeams result;
  result.power.assign(grid.size(), 0);
  result.best_delay.assign(grid.size(), 0);
  const double energy = array.channel.squaredNorm();
  if (energy == 0) return result;
  const Signals signals = strongest_signals(array.channel);
  const BeamInput input = beam_input(array.positions_m, array.wavenumber_radpm, signals.signals);
  const DelaySearch search(signals.over_subcarriers, delays);
  const BeamKernel kernel = beam_kernel();
  const auto scale = static_cast<float>(1 / (energy * static_cast<double>(array.channel.size())));
  std::vector<BeamDirection> directions(kBlock);
  std::vector<BeamSum> sums(kBlock);
  for (std::size_t begin = 0; begin < grid.size(); begin += kBlock) {
    const std::size_t count = std::min(kBlock, grid.size() - begin);
    for (std::size_t d = 0; d < count; ++d) directions[d] = direction_of(grid.source(begin + d));
    kernel(input, directions.data(), count, sums.data());
    for (std::size_t d = 0; d < count; ++d) {
      std::complex<float> z[BeamInput::kMostSignals];
      for (std::size_t r = 0; r < input.signals; ++r)
        z[r] = {sums[d].real_cos[r] - sums[d].imaginary_sin[r],
                sums[d].imaginary_cos[r] + sums[d].real_sin[r]};
      const Best best = search.best(z);
      result.power[begin + d] = best.power * scale;
      result.best_delay[begin + d] = best.delay;
    }
  }
  return result;
}

}  // namespace radioslam
