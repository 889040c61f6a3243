// Scans and inertial readings of one robot together.
//
//   under way   the filter (inertial/inertial_filter.hpp) says where the next scan is to be looked for, once
//               gravity is known; until then the gyroscope tells how the robot turned
//   afterwards  the smoother (inertial/inertial_smoother.hpp) estimates all states at once; of the scans it
//               takes what their points tell, nothing along a corridor without features
//
// Successive scans lie on one map, so the error of the motion between two of them does not grow with the
// number of scans in between. States therefore stand `node_s` apart, and the motion from one to the next has
// the information of one registration; the scans in between are bent along.
#pragma once

#include <optional>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/inertial/gravity_alignment.hpp"
#include "radioslam/inertial/inertial_filter.hpp"
#include "radioslam/inertial/inertial_smoother.hpp"
#include "radioslam/inertial/odometry_noise_of_states.hpp"
#include "radioslam/lidar/scan_odometry.hpp"

namespace radioslam {

struct InertialStageParams {
  bool enabled = true;
  double outlier_sigmas = 5;
  double node_s = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"enabled", "", 0, 1, "use imu.csv with the scans"}, self.enabled);
    visit(Field{"outlier_sigmas", "", 1, 1e6, "a registration farther off pulls ever less"},
          self.outlier_sigmas);
    visit(Field{"node_s", "s", 0, 100, "between the states of scans and readings together"}, self.node_s);
  }
};

/// Everything that inertial readings need.
struct InertialParams {
  InertialStageParams stage;
  InertialNoiseParams noise;
  GravityAlignmentParams alignment;
  InertialSmootherParams smoother;
  OdometryNoiseOfStatesParams odometry_noise;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("inertial", self.stage);
    visit("inertial_noise", self.noise);
    visit("gravity_alignment", self.alignment);
    visit("inertial_smoother", self.smoother);
    visit("inertial_odometry", self.odometry_noise);
  }
};

/// Says where the next scan is, from the scans so far and the readings since.
class InertialGuide {
 public:
  /// `samples` must stay.
  InertialGuide(const std::vector<InertialSample>& samples, const InertialParams& params)
      : samples_(&samples), params_(params) {}

  /// The motion since the last scan; nothing before the first one and where readings are missing.
  std::optional<SE3> motion_to(Stamp stamp) const;

  /// A registered scan, in time order.
  void add(const ScanPose& scan);

 private:
  void align();
  std::optional<InertialState> predicted(Stamp stamp) const;

  const std::vector<InertialSample>* samples_;
  InertialParams params_;
  std::vector<StampedPose<SE3>> poses_;  ///< until gravity is known
  StampedPose<SE3> node_{}, last_{};     ///< the filter's state's, and the last scan's
  bool empty_ = true;
  Eigen::Vector3d velocity_mps_ = Eigen::Vector3d::Zero();  ///< of the body, in its frame
  std::optional<InertialFilter> filter_;
};

/// A step between two registered scans, as their points alone tell it.
PoseStep scan_step(const ScanPose& from, const ScanPose& to, const InertialStageParams& params);

/// What scans and readings say together; z is up.
struct InertialOdometry {
  std::vector<SE3> poses;                ///< of the scans
  std::vector<OdometryStepNoise> steps;  ///< from state to state
};

/// Nothing where gravity is not found or the smoother refuses.
std::optional<InertialOdometry> smooth_scans(const std::vector<ScanPose>& scans,
                                             const std::vector<InertialSample>& samples,
                                             const InertialParams& params);

}  // namespace radioslam
