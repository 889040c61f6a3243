// Discrete Fourier transform along the sectors of polar grids, and their circular correlation by spectra.
//
//   X(f) = sum over j of x(j) exp(-2 pi i f j / N),   N sectors
//   c(m) = sum over j of a(j + s) b(j),   s = m N / M,   m = 0 .. M - 1   (j + s modulo N)
//        = 1/N sum over f of A(f) conj(B(f)) exp(2 pi i f m / M)
//
// Rows are real, so the frequencies 0 .. N/2 suffice. With all of them c is exact; with fewer it is that of
// the smoothed rows. A spectrum is stored as floats: real parts, zeros up to `stride()`, then the imaginary
// parts alike. Cost of a correlation: 4 stride multiplications per pair of rows, and M stride / 2 for the sum
// over f.
#pragma once

#include <Eigen/Core>

namespace radioslam {

inline constexpr int kMaxSectors = 64;  ///< bits of the masks of columns

class SectorDft {
 public:
  using Spectra = Eigen::Ref<const Eigen::MatrixXf>;  ///< one per column
  using Correlation = Eigen::Matrix<float, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxSectors, 1>;

  /// The lowest frequencies, at most sectors / 2 + 1; shifts at most kMaxSectors.
  SectorDft(int sectors, int frequencies, int shifts);

  /// All frequencies and one shift per sector. Computed once.
  static const SectorDft& complete(int sectors);

  int stride() const { return stride_; }
  Eigen::Index spectrum_size() const { return Eigen::Index{2} * stride_; }

  /// Spectra of the rows of a matrix with one column per sector.
  Eigen::MatrixXf spectra_of_rows(const Eigen::MatrixXf& rows) const;

  /// The sum of the correlations of the rows of a with those of b.
  Correlation correlation(const Spectra& a, const Spectra& b) const;

 private:
  int sectors_, shifts_, stride_;
  Eigen::MatrixXf forward_;     ///< spectrum_size() x sectors
  Eigen::MatrixXf even_, odd_;  ///< shifts / 2 + 1 x stride: factors of the real and the imaginary parts
};

}  // namespace radioslam
