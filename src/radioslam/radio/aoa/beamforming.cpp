#include "radioslam/radio/aoa/beamforming.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/aoa/steering_sums.hpp"

namespace radioslam {
namespace {

constexpr double kMinSignalRatio = 1e-3;  // to the strongest signal's power

/// The channel's strongest singular vectors: channel ~ signals * over_subcarriers.
struct Signals {
  Eigen::MatrixXcd signals;           ///< snapshots x signals, with their amplitudes
  Eigen::MatrixXcd over_subcarriers;  ///< signals x subcarriers, orthonormal rows
};

Signals strongest_signals(const Eigen::MatrixXcd& channel) {
  const Eigen::MatrixXcd gram = channel.adjoint() * channel;
  const auto eigen = symmetric_eigen(gram);
  Eigen::Index count = 0;
  const Eigen::Index most = std::min(gram.rows(), static_cast<Eigen::Index>(BeamInput::kMaxSignals));
  while (count < most &&
         eigen.values[gram.rows() - 1 - count] >= kMinSignalRatio * eigen.values[gram.rows() - 1])
    ++count;
  const Eigen::MatrixXcd vectors = eigen.vectors.rightCols(std::max<Eigen::Index>(count, 1));
  return {channel * vectors, vectors.adjoint()};
}

/// Best delay of one beam, and the power there.
struct Best {
  float power = 0;
  std::uint16_t delay = 0;
};

/// Search over all delays, four at a time in the compiler's vectors.
class DelaySearch {
 public:
  DelaySearch(const Eigen::MatrixXcd& over_subcarriers, const DelayTable& delays)
      : signals_(static_cast<std::size_t>(over_subcarriers.rows())),
        fours_((static_cast<std::size_t>(delays.turns().cols()) + 3) / 4),
        turns_(2 * signals_ * fours_, Four{}) {
    const Eigen::MatrixXcd turns = over_subcarriers * delays.turns();
    for (Eigen::Index r = 0; r < turns.rows(); ++r)
      for (Eigen::Index t = 0; t < turns.cols(); ++t) {
        Four* four = &turns_[2 * (static_cast<std::size_t>(t / 4) * signals_ + static_cast<std::size_t>(r))];
        four[0][t % 4] = static_cast<float>(turns(r, t).real());
        four[1][t % 4] = static_cast<float>(turns(r, t).imag());
      }
  }

  Best best(const BeamSum& beam) const {
    std::array<Four, BeamInput::kMaxSignals> a, b;
    for (std::size_t r = 0; r < signals_; ++r) {
      a[r] = all(beam.z[r].real());
      b[r] = all(beam.z[r].imag());
    }
    Four most = all(-1);
    Ints where{};
    const Four* turn = turns_.data();
    for (std::size_t t = 0; t < fours_; ++t) {
      Four re{}, im{};
      for (std::size_t r = 0; r < signals_; ++r, turn += 2) {
        re += a[r] * turn[0] - b[r] * turn[1];
        im += a[r] * turn[1] + b[r] * turn[0];
      }
      const Four power = re * re + im * im;
      const Ints is_more = power > most;
      const auto now = static_cast<int>(t);
      most = reinterpret_cast<Four>((is_more & reinterpret_cast<Ints>(power)) |
                                    (~is_more & reinterpret_cast<Ints>(most)));
      where = (is_more & Ints{now, now, now, now}) | (~is_more & where);
    }
    int best = 0;
    const auto delay_of = [&](int lane) { return 4 * where[lane] + lane; };
    for (int lane = 1; lane < 4; ++lane)
      if (most[lane] > most[best] || (most[lane] == most[best] && delay_of(lane) < delay_of(best)))
        best = lane;
    return {most[best], static_cast<std::uint16_t>(delay_of(best))};
  }

 private:
  using Four = float __attribute__((vector_size(16)));
  using Ints = int __attribute__((vector_size(16)));

  static Four all(float x) { return Four{x, x, x, x}; }

