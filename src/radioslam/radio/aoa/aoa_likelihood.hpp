// Consistency of a relative pose with an AoA measurement: weight of the pose's information, and log odds
// against it.
//
// T_i_j predicts the direction of j's antenna in i's body frame: azimuth theta = atan2(y, x), elevation
// phi = atan2(z, |(x, y)|). With (theta_F, phi_F) the nearest measured path, the one of smallest
// |theta - theta_F| + |phi - phi_F|, wrapped (a missing elevation counts as 0),
//   W = g(theta - theta_F; s_theta) g(phi - phi_F; s_phi),   first factor only without elevation,
//   g(x; s) = exp(-x^2 / 2 s^2)                 gaussian, the default: 1 at agreement, in units of s alone
//   g(x; s) = min(1, exp(-x^2 / 2 s^2) / s)     capped: as published, s in radians; at s = 8.5 degrees it
//                                               stays 1 up to 16.6 degrees
//   s_phi^2   = sigma^2 + (a / distance)^2 + variance of the predicted phi
//   s_theta^2 = (sigma / cos phi)^2 + (a / level distance)^2 + variance of the predicted theta
// with a = sigma_antenna_position_m: an azimuth constrains little near the zenith. A measurement of T_i_j
// with information Omega gets W Omega where either error reaches the threshold, else Omega. Source: Wang et
// al. (Active Rendezvous) eq. 5-7, threshold 8.5 degrees; they use sigma alone for s. All paths are compared:
// a reflection may agree with a wrong pose, and without a direct path a correct pose may agree with none, so
// a single measurement is not conclusive. Cost: linear in the number of paths.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

enum class AngleWeight {
  kGaussian,
  kCapped,  ///< reproduces Wang et al.
};

struct AoaLikelihoodParams {
  std::string form = "gaussian";
  double threshold_rad = 0.14835298641951802;
  double sigma_antenna_position_m = 0.2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_FIELD(form, "", 0, 0,
                    "weight of an angle error; gaussian: in its standard deviations; capped: at 1, "
                    "reproduces Wang et al. (eq. 5)",
                    "gaussian|capped");
    RADIOSLAM_FIELD(
        threshold_rad, "rad", 0, 3.2,
        "angle error below which a relative pose keeps its full information; 8.5 degrees in Wang et al.");
    RADIOSLAM_FIELD(
        sigma_antenna_position_m, "m", 0, 100,
        "standard deviation of antenna positions; divided by the distance, it adds to the angle error");
  }
};

inline AngleWeight angle_weight_form(const AoaLikelihoodParams& params) {
  return params.form == "capped" ? AngleWeight::kCapped : AngleWeight::kGaussian;
}

/// g(error; sigma), sigma > 0.
double angle_weight(double error_rad, double sigma_rad, AngleWeight form);

/// Standard deviation of the direction that a relative pose predicts.
struct DirectionSigma {
  double azimuth_rad = 0, elevation_rad = 0;
};

enum class AngleStatus {
  kAgrees,
  kBeyond,  ///< an error reaches the threshold
};

/// Comparison of a relative pose with an AoA measurement.
struct AoaAgreement {
  double weight = 1;             ///< W
  std::size_t nearest_path = 0;  ///< index among the measurement's paths
  double azimuth_error_rad = 0;  ///< predicted - measured, wrapped
  double azimuth_sigma_rad = 0;  ///< s_theta
  std::optional<double> elevation_error_rad;
  double elevation_sigma_rad = 0;
  AngleStatus status = AngleStatus::kAgrees;

  /// Omega' = information_scale() Omega.
  double information_scale() const { return status == AngleStatus::kBeyond ? weight : 1; }
};

/// Compares T_i_j with the directions that the receiver i measured, in i's body frame; the transmitter's
/// lever arm is in j's body frame. At zero distance every direction agrees.
AoaAgreement check_relative_pose(const SE3& T_i_j, const AoaMeasurement& measured,
                                 const AoaLikelihoodParams& params, const DirectionSigma& predicted = {});

/// Log odds of a uniformly distributed azimuth against the azimuth that T_i_j predicts,
///   -log(2 pi f),  f = (1 - P) / 2 pi + P / n sum over the n paths of N(theta - theta_p; s_theta),
/// P the probability that one of the paths is direct, each equally likely whatever its power. Errors up to
/// `band_rad` count as zero. If T_i_j is correct, the expectation of the exponential is at most 1, also for
/// products (an e-value; Vovk and Wang 2021). Azimuths only.
double log_odds_elsewhere(const SE3& T_i_j, const AoaMeasurement& measured, double direct_probability,
                          double band_rad, const AoaLikelihoodParams& params);

/// Direction of a path in the receiver's body frame; level where no elevation was measured.
Eigen::Vector3d unit_vector(const AoaPath& path);

/// The measurement for a planar problem: azimuths levelled by the receiver's roll and pitch, no elevations.
AoaMeasurement levelled(AoaMeasurement measured, const SE3& T_start_receiver);

}  // namespace radioslam
