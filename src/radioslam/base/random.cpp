#include "radioslam/base/random.hpp"

#include <bit>
#include <cmath>

#include "radioslam/base/check.hpp"

namespace radioslam {
namespace {

/// One step of splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t splitmix64(std::uint64_t& state) {
  std::uint64_t z = (state += 0x9e3779b97f4a7c15ULL);
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

/// FNV-1a, 64 bits.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 0xcbf29ce484222325ULL;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return h;
}

}  // namespace

Rng::Rng(std::uint64_t seed) : seed_(seed), state_{} {
  std::uint64_t mix = seed;
  for (auto& word : state_) word = splitmix64(mix);
}

Rng Rng::split(std::string_view name) const { return split(hash(name)); }

Rng Rng::split(std::uint64_t index) const {
  std::uint64_t mix = seed_ ^ std::rotl(index, 32);
  const std::uint64_t first = splitmix64(mix);
  mix ^= index;
  return Rng(first ^ splitmix64(mix));
}

std::uint64_t Rng::next() {
  // xoshiro256++ (Blackman, Vigna 2019).
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17U;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

double Rng::uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }

std::uint64_t Rng::below(std::uint64_t count) {
  RADIOSLAM_CHECK(count > 0, "cannot draw from nothing");
  const std::uint64_t limit = ~std::uint64_t{0} - ~std::uint64_t{0} % count;
  std::uint64_t draw = next();
  while (draw >= limit) draw = next();
  return draw % count;
}

double Rng::normal() {
  if (spare_normal_) {
    const double value = *spare_normal_;
    spare_normal_.reset();
    return value;
  }
  double u = 0, v = 0, s = 0;
  do {
    u = 2 * uniform() - 1;
    v = 2 * uniform() - 1;
    s = u * u + v * v;
  } while (s >= 1 || s == 0);
  const double scale = std::sqrt(-2 * std::log(s) / s);
  spare_normal_ = v * scale;
  return u * scale;
}

}  // namespace radioslam
