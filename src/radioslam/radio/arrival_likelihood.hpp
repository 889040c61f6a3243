// How likely a relative pose is, given the directions from which a packet arrived.
//
// T_i_j predicts where i hears j from: azimuth theta = atan2(y, x) and elevation phi = atan2(z, |(x, y)|) of
// j's antenna in i's body. With (theta_F, phi_F) the nearest path, the one of least |theta - theta_F| +
// |phi - phi_F|, wrapped (what was not measured counts as 0),
//   W = g(theta - theta_F; s_theta) g(phi - phi_F; s_phi),   the first factor alone where no elevation is,
//   g(x; s) = exp(-x^2 / 2 s^2)                 gaussian, the default: 1 at agreement, in units of s alone
//   g(x; s) = min(1, exp(-x^2 / 2 s^2) / s)     capped: the source's, s in radians, which at s = 8.5 degrees
//                                               stays 1 up to 16.6 degrees
//   s_phi^2   = sigma^2 + (place / distance)^2 + the prediction's variance
//   s_theta^2 = (sigma / cos phi)^2 + (place / level distance)^2 + likewise: an azimuth says little overhead
// and a measurement of T_i_j with information Omega counts with W Omega where either error reaches the
// threshold, with Omega where none does. Sources: Wang et al. eq. 5-7 (their Delta of 8.5 degrees); the two
// terms beside sigma are ours. All of a measurement's paths take part: a wall's image may confirm a wrong
// pose, and without the direct path a right one may find no path, so one measurement proves nothing.
// Cost: paths.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

struct ArrivalLikelihoodParams {
  std::string form = "gaussian";
  double threshold_rad = 0.14835298641951802;  ///< 8.5 degrees
  double sigma_place_m = 0.2;                  ///< of the antennas in their bodies

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"form", "", 0, 0,
                "what an error of an angle weighs: gaussian, or Wang et al.'s capped at 1 (their eq. 5)",
                "gaussian|capped"},
          self.form);
    visit(Field{"threshold_rad", "rad", 0, 3.2,
                "smaller errors of an angle cost a relative pose nothing; 8.5 degrees (Wang et al.)"},
          self.threshold_rad);
    visit(Field{"sigma_place_m", "m", 0, 100,
                "error of the antennas' places: over the distance, it adds to an angle's error"},
          self.sigma_place_m);
  }
};

enum class AngleWeight { kGaussian, kCapped };

/// g(error; sigma), sigma > 0.
double angle_weight(double error_rad, double sigma_rad, AngleWeight form);

/// How well a relative pose tells the direction that it predicts.
struct DirectionSigma {
  double azimuth_rad = 0, elevation_rad = 0;
};

enum class AngleVerdict {
  kAgrees,
  kBeyond,  ///< an error reaches the threshold
};

/// What a measurement of angles says of a relative pose.
struct AngleCheck {
  double weight = 1;             ///< W
  std::size_t nearest_path = 0;  ///< in the measurement
  double azimuth_error_rad = 0;  ///< predicted - measured, wrapped
  double azimuth_sigma_rad = 0;  ///< s_theta
  std::optional<double> elevation_error_rad;
  double elevation_sigma_rad = 0;
  AngleVerdict verdict = AngleVerdict::kAgrees;

  /// Omega' = information_scale() Omega.
  double information_scale() const { return verdict == AngleVerdict::kBeyond ? weight : 1; }
};

/// Is robot j where T_i_j says it is, seen from i, the receiver? `measured` has the direction in i's body of
/// the transmitter, whose lever arm is in j's body. At no distance every direction agrees.
AngleCheck check_relative_pose(const SE3& T_i_j, const ArrivalMeasurement& measured,
                               const ArrivalLikelihoodParams& params, const DirectionSigma& predicted = {});

/// Log odds that the other robot may as well be anywhere around, against being where T_i_j says,
///   -log(2 pi f),  f = (1 - P) / 2 pi + P / n sum over the n paths of N(theta - theta_p; s_theta),
/// P the probability that one of the paths is direct, whichever: power does not count. What is in `band_rad`
/// of the predicted azimuth counts as hit. If T_i_j is right the mean of exp of it is 1 or less, so that of
/// products is (an e-value; Vovk and Wang 2021). Azimuths alone.
double log_odds_elsewhere(const SE3& T_i_j, const ArrivalMeasurement& measured, double direct_probability,
                          double band_rad, const ArrivalLikelihoodParams& params);

/// A path's direction in the receiver's body; level where no elevation was measured.
Eigen::Vector3d unit_vector(const ArrivalPath& path);

/// The paths as a team in the plane sees them: levelled by the receiver's roll and pitch, without elevation.
ArrivalMeasurement levelled(ArrivalMeasurement measured, const SE3& T_start_receiver);

}  // namespace radioslam
