// Everything that the use of inertial readings together with scans needs.
#pragma once

#include "radioslam/base/fields.hpp"
#include "radioslam/inertial/gravity_alignment.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"
#include "radioslam/inertial/odometry_noise_of_states.hpp"
#include "radioslam/inertial/reading_agreement.hpp"
#include "radioslam/inertial/wild_readings.hpp"

namespace radioslam {

struct InertialStageParams {
  bool enabled = true;
  double outlier_sigmas = 5;
  double node_s = 2;
  double unmeasured_m = 10;
  double unmeasured_rad = 1;
  double check_s = 120;
  double most_cost_per_step = 60;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"enabled", "", 0, 1, "use imu.csv with the scans"}, self.enabled);
    visit(Field{"outlier_sigmas", "", 1, 1e6, "a registration farther off pulls ever less"},
          self.outlier_sigmas);
    visit(Field{"node_s", "s", 0, 100, "between the states of scans and readings together"}, self.node_s);
    visit(Field{"unmeasured_m", "m", 1e-2, 1e6, "deviation of a pose where a scan does not tell it"},
          self.unmeasured_m);
    visit(Field{"unmeasured_rad", "rad", 1e-3, 100, "likewise"}, self.unmeasured_rad);
    visit(Field{"check_s", "s", 1, 1e6, "of the scans, laid by themselves, that readings must agree with"},
          self.check_s);
    visit(Field{"most_cost_per_step", "", 1, 1e9,
                "of the smoother, 15 expected at most; beyond it readings and scans contradict each other"},
          self.most_cost_per_step);
  }
};

struct InertialParams {
  InertialStageParams stage;
  InertialNoiseParams noise;
  WildReadingParams wild;
  ReadingAgreementParams agreement;
  GravityAlignmentParams alignment;
  InertialSmootherParams smoother;
  OdometryNoiseOfStatesParams odometry_noise;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("inertial", self.stage);
    visit("inertial_noise", self.noise);
    visit("wild_readings", self.wild);
    visit("reading_agreement", self.agreement);
    visit("gravity_alignment", self.alignment);
    visit("inertial_smoother", self.smoother);
    visit("inertial_odometry", self.odometry_noise);
  }
};

}  // namespace radioslam
