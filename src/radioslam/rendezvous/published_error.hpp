// Trajectory error of a robot as Wang et al. use it (eq. 3): raw poses with noise of their own against the
// measurements, so that it grows with every step until an optimization replaces the raw poses.
//   sum over measurements of omega_t^2 |p_j - p_i - R_i p|^2 + omega_r^2 / 2 |R_j - R_i R|_F^2
// Several observations between the same two poses count as their mean.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/random.hpp"
#include "radioslam/rendezvous/robot_estimate.hpp"

namespace radioslam {

class PublishedError {
 public:
  PublishedError(double omega_t, double omega_r, std::uint64_t seed, const SE2& start);

  /// A step as measured; the raw pose gets noise that is independent of that of the measurement.
  void move(const SE2& measured, double sigma_m, double sigma_rad);
  /// Another robot was seen from the latest pose; `raw_other`: where it says it was, if it did.
  void see(const SE2& T_i_j, const std::optional<SE2>& raw_other);
  /// After an optimization: its poses replace the raw ones.
  void optimized(const RobotEstimate& team);
  double value() const { return settled_ + since_; }
  double since_optimized() const { return since_; }
  const SE2& latest() const { return raw_.back(); }

 private:
  double term(const SE2& T_i, const SE2& T_j, const SE2& T_i_j) const;

  double omega_t_, omega_r_;
  Rng rng_;
  std::vector<SE2> raw_;
  double settled_ = 0, since_ = 0;  ///< of measurements before and after the last optimization
};

}  // namespace radioslam
