// Keys of a Scan Context: short vectors independent of the robot's heading, by which a search ranks places.
//
//   ring key      ratio of occupied bins per ring (Kim, Kim 2018)
//   spectral key  from U_b(f), the spectra of the unit columns (scan_context.hpp) summed over the rings of a
//                 band b:
//                   |U_b(f)|                                            f = 0 .. 4
//                   U_b(f) conj(U_b+1(f)) / sqrt(|U_b(f) U_b+1(f)|)     f = 1 .. 4, real and imaginary part
//
// A shift by s sectors multiplies U_b(f) by exp(-2 pi i f s / N) in every band, which cancels in both. The
// products keep the azimuth of one band relative to the next. With magnitudes alone, of 12 frequencies, the
// best match was two to three times as often not among the nearest tenth of the keys.
//
// The ring key compares robots with the same scanner only: where beams meet the ground, rings are occupied.
#pragma once

#include <Eigen/Core>

#include "radioslam/places/scan_context.hpp"

namespace radioslam {

inline constexpr int kSpectralKeyBands = 10;
inline constexpr int kSpectralKeyFrequencies = 5;
inline constexpr int kSpectralKeySize =
    kSpectralKeyBands * kSpectralKeyFrequencies + 2 * (kSpectralKeyBands - 1) * (kSpectralKeyFrequencies - 1);

/// One value per ring, 0 to 1.
Eigen::VectorXf ring_key(const ScanContext& context);

/// kSpectralKeySize values with the norm 1; all zero for an empty grid.
Eigen::VectorXf spectral_key(const ScanContext& context);

/// Spectra summed over bands of rings, at the lowest frequencies: a column per band, `frequencies` real
/// parts, then as many imaginary ones. Zero for bands and frequencies that the grid does not have.
Eigen::MatrixXf band_spectra(const ScanContext& context, int bands, int frequencies);

}  // namespace radioslam
