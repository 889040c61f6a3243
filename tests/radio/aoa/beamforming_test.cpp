#include "radioslam/radio/aoa/beamforming.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>

#include "radio/aoa/waves.hpp"
#include "radioslam/radio/aoa/delay_alignment.hpp"

namespace radioslam {
namespace {

using namespace waves;

WaveGrid small_grid() {
  WaveGrid grid;
  grid.azimuths = 180;
  grid.elevations_rad = {0, 0.3};
  grid.curvatures_per_m = {0, 0.4};
  return grid;
}

/// P of one source computed over all subcarriers, and its best delay.
struct Direct {
  double power = 0;
  Eigen::Index delay = 0;
};

Direct direct_power(const SyntheticArray& array, const WaveSource& source, const DelayTable& delays) {
  Eigen::RowVectorXcd beam = Eigen::RowVectorXcd::Zero(array.channel.cols());
  for (Eigen::Index k = 0; k < array.channel.rows(); ++k)
    beam += array.channel.row(k) *
            std::polar(1.0, array.wavenumber_radpm * further_m(source, array.positions_m.col(k)));
  Direct best;
  for (Eigen::Index t = 0; t < delays.turns().cols(); ++t) {
    std::complex<double> z = 0;
    for (Eigen::Index s = 0; s < beam.size(); ++s)
      z += beam[s] * std::polar(1.0, 2 * std::numbers::pi * array.subcarrier_hz[static_cast<std::size_t>(s)] *
                                         delays.delay_s(t));
    const double power =
        std::norm(z) / (static_cast<double>(array.channel.size()) * array.channel.squaredNorm());
    if (power > best.power) best = {power, t};
  }
  return best;
}

TEST(ArrayBeams, OfAWaveAreOneAtItsSourceAndLessElsewhere) {
  const WaveGrid grid = small_grid();
  const DelayTable delays = delay_table(subcarriers());
  for (const std::size_t own : {37U, 250U, 415U, 700U})
    for (const Eigen::Index column : {4, 20, 33}) {
      const SyntheticArray array =
          array_of({{grid.source(own), delays.delay_s(column), {0.3, -0.4}}}, arc(90, 0.5, 2.5));
      const ArrayBeams beams = array_beams(array, grid, delays);
      ASSERT_EQ(beams.power.size(), grid.size());
      EXPECT_NEAR(static_cast<double>(beams.power[own]), 1, 1e-3);
      EXPECT_EQ(beams.best_delay[own], column);
      for (std::size_t k = 0; k < grid.size(); ++k) {
        if (k == own) continue;
        EXPECT_LT(beams.power[k], 0.98) << own << ' ' << k;
        EXPECT_GE(beams.power[k], 0);
      }
    }
}

/// Fraction of the power in singular values after the eighth or below a thousandth of the first.
double share_left_out(const Eigen::MatrixXcd& channel) {
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXcd>(channel).singularValues().cwiseAbs2();
  double left = 0;
  for (Eigen::Index k = 0; k < values.size(); ++k)
    if (k >= 8 || values[k] < 1e-3 * values[0]) left += values[k];
  return left / values.sum();
}

TEST(ArrayBeams, AreThoseOfAllSubcarriers) {
  const WaveGrid grid = small_grid();
  const DelayTable delays = delay_table(subcarriers());
  Rng rng(5);
  for (int trial = 0; trial < 4; ++trial) {
    std::vector<Wave> few;
    for (int k = 0; k < 3; ++k)
      few.push_back({{rng.uniform(-3, 3), rng.uniform(0, 0.3), k == 0 ? 0.4 : 0},
                     rng.uniform(-5e-8, 5e-8),
                     std::polar(rng.uniform(0.3, 1), rng.uniform(-3, 3))});
    const SyntheticArray array = array_of(few, arc(60, 0.4, 2));
    const double left = std::sqrt(share_left_out(array.channel));
    const ArrayBeams beams = array_beams(array, grid, delays);
    for (std::size_t k = 0; k < grid.size(); k += 7) {
      const Direct direct = direct_power(array, grid.source(k), delays);
      EXPECT_NEAR(static_cast<double>(beams.power[k]), direct.power, 1e-3) << k;
      EXPECT_LT(std::abs(std::sqrt(static_cast<double>(beams.power[k])) - std::sqrt(direct.power)),
                left + 1e-4)
          << k;
      if (direct.power > 0.1) {
        EXPECT_LE(std::abs(Eigen::Index{beams.best_delay[k]} - direct.delay), 1) << k;
      }
    }
  }
}

TEST(ArrayBeams, LoseNoMoreByTheirRankThanThePowerLeftOut) {
  const WaveGrid grid = small_grid();
  const DelayTable delays = delay_table(subcarriers());
  Rng rng(6);
  SyntheticArray array = array_of({{{1, 0, 0}, 0, 1}, {{-2, 0, 0}, 6e-8, 0.7}}, arc(60, 0.4, 2));
  array.channel += noise(array.channel.rows(), array.channel.cols(), 0.5, rng);
  const double left = share_left_out(array.channel);
  ASSERT_GT(left, 0.02) << "or the test shows nothing";
  const ArrayBeams beams = array_beams(array, grid, delays);
  for (std::size_t k = 0; k < grid.size(); k += 3) {
    const double direct = direct_power(array, grid.source(k), delays).power;
    EXPECT_LT(std::abs(std::sqrt(static_cast<double>(beams.power[k])) - std::sqrt(direct)), std::sqrt(left))
        << k;
    EXPECT_NEAR(static_cast<double>(beams.power[k]), direct, 0.02) << "noise has no direction";
  }
}

TEST(ArrayBeams, OfAChannelOfZerosAreZero) {
  SyntheticArray array = array_of({}, arc(20, 0.4, 2));
  const ArrayBeams beams = array_beams(array, small_grid(), delay_table(array.subcarrier_hz));
  for (const float power : beams.power) EXPECT_EQ(power, 0);
}

}  // namespace
}  // namespace radioslam
