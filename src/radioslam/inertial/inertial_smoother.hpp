// All states of one robot at once, from their poses measured on a map (by laser scans, say) and its inertial
// readings: the least squares of state_factors.hpp over the whole drive, by Gauss-Newton on the
// chain (state_chain.hpp), damped where a step fails. What the poses do not measure - the way along a
// corridor without features, roll and pitch after a long way - the readings carry.
//
//   start: the filter's pass (inertial_filter.hpp)
//   then:  steps until the cost changes no more; the readings are summed again with the biases found
//
// Positions are relative to the start, the heading too; roll, pitch, velocity and biases at the start are
// unknown up to the given sigmas.
// The map's frame is the world's at the start, but for its tilt, and drifts as stated.
// Refuses where a step measures nothing at all: no readings, and a pose on the map of less than full rank.
// Cost: linear in states and readings, some 60 us per state and step.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/uncertain_pose.hpp"
#include "radioslam/inertial/state_chain.hpp"
#include "radioslam/inertial/state_factors.hpp"

namespace radioslam {

struct InertialSmootherParams {
  double sigma_start_m = 1e-3;
  double sigma_start_yaw_rad = 1e-3;
  double sigma_start_tilt_rad = 0.1;
  double sigma_start_velocity_mps = 10;
  double sigma_start_map_m = 10;
  double sigma_start_map_rad = 1;
  int max_iterations = 30;
  double cost_tolerance = 1e-4;
  double first_damping = 1e-6;
  double damping_factor = 10;
  double max_damping = 1e3;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"sigma_start_m", "m", 1e-6, 100, "of the first position: the frame's origin"},
          self.sigma_start_m);
    visit(Field{"sigma_start_yaw_rad", "rad", 1e-7, 3, "of the first heading"}, self.sigma_start_yaw_rad);
    visit(Field{"sigma_start_tilt_rad", "rad", 1e-4, 3,
                "of the first roll and pitch; weak, for the readings tell them"},
          self.sigma_start_tilt_rad);
    visit(Field{"sigma_start_velocity_mps", "m/s", 1e-3, 1000, "of the first velocity"},
          self.sigma_start_velocity_mps);
    visit(Field{"sigma_start_map_m", "m", 1e-3, 1e6,
                "of where the map lies, where the first pose does not tell"},
          self.sigma_start_map_m);
    visit(Field{"sigma_start_map_rad", "rad", 1e-3, 100, "likewise"}, self.sigma_start_map_rad);
    visit(Field{"max_iterations", "", 1, 1000, "steps at most"}, self.max_iterations);
    visit(Field{"cost_tolerance", "", 1e-12, 1, "stop when a step promises less than this"},
          self.cost_tolerance);
    visit(Field{"first_damping", "", 1e-12, 1, "after a failed step, times diag(H)"}, self.first_damping);
    visit(Field{"damping_factor", "", 1.1, 1000, "damping up after a failed step, down after a good one"},
          self.damping_factor);
    visit(Field{"max_damping", "", 1e-3, 1e10, "damping beyond which to give up"}, self.max_damping);
  }
};

/// What was measured of a drive beside the readings.
struct InertialDrive {
  std::vector<Stamp> stamps;              ///< of the states, increasing, at least one
  std::vector<MapPose> poses;             ///< one each
  std::vector<SE3::Jacobian> map_drifts;  ///< covariances from each to the next, of Exp(xi) in the former
                                          ///< body's frame: [translation, rotation], m^2, rad^2
  InertialState start;                    ///< first guess at the first stamp, level and with its biases
};

/// The states of a drive.
struct InertialTrajectory {
  std::vector<Stamp> stamps;
  std::vector<InertialState> states;
  ChainCovariance covariance;
  double cost = 0;  ///< sum of squared norms
  int iterations = 0;
  bool converged = false;

  /// T_i_j, i <= j, with its covariance from the joint one of both. Cost: the states between.
  UncertainPose<SE3> relative_pose(std::size_t i, std::size_t j) const;
};

/// What is known at the start; biases have the noise's prior about those of `start`, and the map lies where
/// `pose` says.
StatePrior start_prior(const InertialState& start, const MapPose& pose, const InertialNoiseParams& noise,
                       const InertialSmootherParams& params);

/// The readings may have gaps.
std::optional<InertialTrajectory> smooth_inertially(const InertialDrive& drive,
                                                    const std::vector<InertialSample>& samples,
                                                    const InertialNoiseParams& noise,
                                                    const InertialSmootherParams& params);

}  // namespace radioslam
