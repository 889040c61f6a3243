#include "radioslam/places/context_keys.hpp"

#include <gtest/gtest.h>

#include "places/random_grids.hpp"

namespace radioslam {
namespace {

using namespace test;

TEST(ContextKeys, DoNotDependOnTheHeading) {
  Rng rng(1);
  for (const int rings : {3, 10, 20, 64}) {
    const Eigen::MatrixXf bins = random_bins(rings, 60, 0.4, 0.1, rng);
    const ScanContext context(bins, 0.25);
    for (const int shift : {1, 17, 45}) {
      const ScanContext other(shifted(bins, shift), 0.25);
      EXPECT_TRUE(ring_key(other).isApprox(ring_key(context), 1e-6F));
      EXPECT_TRUE(spectral_key(other).isApprox(spectral_key(context), 1e-4F));
    }
  }
}

TEST(ContextKeys, OfTheRingsAreRatiosOfOccupiedBins) {
  Eigen::MatrixXf bins = Eigen::MatrixXf::Zero(3, 60);
  bins.row(1).head(15).setConstant(2);
  bins.row(2).setConstant(0.1F);
  EXPECT_TRUE(ring_key(ScanContext(bins, 0.25)).isApprox(Eigen::Vector3f(0, 0.25F, 1)));
}

TEST(ContextKeys, OfTheSpectraHaveUnitNormOrAreZero) {
  Rng rng(2);
  const Eigen::VectorXf key = spectral_key(random_context(20, 60, 0.1, rng));
  EXPECT_EQ(key.size(), kSpectralKeySize);
  EXPECT_LE(key.size(), 128);
  EXPECT_NEAR(static_cast<double>(key.norm()), 1, 1e-5);
  EXPECT_TRUE(spectral_key(ScanContext(Eigen::MatrixXf::Zero(20, 60), 0.25)).isZero(0));
}

TEST(ContextKeys, OfTheSpectraDistinguishBandsTurnedAgainstEachOther) {
  // Magnitudes do not: the two grids differ in the azimuth of the outer rings relative to the inner ones.
  Rng rng(3);
  Eigen::MatrixXf bins = random_bins(20, 60, 0.4, 0, rng), other = bins;
  other.bottomRows(10) = shifted(bins.bottomRows(10), 20);
  const Eigen::VectorXf key = spectral_key(ScanContext(bins, 0.25));
  EXPECT_GT(static_cast<double>((key - spectral_key(ScanContext(other, 0.25))).norm()), 0.05);
}

TEST(BandSpectra, AddUpTheRingsOfABand) {
  Rng rng(4);
  const ScanContext context = random_context(64, 60, 0.1, rng);
  const Eigen::MatrixXf bands = band_spectra(context, 20, 16);
  ASSERT_EQ(bands.rows(), 32);
  ASSERT_EQ(bands.cols(), 20);
  const Eigen::Index stride = context.spectra().rows() / 2;
  EXPECT_TRUE(
      bands.topRows(16).rowwise().sum().isApprox(context.spectra().topRows(16).rowwise().sum(), 1e-4F));
  EXPECT_TRUE(bands.bottomRows(16).rowwise().sum().isApprox(
      context.spectra().middleRows(stride, 16).rowwise().sum(), 1e-4F));
  const Eigen::MatrixXf few = band_spectra(random_context(3, 8, 0, rng), 20, 16);
  EXPECT_TRUE(few.rightCols(17).isZero(0));
}

}  // namespace
}  // namespace radioslam