  std::size_t signals_, fours_;
  std::vector<Four> turns_;  ///< per four delays: real and imaginary part of every signal
};

/// Profile of one channel, row by row of a grid.
class Profile {
 public:
  Profile(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays)
      : array_(array),
        grid_(grid),
        signals_(strongest_signals(array.channel)),
        input_(beam_input(array.positions_m, array.wavenumber_radpm, signals_.signals)),
        search_(signals_.over_subcarriers, delays),
        scale_(static_cast<float>(1 /
                                  (array.channel.squaredNorm() * static_cast<double>(array.channel.size())))),
        is_level_(array.positions_m.row(2).isZero(0)),
        level_(around()),
        directions_(around()),
        sums_(around()),
        opposite_sums_(around() / 2) {
    for (std::size_t d = 0; d < around(); ++d)
      level_[d] = WaveSource{grid.azimuth_rad(static_cast<int>(d)), 0, 0}.direction();
  }

  void fill_row(std::size_t row, ArrayBeams& result) {
    const std::size_t begin = row * around();
    const WaveSource first = grid_.source(begin);
    point(first);
    if (first.curvature_per_m == 0 && around() % 2 == 0) {
      sum_opposite(first.elevation_rad);
      for (std::size_t d = 0; d < around() / 2; ++d) {
        store(opposite_sums_[d].ahead, begin + d, result);
        store(opposite_sums_[d].behind, begin + d + around() / 2, result);
      }
    } else {
      kernel_(input_, directions_.data(), around(), sums_.data());
      for (std::size_t d = 0; d < around(); ++d) store(sums_[d], begin + d, result);
    }
  }

 private:
  std::size_t around() const { return static_cast<std::size_t>(grid_.azimuths); }

  /// Sets the directions of all azimuths at one source's elevation and curvature.
  void point(const WaveSource& source) {
    const double level = std::cos(source.elevation_rad);
    const auto z = static_cast<float>(std::sin(source.elevation_rad));
    const auto curvature = static_cast<float>(source.curvature_per_m);
    for (std::size_t d = 0; d < around(); ++d) {
      const Eigen::Vector3f u = (level * level_[d]).cast<float>();
      directions_[d] = {u.x(), u.y(), z, curvature};
    }
  }

  /// Plane waves of one elevation: the phases of the heights do not depend on azimuth, so with these moved
  /// into the signals, azimuths half a turn apart have conjugate steering vectors.
  void sum_opposite(double elevation_rad) {
    const std::size_t half = around() / 2;
    if (is_level_) {
      opposite_kernel_(input_, directions_.data(), half, opposite_sums_.data());
      return;
    }
    const double turn_radpm = -array_.wavenumber_radpm * std::sin(elevation_rad);
    Eigen::MatrixXcd raised = signals_.signals;
    for (Eigen::Index k = 0; k < raised.rows(); ++k)
      raised.row(k) *= std::polar(1.0, turn_radpm * array_.positions_m(2, k));
    for (BeamDirection& direction : directions_) direction.z = 0;
    const BeamInput input = beam_input(array_.positions_m, array_.wavenumber_radpm, raised);
    opposite_kernel_(input, directions_.data(), half, opposite_sums_.data());
  }

  void store(const BeamSum& sum, std::size_t at, ArrayBeams& result) {
    const Best best = search_.best(sum);
    result.power[at] = best.power * scale_;
    result.best_delay[at] = best.delay;
  }

  const SyntheticArray& array_;
  const WaveGrid& grid_;
  Signals signals_;
  BeamInput input_;
  DelaySearch search_;
  float scale_;
  bool is_level_;
  BeamKernel kernel_ = beam_kernel();
  OppositeBeamKernel opposite_kernel_ = opposite_beam_kernel();
  std::vector<Eigen::Vector3d> level_;     ///< directions at elevation 0
  std::vector<BeamDirection> directions_;  ///< of one row, as the sums
  std::vector<BeamSum> sums_;
  std::vector<OppositeBeamSums> opposite_sums_;
};

}  // namespace

ArrayBeams array_beams(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays) {
  ArrayBeams result;
  result.power.assign(grid.size(), 0);
  result.best_delay.assign(grid.size(), 0);
  if (array.channel.squaredNorm() == 0) return result;
  Profile profile(array, grid, delays);
  for (std::size_t row = 0; row < grid.elevations_rad.size() * grid.curvatures_per_m.size(); ++row)
    profile.fill_row(row, result);
  return result;
}

}  // namespace radioslam
