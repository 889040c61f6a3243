// Random numbers that are the same on every machine: xoshiro256++ with its own transforms
// (the standard library's distributions differ between vendors).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace radioslam {

/// A seeded stream of random numbers. Copying copies the state.
class Rng {
 public:
  explicit Rng(std::uint64_t seed);

  /// An independent stream, the same for the same parent seed and name, whatever was drawn before.
  Rng split(std::string_view name) const;
  Rng split(std::uint64_t index) const;

  std::uint64_t next();
  /// Uniform in [0, 1) with 53 random bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in {0, ..., count - 1}; `count` > 0.
  std::uint64_t below(std::uint64_t count);
  /// Standard normal (Marsaglia's polar method).
  double normal();
  double normal(double mean, double sigma) { return mean + sigma * normal(); }

 private:
  std::uint64_t seed_;
  std::array<std::uint64_t, 4> state_;
  std::optional<double> spare_normal_;
};

}  // namespace radioslam
