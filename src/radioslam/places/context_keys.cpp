#include "radioslam/places/context_keys.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace radioslam {

Eigen::VectorXf ring_key(const ScanContext& context) {
  return (context.bins().array() > 0).cast<float>().rowwise().mean();
}

Eigen::MatrixXf band_spectra(const ScanContext& context, int bands, int frequencies) {
  const Eigen::MatrixXf spectra = context.spectra();
  const Eigen::Index stride = spectra.rows() / 2, count = std::min<Eigen::Index>(frequencies, stride);
  Eigen::MatrixXf result = Eigen::MatrixXf::Zero(Eigen::Index{2} * frequencies, bands);
  for (int ring = 0; ring < context.rings(); ++ring) {
    const int band = context.rings() < bands ? ring : ring * bands / context.rings();
    const auto spectrum = spectra.col(ring);
    result.col(band).head(count) += spectrum.head(count);
    result.col(band).segment(frequencies, count) += spectrum.segment(stride, count);
  }
  return result;
}

Eigen::VectorXf spectral_key(const ScanContext& context) {
  using Complex = std::complex<float>;
  const Eigen::MatrixXf bands = band_spectra(context, kSpectralKeyBands, kSpectralKeyFrequencies);
  Eigen::VectorXf key = Eigen::VectorXf::Zero(kSpectralKeySize);
  Eigen::Index at = 0;
  for (int f = 0; f < kSpectralKeyFrequencies; ++f) {
    const auto value = [&](int band) {
      return Complex(bands(f, band), bands(f + kSpectralKeyFrequencies, band));
    };
    for (int band = 0; band < kSpectralKeyBands; ++band) key[at++] = std::abs(value(band));
    if (f == 0) continue;
    for (int band = 0; band + 1 < kSpectralKeyBands; ++band) {
      const Complex product = value(band) * std::conj(value(band + 1));
      const float size = std::sqrt(std::abs(product));
      key[at++] = size > 0 ? product.real() / size : 0;
      key[at++] = size > 0 ? product.imag() / size : 0;
    }
  }
  const float norm = key.norm();
  return norm > 0 ? Eigen::VectorXf(key / norm) : key;
}

}  // namespace radioslam
