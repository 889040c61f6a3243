// When a robot calls others, whom it takes, and how it walks to those who call.
#pragma once

#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/rendezvous/robot_estimate.hpp"

namespace radioslam {

/// How robots come to meet.
enum class RendezvousPolicy {
  kActive,     ///< a robot whose error is too large calls the one it hears best (Wang et al.)
  kAnchored,   ///< some stand as landmarks, the lost one walks to where it gains most per metre
  kScheduled,  ///< all go to one place from time to time
  kRandom,     ///< by chance
};

/// What a robot takes for its error.
enum class ErrorMonitor {
  kUncertainty,  ///< expected square of its drift in position since it last met the team (m^2)
  kSeed,         ///< Wang et al., eq. 3
};

struct RendezvousParams {
  std::string policy = "active";
  std::string monitor = "uncertainty";
  double delta = 10;
  double q_db = 25;
  int kappa = 3;
  double alpha = 1;
  double epsilon = 1;
  double max_step_m = 2;
  double min_step_m = 1.2;
  double walk_sigma = 0.1;
  std::string walk = "checked";
  double lost_after_s = 20;
  double patience_s = 120;
  double omega_t = 2;
  double omega_r = 2;
  double direct_ratio = 0.95;
  double angle_threshold_rad = 0.14835298641951802;
  double anchor_range_m = 30;
  double meeting_x_m = 0, meeting_y_m = 0;
  double meeting_every_s = 25, meeting_wait_s = 10;
  int seed = 1;
  RobotEstimateParams estimate;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(
        policy, "", 0, 0,
        "how robots meet; active: called, Wang et al.; anchored: by turns, to landmarks, by "
        "information gained per metre; scheduled: at one place; random: by chance",
        "active|anchored|scheduled|random");
    RADIOSLAM_BASIC_FIELD(monitor, "", 0, 0,
                          "a robot's error; uncertainty: expected square of its drift since it last met "
                          "another (m^2); seed: Wang et al., eq. 3",
                          "uncertainty|seed");
    RADIOSLAM_BASIC_FIELD(
        delta, "", 0, 1e9,
        "error above which a robot meets another; m^2 by uncertainty, a pure number as published");
    RADIOSLAM_BASIC_FIELD(q_db, "dB", 1, 200, "ESNR that exchanging data takes");
    RADIOSLAM_BASIC_FIELD(kappa, "", 1, 1000, "relative poses that end a rendezvous");
    RADIOSLAM_FIELD(alpha, "", 0, 1e6, "priority of a robot that calls; scales its service discrepancy");
    RADIOSLAM_FIELD(epsilon, "dB", 0, 100, "by how much more ESNR is asked for where there is enough");
    RADIOSLAM_FIELD(max_step_m, "m", 0.01, 1e4, "longest way between two decisions");
    RADIOSLAM_FIELD(min_step_m, "m", 0.001, 1e4, "shortest step of a walk to another robot");
    RADIOSLAM_FIELD(walk_sigma, "", 0.001, 1,
                    "noise of an angle profile in the length of a step, (discrepancy / noise)^2 metres");
    RADIOSLAM_FIELD(walk, "", 0, 0,
                    "arrival that a robot walks along; strongest: as published; checked: the one that power, "
                    "estimates and obstacles speak for",
                    "checked|strongest");
    RADIOSLAM_BASIC_FIELD(
        lost_after_s, "s", 0, 1e6,
        "time after which a robot that is not heard counts as gone; at least five decisions");
    RADIOSLAM_BASIC_FIELD(
        patience_s, "s", 0, 1e6,
        "time after which a rendezvous that does not come about is given up; at least twenty "
        "decisions");
    RADIOSLAM_FIELD(omega_t, "1/m", 0, 1e6, "weight of translations in the published error");
    RADIOSLAM_FIELD(omega_r, "1/rad", 0, 1e6, "weight of rotations in the published error");
    RADIOSLAM_FIELD(direct_ratio, "", 0.01, 0.999,
                    "share of packets between robots in sight whose direct path is among the arrivals");
    RADIOSLAM_FIELD(
        angle_threshold_rad, "rad", 0, 3.2,
        "angle error below which a relative pose keeps its full information with published weights");
    RADIOSLAM_FIELD(anchor_range_m, "m", 0.1, 1e6, "anchored: how far away a landmark may be to begin with");
    RADIOSLAM_FIELD(meeting_x_m, "m", -1e6, 1e6, "scheduled: where robots meet, in their frame");
    RADIOSLAM_FIELD(meeting_y_m, "m", -1e6, 1e6, "scheduled: where robots meet, in their frame");
    RADIOSLAM_FIELD(meeting_every_s, "s", 0.1, 1e6, "scheduled: time between two meetings");
    RADIOSLAM_FIELD(meeting_wait_s, "s", 0, 1e6, "scheduled: how long a robot stays there");
    RADIOSLAM_FIELD(seed, "", 0, 2147483647, "seed of the raw poses' noise in the published error");
    RobotEstimateParams::visit_fields(self.estimate, visit);
  }
};

inline RendezvousPolicy policy_of(const RendezvousParams& params) {
  if (params.policy == "random") return RendezvousPolicy::kRandom;
  if (params.policy == "scheduled") return RendezvousPolicy::kScheduled;
  return params.policy == "anchored" ? RendezvousPolicy::kAnchored : RendezvousPolicy::kActive;
}

inline ErrorMonitor monitor_of(const RendezvousParams& params) {
  return params.monitor == "seed" ? ErrorMonitor::kSeed : ErrorMonitor::kUncertainty;
}

}  // namespace radioslam
