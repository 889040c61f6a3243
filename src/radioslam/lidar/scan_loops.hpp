// Where a robot came back to where it had been: loop closures within one robot, by its scans.
//
//   candidates   pairs of keyframes, far apart along the way, that may stand near each other: nearer than the
//                radius after taking off `sigmas` standard deviations of their RELATIVE position. A plain
//                distance misses the loops that matter, those after a long drift; with the covariance they
//                are found, and hopeless pairs are not tried
//   search       the later scan is laid onto the map of the scans about the earlier keyframe, from starts all
//                over the uncertainty (pose_search.hpp)
//   judgement    it must fit about as well as scans fit their own map, better than anywhere else in the
//                window, and not against the estimate
//   estimate     graduated optimisation of the robot's pose graph drops what the others contradict; with the
//                smaller covariances the next round finds more
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/lidar/local_map.hpp"
#include "radioslam/lidar/pose_search.hpp"

namespace radioslam {

struct ScanLoopParams {
  bool enabled = true;
  double radius_share = 0.5;  ///< of the median range: keyframes nearer than this see much the same
  double least_way_m = 10;    ///< between the two keyframes
  double stride_m = 2;        ///< keyframes are tried so far apart
  double submap_m = 5;        ///< of way to either side of the earlier keyframe
  double sigmas = 3;
  double known_sigma_m = 0.1;  ///< pairs whose relative position is known better need no closure
  double fit_share = 0.85;     ///< of the usual fit of a scan to its own map
  double rival_share = 0.95;   ///< no other place may fit so well, as a share of the best
  double gate = 22.458;        ///< chi-squared of 6, 99.9 %
  double least_sigma_m = 0.02;
  double least_sigma_rad = 0.003;
  int rounds = 5;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"enabled", "", 0, 1, "look for places where a robot comes back to"}, self.enabled);
    visit(Field{"radius_share", "", 0.01, 10, "of the median range: nearer keyframes see much the same"},
          self.radius_share);
    visit(Field{"least_way_m", "m", 0, 1e6, "of way between the two keyframes"}, self.least_way_m);
    visit(Field{"stride_m", "m", 0, 1e4, "keyframes are tried so far apart"}, self.stride_m);
    visit(Field{"submap_m", "m", 0, 1e3, "of way to either side that makes the map"}, self.submap_m);
    visit(Field{"sigmas", "", 0, 10, "standard deviations taken off a distance"}, self.sigmas);
    visit(Field{"known_sigma_m", "m", 0, 100, "pairs known better than this need no closure"},
          self.known_sigma_m);
    visit(Field{"fit_share", "", 0, 1, "of the usual fit of a scan to its own map"}, self.fit_share);
    visit(Field{"rival_share", "", 0, 1, "no other place may fit so well, as a share of the best"},
          self.rival_share);
    visit(Field{"gate", "", 0, 1e6, "squared Mahalanobis distance to the estimate; chi-squared of 6, 99.9 %"},
          self.gate);
    visit(Field{"least_sigma_m", "m", 1e-6, 10, "error of a closure, along each axis, at least"},
          self.least_sigma_m);
    visit(Field{"least_sigma_rad", "rad", 1e-6, 3, "likewise"}, self.least_sigma_rad);
    visit(Field{"rounds", "", 1, 100, "of search and optimisation"}, self.rounds);
  }
};

enum class LoopVerdict {
  kAccepted,
  kPoorFit,
  kAmbiguous,     ///< another place fits as well
  kFarFromGuess,  ///< against the odometry
  kOutvoted,      ///< against the other closures
};
std::string_view reason(LoopVerdict verdict);

/// Keyframe j of the robot, seen from its earlier keyframe i.
struct ScanLoop {
  std::size_t i = 0, j = 0;
  SE3 T_i_j;
  SE3::Jacobian information = SE3::Jacobian::Zero();  ///< of xi in T_i_j * Exp(xi)
  double matched_share = 0;
  LoopVerdict verdict = LoopVerdict::kAccepted;
};

/// One robot's keyframes.
struct ScanKeyframes {
  std::vector<SE3> poses;                       ///< T_start_keyframe, by odometry
  std::vector<SE3::Jacobian> step_covariances;  ///< of T_k^-1 T_k+1
  std::vector<ScanCloud> clouds;                ///< may be empty: of a keyframe without a scan
  double usual_share = 1;                       ///< of a scan's points that fit its own map
  double spacing_m = 0.25;
  ScannerKind kind = ScannerKind::kSpatial;
};

struct ScanLoops {
  std::vector<ScanLoop> loops;  ///< all that were tried
  std::vector<SE3> poses;       ///< of the keyframes, with the accepted ones
};

ScanLoops close_scan_loops(const ScanKeyframes& keyframes, const ScanLoopParams& params,
                           const LocalMapParams& map, const PoseSearchParams& search,
                           const RegistrationParams& registration, const Progress& progress = {});

}  // namespace radioslam
