// A simulated team that explores a floor and meets as its robots decide: what rendezvous gains.
//
// In an iteration every robot moves at most one step, by its own decision or exploring: to one place after
// another, drawn evenly. Relative poses of robots in sight and within sensing range, and odometry, are the
// true ones with Gaussian noise (Wang et al., section 7.1); radio: packet_radio.hpp. Then messages go to and
// fro until nobody has anything left to send, at most `talk_rounds` times.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/rendezvous/rendezvous_params.hpp"
#include "radioslam/rendezvous/robot_interface.hpp"
#include "radioslam/sim/sensors/packet_radio.hpp"
#include "radioslam/sim/worlds/arena.hpp"

namespace radioslam {

struct RendezvousRunParams {
  int robots = 2;
  int iterations = 50;
  double metres_each = 0;
  double side_m = 0;
  int obstacles = 0;
  double sensing_range_m = 2.2;
  double sigma_t_m = 0.2;
  double sigma_r_rad = 0.08726646259971647;
  double step_m = 2;
  bool outliers = false;
  double outlier_share = 0;
  std::string outlier_kind = "gross";
  bool starts_known = true;
  double loss_share = 0;
  int talk_rounds = 6;
  RendezvousParams robot;
  PacketRadioParams radio;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(robots, "", 1, 100000, "number of robots");
    RADIOSLAM_BASIC_FIELD(iterations, "", 1, 1e6, "steps that each robot may take");
    RADIOSLAM_FIELD(metres_each, "m", 0, 1e9,
                    "each robot stops after walking this far, whatever the iterations; 0: none does");
    RADIOSLAM_BASIC_FIELD(side_m, "m", 0, 1e6,
                          "side of the square floor; 0: 200 m^2 per robot, as in Wang et al.");
    RADIOSLAM_BASIC_FIELD(obstacles, "", 0, 10000, "boxes on the floor");
    RADIOSLAM_BASIC_FIELD(sensing_range_m, "m", 0, 1e6, "distance up to which robots measure relative poses");
    RADIOSLAM_BASIC_FIELD(sigma_t_m, "m", 0, 1000,
                          "standard deviation of odometry per step and of relative poses, per axis");
    RADIOSLAM_BASIC_FIELD(sigma_r_rad, "rad", 0, 3, "the same of rotations");
    RADIOSLAM_FIELD(step_m, "m", 0.01, 1e4, "length of an exploring step");
    RADIOSLAM_FIELD(outliers, "", 0, 1, "whether relative poses are wrong at times");
    RADIOSLAM_FIELD(outlier_share, "", 0, 1, "share of wrong relative poses; 0: 0.3 if there are any");
    RADIOSLAM_FIELD(
        outlier_kind, "", 0, 0,
        "wrong relative poses; sigma: off by 2 to 3 standard deviations, as in Wang et al.; gross: "
        "by 2 to 3 m and 20 to 40 degrees",
        "sigma|gross");
    RADIOSLAM_FIELD(starts_known, "", 0, 1, "whether robots know where they start");
    RADIOSLAM_FIELD(loss_share, "", 0, 1, "share of packets that are lost");
    RADIOSLAM_FIELD(talk_rounds, "", 0, 1000, "largest number of exchanges between two steps");
    RendezvousParams::visit_fields(self.robot, visit);
    PacketRadioParams::visit_fields(self.radio, visit);
  }

  double share_of_outliers() const { return outlier_share > 0 ? outlier_share : outliers ? 0.3 : 0; }
};

/// Where a robot was and what it did after an iteration.
struct RobotMoment {
  SE2 truth, estimate;  ///< in the common frame, and in the robot's own frame
  double error = 0, sigma_m = 0;
  bool asking = false, seeing = false;
  std::int32_t serving = -1;  ///< robot that it walks to
};

/// A robot's error passed the threshold, and what an optimization made of it.
struct ErrorCrossing {
  int iteration = 0;  ///< of the optimization
  int robot = 0;
  double before = 0, after = 0;
};

struct RendezvousRun {
  std::vector<double> error, error_std, sigma_m;  ///< per iteration, over the robots
  std::vector<std::vector<RobotMoment>> moments;  ///< per iteration and robot; empty where not asked for
  std::vector<ErrorCrossing> crossings;
  int open_crossings = 0;  ///< robots whose error is above the threshold at the end
  double ate_trans_mean_squared = 0,
         ate_rot_mean_squared =
             0;  ///< Wang et al., eq. 8 and 9; no alignment, robots in their own frames from where those are
  double position_squared_per_axis_sigma =
      0;            ///< final poses: squared error / (2 sigma_m^2), mean over robots
  double nees = 0;  ///< per degree of freedom, of the latest pose after every iteration
  int meetings = 0;
  double metres_walked = 0;
  int iterations = 0;
  double covered_m2 = 0;  ///< of the floor within sensing range of a robot at some time
  double delta = 0;
  double seconds = 0;
};

struct RendezvousRunOptions {
  std::uint64_t seed = 1;
  bool keep_moments = false;
  bool leave_outliers_out = false;  ///< by label, for comparison
};

RendezvousRun run_rendezvous(const RendezvousRunParams& params, const RendezvousRunOptions& options,
                             const Progress& progress = {});

/// The boxes of the floor that a run took place on.
Arena arena_of(const RendezvousRunParams& params, std::uint64_t seed);

}  // namespace radioslam
