// Kernels of steering_sums.hpp in the compiler's vectors of eight floats; a source file compiled for wider
// registers gets wider code. Included only by the source files per instruction set.
#pragma once

#include "radioslam/radio/aoa/steering_sums.hpp"

namespace radioslam {
namespace {

using Eight = float __attribute__((vector_size(32)));
using EightInts = int __attribute__((vector_size(32)));

inline Eight load(const float* p) {
  Eight v;
  __builtin_memcpy(&v, p, sizeof v);
  return v;
}

inline Eight all(float x) { return Eight{x, x, x, x, x, x, x, x}; }

inline float sum(Eight v) { return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7])); }

/// Rounds to the nearest integer, for |x| < 2^22: adding 1.5 * 2^23 leaves no bits for the fraction.
inline Eight rounded(Eight x) {
  const Eight big = all(12582912.0F);
  return (x + big) - big;
}

struct SineCosine {
  Eight sine, cosine;
};

/// Sine and cosine of an angle in turns, by polynomials around the nearest quarter turn; error below 1e-6.
inline SineCosine sine_cosine(Eight turns) {
  const Eight quarters = rounded(turns * all(4));
  const Eight x = (turns - quarters * all(0.25F)) * all(6.28318530718F), xx = x * x;
  const Eight s =
      x * (all(1) + xx * (all(-1.66666546e-1F) + xx * (all(8.33216087e-3F) + xx * all(-1.95152959e-4F))));
  const Eight c =
      all(1) +
      xx * (all(-0.5F) + xx * (all(4.16666457e-2F) + xx * (all(-1.38873162e-3F) + xx * all(2.44331571e-5F))));
  const EightInts q = __builtin_convertvector(quarters, EightInts);
  const EightInts odd = -(q & 1), sine_sign = (q & 2) << 30, cosine_sign = ((q + 1) & 2) << 30;
  const auto bits = [](Eight v) { return reinterpret_cast<EightInts>(v); };
  const auto floats = [](EightInts v) { return reinterpret_cast<Eight>(v); };
  return {floats(((bits(s) & ~odd) | (bits(c) & odd)) ^ sine_sign),
          floats(((bits(c) & ~odd) | (bits(s) & odd)) ^ cosine_sign)};
}

inline Eight root(Eight v) {
  Eight r;
  for (int k = 0; k < 8; ++k) r[k] = __builtin_sqrtf(v[k]);
  return r;
}

/// kappa e/(2 pi) of eight snapshots.
template <bool kCurved>
inline Eight excess_turns(const BeamInput& input, const BeamDirection& to, std::size_t k) {
  const Eight along = load(&input.x_turns[k]) * all(to.x) + load(&input.y_turns[k]) * all(to.y) +
                      load(&input.z_turns[k]) * all(to.z);
  if constexpr (!kCurved) return -along;
  // With c = kappa/(2 pi), q = c |p|^2 and d = c p.u: |rho p - u|^2 = 1 + (rho^2 q - 2 rho d)/c.
  const Eight rho = all(to.curvature), square = load(&input.square_turns[k]);
  const Eight bent = rho * square - along - along;
  const Eight per_turn = all(static_cast<float>(1 / input.turns_per_m));
  return bent / (root(all(1) + rho * bent * per_turn) + all(1));
}

/// Snapshots whose sines and cosines are buffered at a time.
constexpr std::size_t kChunk = 256;

struct Turns {
  alignas(32) float sine[kChunk];
  alignas(32) float cosine[kChunk];
};

template <bool kCurved>
void turn(const BeamInput& input, const BeamDirection& to, std::size_t begin, std::size_t count,
          Turns& turns) {
  for (std::size_t k = 0; k < count; k += 8) {
    const SineCosine of = sine_cosine(excess_turns<kCurved>(input, to, begin + k));
    __builtin_memcpy(&turns.sine[k], &of.sine, sizeof of.sine);
    __builtin_memcpy(&turns.cosine[k], &of.cosine, sizeof of.cosine);
  }
}

