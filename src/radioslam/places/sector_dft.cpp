#include "radioslam/places/sector_dft.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <numbers>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

constexpr int kBlock = 8;  ///< frequencies summed at once, in the registers of SSE2
constexpr int kMaxStride = (kMaxSectors / 2 + kBlock) / kBlock * kBlock;

using Block = Eigen::Array<float, kBlock, 1>;
using HalfSpectrum = Eigen::Matrix<float, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxStride, 1>;

/// A(f) conj(B(f)), summed over the rows of the grids.
struct CrossSpectrum {
  HalfSpectrum real, imaginary;
};

CrossSpectrum cross_spectrum(const SectorDft::Spectra& a, const SectorDft::Spectra& b, int stride) {
  CrossSpectrum sum{HalfSpectrum(stride), HalfSpectrum(stride)};
  for (int f = 0; f < stride; f += kBlock) {
    Block real = Block::Zero(), imaginary = Block::Zero();
    for (Eigen::Index row = 0; row < a.cols(); ++row) {
      const Eigen::Map<const Block> a_re(a.col(row).data() + f), a_im(a.col(row).data() + stride + f);
      const Eigen::Map<const Block> b_re(b.col(row).data() + f), b_im(b.col(row).data() + stride + f);
      real += a_re * b_re + a_im * b_im;
      imaginary += a_im * b_re - a_re * b_im;
    }
    sum.real.segment<kBlock>(f) = real;
    sum.imaginary.segment<kBlock>(f) = imaginary;
  }
  return sum;
}

}  // namespace

SectorDft::SectorDft(int sectors, int frequencies, int shifts)
    : sectors_(sectors),
      shifts_(shifts),
      stride_((frequencies - 1 + kBlock) / kBlock * kBlock),
      forward_(Eigen::MatrixXf::Zero(spectrum_size(), sectors)),
      even_(Eigen::MatrixXf::Zero(shifts / 2 + 1, stride_)),
      odd_(even_) {
  RADIOSLAM_CHECK(sectors >= 1 && sectors <= kMaxSectors, "1 to 64 sectors");
  RADIOSLAM_CHECK(frequencies >= 1 && frequencies <= sectors / 2 + 1, "only frequencies up to Nyquist's");
  RADIOSLAM_CHECK(shifts >= 1 && shifts <= kMaxSectors, "1 to 64 shifts");
  constexpr double kTurn = 2 * std::numbers::pi;
  for (int f = 0; f < frequencies; ++f) {
    for (int j = 0; j < sectors; ++j) {
      const double angle = kTurn * (f * j % sectors) / sectors;
      forward_(f, j) = static_cast<float>(std::cos(angle));
      forward_(stride_ + f, j) = static_cast<float>(-std::sin(angle));
    }
    const double weight = (f == 0 || 2 * f == sectors ? 1.0 : 2.0) / sectors;  // 2: f and N - f
    for (int m = 0; m <= shifts / 2; ++m) {
      const double angle = kTurn * (f * m % shifts) / shifts;
      even_(m, f) = static_cast<float>(weight * std::cos(angle));
      odd_(m, f) = static_cast<float>(-weight * std::sin(angle));
    }
  }
}

const SectorDft& SectorDft::complete(int sectors) {
  RADIOSLAM_CHECK(sectors >= 1 && sectors <= kMaxSectors, "1 to 64 sectors");
  static std::array<std::once_flag, kMaxSectors + 1> once;
  static std::array<std::unique_ptr<const SectorDft>, kMaxSectors + 1> computed;
  const auto k = static_cast<std::size_t>(sectors);
  std::call_once(once[k],
                 [&] { computed[k] = std::make_unique<const SectorDft>(sectors, sectors / 2 + 1, sectors); });
  return *computed[k];
}

Eigen::MatrixXf SectorDft::spectra_of_rows(const Eigen::MatrixXf& rows) const {
  RADIOSLAM_CHECK(rows.cols() == sectors_, "one column per sector");
  return forward_ * rows.transpose();
}

SectorDft::Correlation SectorDft::correlation(const Spectra& a, const Spectra& b) const {
  RADIOSLAM_CHECK(a.rows() == spectrum_size() && b.rows() == a.rows() && a.cols() == b.cols(),
                  "spectra of this transform, as many in both");
  const CrossSpectrum sum = cross_spectrum(a, b, stride_);
  Correlation even(even_.rows()), odd(odd_.rows()), result(shifts_);
  even.noalias() = even_ * sum.real;
  odd.noalias() = odd_ * sum.imaginary;
  for (int m = 0; m < shifts_; ++m) {
    const bool mirrored = m > shifts_ / 2;
    const int half = mirrored ? shifts_ - m : m;
    result[m] = mirrored ? even[half] - odd[half] : even[half] + odd[half];
  }
  return result;
}

}  // namespace radioslam
