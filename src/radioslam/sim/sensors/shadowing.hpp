// Shadowing: spatially correlated deviation of received power from the path loss model.
//
// A Gaussian random field over the floor with correlation exp(-distance / length) (Gudmundson 1991), as a sum
// of plane waves (Rahimi, Recht 2007): s(p) = sigma sqrt(2/m) sum cos(k_i . p + phase_i). The spectrum of
// that correlation in the plane is proportional to (1 + (k length)^2)^(-3/2), so the quantile u of the
// wavenumber is k = sqrt((1 - u)^-2 - 1) / length.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "radioslam/base/random.hpp"

namespace radioslam {

/// One transmitter's shadowing; decibels over metres.
class ShadowingField {
 public:
  ShadowingField(double sigma_db, double correlation_length_m, int waves, Rng rng);

  /// Cost: one cosine per wave.
  double at_db(const Eigen::Vector2d& position) const;

 private:
  struct PlaneWave {
    Eigen::Vector2d wavenumber_per_m;
    double phase_rad = 0;
  };
  double amplitude_db_ = 0;
  std::vector<PlaneWave> waves_;
};

}  // namespace radioslam