/// Adds the sums of kSignals signals over a chunk, few enough for the registers.
template <std::size_t kSignals>
void add_signals(const BeamInput& input, std::size_t first, std::size_t begin, std::size_t count,
                 const Turns& turns, std::complex<float>* z) {
  Eight re[kSignals] = {}, im[kSignals] = {};
  for (std::size_t k = 0; k < count; k += 8) {
    const Eight sine = load(&turns.sine[k]), cosine = load(&turns.cosine[k]);
    for (std::size_t r = 0; r < kSignals; ++r) {
      const std::size_t at = (first + r) * input.padded + begin + k;
      const Eight a = load(&input.real[at]), b = load(&input.imaginary[at]);
      re[r] += a * cosine - b * sine;
      im[r] += b * cosine + a * sine;
    }
  }
  for (std::size_t r = 0; r < kSignals; ++r) z[first + r] += std::complex<float>(sum(re[r]), sum(im[r]));
}

void sum_beams(const BeamInput& input, const BeamDirection* to, std::size_t count, BeamSum* sums) {
  Turns turns;
  for (std::size_t d = 0; d < count; ++d) {
    sums[d].z.fill(0);
    for (std::size_t begin = 0; begin < input.padded; begin += kChunk) {
      const std::size_t part = input.padded - begin < kChunk ? input.padded - begin : kChunk;
      to[d].curvature == 0 ? turn<false>(input, to[d], begin, part, turns)
                           : turn<true>(input, to[d], begin, part, turns);
      std::size_t first = 0;
      for (; first + 4 <= input.signals; first += 4)
        add_signals<4>(input, first, begin, part, turns, sums[d].z.data());
      for (; first < input.signals; ++first)
        add_signals<1>(input, first, begin, part, turns, sums[d].z.data());
    }
  }
}

/// Adds the sums of kSignals signals over a chunk, for both opposite directions.
template <std::size_t kSignals>
void add_opposite_signals(const BeamInput& input, std::size_t first, std::size_t begin, std::size_t count,
                          const Turns& turns, OppositeBeamSums& z) {
  Eight ac[kSignals] = {}, bs[kSignals] = {}, bc[kSignals] = {}, as[kSignals] = {};
  for (std::size_t k = 0; k < count; k += 8) {
    const Eight sine = load(&turns.sine[k]), cosine = load(&turns.cosine[k]);
    for (std::size_t r = 0; r < kSignals; ++r) {
      const std::size_t at = (first + r) * input.padded + begin + k;
      const Eight a = load(&input.real[at]), b = load(&input.imaginary[at]);
      ac[r] += a * cosine;
      bs[r] += b * sine;
      bc[r] += b * cosine;
      as[r] += a * sine;
    }
  }
  for (std::size_t r = 0; r < kSignals; ++r) {
    z.ahead.z[first + r] += std::complex<float>(sum(ac[r] - bs[r]), sum(bc[r] + as[r]));
    z.behind.z[first + r] += std::complex<float>(sum(ac[r] + bs[r]), sum(bc[r] - as[r]));
  }
}

void sum_opposite_beams(const BeamInput& input, const BeamDirection* to, std::size_t count,
                        OppositeBeamSums* sums) {
  Turns turns;
  for (std::size_t d = 0; d < count; ++d) {
    sums[d].ahead.z.fill(0);
    sums[d].behind.z.fill(0);
    for (std::size_t begin = 0; begin < input.padded; begin += kChunk) {
      const std::size_t part = input.padded - begin < kChunk ? input.padded - begin : kChunk;
      turn<false>(input, to[d], begin, part, turns);
      std::size_t first = 0;
      for (; first + 2 <= input.signals; first += 2)
        add_opposite_signals<2>(input, first, begin, part, turns, sums[d]);
      for (; first < input.signals; ++first)
        add_opposite_signals<1>(input, first, begin, part, turns, sums[d]);
    }
  }
}

}  // namespace
}  // namespace radioslam
