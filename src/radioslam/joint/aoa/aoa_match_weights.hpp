// Match weights from angles of arrival: scales a match's information by how well the angles measured near it
// agree with it (active rendezvous, Wang et al., eq. 7; radio/aoa/aoa_likelihood.hpp).
//
// Angle and match may be measured at different times. Odometry of both robots moves the match to the stamp t
// of the angle,
//   T_i(t)_j(t) = T_i(t)_i(t_i) T_i_j T_j(t_j)_j(t),
// and the resulting direction error is added to the angle's. Of the angles between the two robots, in either
// direction, the nearest along the odometry are used, and the match takes the median of their scales.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/joint/closures/closure.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/radio/aoa/aoa_likelihood.hpp"

namespace radioslam {

// Predicted angles of arrival: compares measured angles with relative poses of known covariance.

/// Standard deviation of the direction to the other robot, from the relative pose's covariance.
template <class Pose>
DirectionSigma direction_sigma(const UncertainPose<Pose>& T_i_j);

/// Compares the measurement with the predicted direction from receiver to transmitter.
template <class Pose>
AoaAgreement check_angles(const UncertainPose<Pose>& T_receiver_transmitter, const AoaMeasurement& measured,
                          const Mission& mission, const AoaLikelihoodParams& params);

/// Whether both ends are robots whose odometry covers the measurement's stamp.
bool is_between_robots(const AoaMeasurement& measured, const Mission& mission);

/// How matches of an external place recognition enter the estimate.
struct MatchParams {
  bool robust = true;
  bool angle_weights = false;
  int angles = 25;
  double max_carried_m = 3000;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(robust, "", 0, 0,
                          "whether to keep only the largest consistent set of matches, under a graduated "
                          "loss; false: least squares on all");
    RADIOSLAM_FIELD(angle_weights, "", 0, 0,
                    "whether angles of arrival near a match scale its information; true reproduces active "
                    "rendezvous (Wang et al., eq. 7)");
    RADIOSLAM_FIELD(angles, "", 1, 1000,
                    "largest number of angle measurements per match; the median of their scales applies");
    RADIOSLAM_FIELD(
        max_carried_m, "m", 0, 1e6,
        "longest path, of both robots together, between a match and the angles used to weight it");
  }
};

class AoaMatchWeights {
 public:
  AoaMatchWeights(const Mission& mission, const MatchParams& params, const AoaLikelihoodParams& likelihood);

  /// Scale of a match's information; nothing if no angles were measured near it.
  template <class Pose>
  std::optional<double> information_scale(const Closure& match) const;

 private:
  /// The measurements between the match's robots that are nearest along their odometry.
  std::vector<std::size_t> nearest(const Closure& match) const;

  const Mission& mission_;
  MatchParams params_;
  AoaLikelihoodParams likelihood_;
  std::vector<std::vector<double>> travelled_m_;  ///< per robot and odometry sample
  std::map<std::pair<RobotIndex, RobotIndex>, std::vector<std::size_t>>
      aoa_measurements_;  ///< pair's lower index first
};

}  // namespace radioslam
