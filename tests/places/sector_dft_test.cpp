#include "radioslam/places/sector_dft.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "places/random_grids.hpp"

namespace radioslam {
namespace {

using test::random_bins;

constexpr double kTurn = 2 * std::numbers::pi;

double correlation_at(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b, int shift) {
  double sum = 0;
  for (Eigen::Index j = 0; j < a.cols(); ++j)
    sum += static_cast<double>(a.col((j + shift) % a.cols()).dot(b.col(j)));
  return sum;
}

TEST(SectorDft, CorrelatesLikeTheSumsForAnyNumberOfSectors) {
  Rng rng(1);
  for (int sectors = 1; sectors <= kMaxSectors; ++sectors) {
    const SectorDft& dft = SectorDft::complete(sectors);
    const Eigen::MatrixXf a = random_bins(5, sectors, 0.3, 0.1, rng),
                          b = random_bins(5, sectors, 0.3, 0.1, rng);
    const auto found = dft.correlation(dft.spectra_of_rows(a), dft.spectra_of_rows(b));
    ASSERT_EQ(found.size(), sectors);
    const double scale = 1 + static_cast<double>(a.norm() * b.norm());
    for (int s = 0; s < sectors; ++s)
      EXPECT_NEAR(static_cast<double>(found[s]), correlation_at(a, b, s), 1e-5 * scale)
          << sectors << " " << s;
  }
}

TEST(SectorDft, CorrelatesWavesAtShiftsBetweenSectors) {
  // Waves below the highest frequency: smoothing leaves them, and their correlation is known at any angle.
  constexpr int kSectors = 60, kWave = 3, kShifts = 32;
  Eigen::MatrixXf a(1, kSectors), b(1, kSectors);
  for (int j = 0; j < kSectors; ++j) {
    b(0, j) = static_cast<float>(std::cos(kTurn * kWave * j / kSectors));
    a(0, j) = static_cast<float>(std::cos(kTurn * kWave * j / kSectors - 0.7));
  }
  const SectorDft dft(kSectors, 16, kShifts);
  const auto found = dft.correlation(dft.spectra_of_rows(a), dft.spectra_of_rows(b));
  ASSERT_EQ(found.size(), kShifts);
  for (int m = 0; m < kShifts; ++m)
    EXPECT_NEAR(static_cast<double>(found[m]), kSectors / 2.0 * std::cos(kTurn * kWave * m / kShifts - 0.7),
                1e-4);
}

}  // namespace
}  // namespace radioslam
