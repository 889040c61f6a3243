// A loop closure of one robot by scan matching; its keyframes, and the parameters of the search.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/lidar/surfels/surfel.hpp"

namespace radioslam {

struct ScanLoopParams {
  bool enabled = true;
  double radius_ratio = 0.5;
  double min_path_m = 10;
  double stride_m = 2;
  double submap_m = 5;
  double sigmas = 3;
  double known_sigma_m = 0.1;
  double min_fit_ratio = 0.85;
  double alternative_ratio = 0.75;
  double max_doubt = 0.05;
  double min_structure = 25;
  double max_sigma_m = 0.5;
  double min_sigma_m = 0.02;
  double min_sigma_rad = 0.003;
  int rounds = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(enabled, "", 0, 1,
                          "whether loop closures within each robot are searched by scan matching");
    RADIOSLAM_FIELD(
        radius_ratio, "", 0.01, 10,
        "distance at which two keyframes' views overlap, as a fraction of the scan's median range");
    RADIOSLAM_BASIC_FIELD(min_path_m, "m", 0, 1e6,
                          "smallest path length between the two keyframes of a closure");
    RADIOSLAM_FIELD(
        stride_m, "m", 0, 1e4,
        "path length between keyframes that are tried; lower values find more closures but take longer");
    RADIOSLAM_FIELD(submap_m, "m", 0, 1e3,
                    "path length to either side of the earlier keyframe that its submap covers");
    RADIOSLAM_FIELD(sigmas, "", 0, 10,
                    "standard deviations by which two keyframes may be closer than estimated; higher values "
                    "try more pairs");
    RADIOSLAM_FIELD(known_sigma_m, "m", 0, 100,
                    "standard deviation of the relative position below which a pair is not tried");
    RADIOSLAM_FIELD(min_fit_ratio, "", 0, 1,
                    "smallest inlier ratio of a closure, as a fraction of the nominal one of odometry");
    RADIOSLAM_FIELD(
        alternative_ratio, "", 0.01, 0.999,
        "structure that another pose explains, as a fraction of the best's, at which it is twenty "
        "times less likely");
    RADIOSLAM_FIELD(max_doubt, "", 0, 1,
                    "largest probability of a closure that another place, seen or not, explains the scan");
    RADIOSLAM_FIELD(min_structure, "", 0, 1e6,
                    "smallest number of a scan's points on walls, poles and the like, of spatial scanners");
    RADIOSLAM_FIELD(
        max_sigma_m, "m", 0.01, 1e6,
        "largest standard deviation at which a fit determines the position: along a plain corridor it "
        "does not");
    RADIOSLAM_FIELD(min_sigma_m, "m", 1e-6, 10,
                    "lower bound on the standard deviation of a closure's translation, per axis");
    RADIOSLAM_FIELD(min_sigma_rad, "rad", 1e-6, 3,
                    "lower bound on the standard deviation of a closure's rotation, per axis");
    RADIOSLAM_FIELD(rounds, "", 1, 100, "largest number of rounds of search and optimization");
  }
};

/// The storeys that robots may be on.
enum class Storeys { kOne, kSeveral };

enum class LoopStatus {
  kAccepted,
  kLowOverlap,
  kTooLittleStructure,
  kAmbiguous,        ///< another pose explains the scan, too
  kUnmapped,         ///< places like this recur, and one that was not seen may be it
  kAnotherStorey,    ///< the height is too uncertain to distinguish storeys
  kRejectedByGraph,  ///< contradicts other closures
};
/// Why a closure was rejected, in words; empty if it was accepted.
std::string_view reason(LoopStatus status);

/// Pose of keyframe j in the frame of the earlier keyframe i.
struct ScanLoop {
  std::size_t i = 0, j = 0;
  SE3 T_i_j;
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< about xi in T_i_j * Exp(xi)
  double inlier_ratio = 0;
  /// Probability that another place explains the scan; nothing where it was rejected before that was asked.
  std::optional<double> doubt = {};
  LoopStatus status = LoopStatus::kAccepted;
};

/// Whether a step of this covariance is a motion that nothing measured: its heading is unknown.
inline bool is_unknown_motion(const SE3::Jacobian& covariance) {
  constexpr double kUnknownHeading_rad = 1;
  return covariance(5, 5) > kUnknownHeading_rad * kUnknownHeading_rad;
}

/// Whether a pair that came to nothing is worth another trial: the standard deviation with which its relative
/// position was predicted then, and is now.
inline bool is_worth_another_trial(double before_m, double now_m) {
  constexpr double kMuchWorse = 2;
  return before_m >= kMuchWorse * now_m;
}

/// One robot's keyframes with their scans.
struct ScanKeyframes {
  std::vector<SE3> poses;                       ///< T_start_keyframe, by odometry
  std::vector<SE3::Jacobian> step_covariances;  ///< of T_k^-1 T_k+1
  std::vector<StoredCloud> clouds;              ///< one each, empty for a keyframe without a scan
  double nominal_inlier_ratio = 1;              ///< mean inlier ratio of the odometry's scans
  double spacing_m = 0.25;
  ScannerKind kind = ScannerKind::kSpatial;
};

}  // namespace radioslam
