// The kernel of beam_sums.hpp, written in the compiler's own vectors of eight floats: a source file compiled
// for wider registers gets wider code. Included by those files alone.
#pragma once

#include "radioslam/radio/beam_sums.hpp"

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

/// To the nearest whole number, for |x| < 2^22: the sum with 1.5 * 2^23 has no room for the fraction.
inline Eight rounded(Eight x) {
  const Eight big = all(12582912.0F);
  return (x + big) - big;
}

struct SineCosine {
  Eight sine, cosine;
};

/// Of an angle in turns: a polynomial over the eighth of a turn around the nearest quarter, within 1e-6.
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
  // With q = |p|^2 and d = p.u, both times kappa/(2 pi): |rho p - u|^2 = 1 + (rho^2 q - 2 rho d)/(kappa/(2
  // pi)).
  const Eight rho = all(to.curvature), square = load(&input.square_turns[k]);
  const Eight bent = rho * square - along - along;
  const Eight per_turn = all(static_cast<float>(1 / input.turns_per_m));
  return bent / (root(all(1) + rho * bent * per_turn) + all(1));
}

template <bool kCurved, std::size_t kSignals>
void sum_one(const BeamInput& input, const BeamDirection& to, BeamSum& out) {
  Eight real_cos[kSignals] = {}, imaginary_sin[kSignals] = {}, imaginary_cos[kSignals] = {},
        real_sin[kSignals] = {};
  for (std::size_t k = 0; k < input.padded; k += 8) {
    const SineCosine turn = sine_cosine(excess_turns<kCurved>(input, to, k));
    for (std::size_t r = 0; r < kSignals; ++r) {
      const Eight re = load(&input.real[r * input.padded + k]),
                  im = load(&input.imaginary[r * input.padded + k]);
      real_cos[r] += re * turn.cosine;
      imaginary_sin[r] += im * turn.sine;
      imaginary_cos[r] += im * turn.cosine;
      real_sin[r] += re * turn.sine;
    }
  }
  for (std::size_t r = 0; r < kSignals; ++r) {
    out.real_cos[r] = sum(real_cos[r]);
    out.imaginary_sin[r] = sum(imaginary_sin[r]);
    out.imaginary_cos[r] = sum(imaginary_cos[r]);
    out.real_sin[r] = sum(real_sin[r]);
  }
}

template <std::size_t kSignals>
void sum_all(const BeamInput& input, const BeamDirection* to, std::size_t count, BeamSum* sums) {
  for (std::size_t d = 0; d < count; ++d)
    to[d].curvature == 0 ? sum_one<false, kSignals>(input, to[d], sums[d])
                         : sum_one<true, kSignals>(input, to[d], sums[d]);
}

void sum_beams(const BeamInput& input, const BeamDirection* to, std::size_t count, BeamSum* sums) {
  switch (input.signals) {
    case 1:
      return sum_all<1>(input, to, count, sums);
    case 2:
      return sum_all<2>(input, to, count, sums);
    case 3:
      return sum_all<3>(input, to, count, sums);
    case 4:
      return sum_all<4>(input, to, count, sums);
    case 5:
      return sum_all<5>(input, to, count, sums);
    case 6:
      return sum_all<6>(input, to, count, sums);
    case 7:
      return sum_all<7>(input, to, count, sums);
    default:
      return sum_all<8>(input, to, count, sums);
  }
}

}  // namespace
}  // namespace radioslam
