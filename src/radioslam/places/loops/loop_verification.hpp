// Verifies by scan matching that two keyframes, of one robot or of two, saw the same place.
//
// The scan of one is searched on a submap around the other, all over the uncertainty of their predicted
// relative pose and a little beyond. Where bays, storeys or streets are alike, a scan fits a wrong place as
// well as its own: the prediction is what distinguishes them. So a fit is weighed against its alternatives,
//   w = sum over h of p_h m(d_h) exp(-3 ((1 - s / s_best) / (1 - alternative_ratio))^2),
//   m(d) = mean over a of exp(-d^2 / (2 a^2)) / a,
// s: the structure that the pose explains (structure_fit.hpp); d_h: its Mahalanobis distance from what
// alignment h of the robots predicts, of weight p_h, whose stated covariance may be wrong by factors a^2, a =
// 1/4, 1/2, 1, 2. Where nothing predicts it, m = 1. Alternatives are
//   other poses on the submap
//   places where other alignments expect the scan
//   the places of the target robot that look most alike, where a prediction reaches beyond the submap
//   the place above or below on storeys where the target was, unless in the open (storey.hpp)
//   places that were not seen: as many per area as fit in the area that was, on the area that is possible;
//   without a prediction, the area that both robots have seen
//   storeys that were not seen
// The closure is accepted if its share of all weights is 1 - max_doubt or more.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "radioslam/lidar/pose_search.hpp"
#include "radioslam/places/loops/expected_place.hpp"
#include "radioslam/places/loops/other_places.hpp"
#include "radioslam/places/loops/scan_loop.hpp"

namespace radioslam {

struct LoopVerificationParams {
  double target_m = 0;  ///< path length of a submap to either side of its keyframe
  double source_m = 0;  ///< the same of the scans that are registered to it; 0: the scan alone
  double apart_m = 0;   ///< path length between scans of a submap; 0: all
  Storeys storeys = Storeys::kSeveral;
};

class LoopVerification {
 public:
  LoopVerification(const ScanLoopParams& params, const LoopVerificationParams& of, const LocalMapParams& map,
                   const PoseSearchParams& search, const RegistrationParams& registration)
      : params_(params), of_(of), map_params_(map), search_(search), registration_(registration) {}

  /// Whether a scan of this median range may be from other places than its submap shows: those that look
  /// alike are searched if the target has an index.
  bool reaches_elsewhere(const ExpectedPlace& expected, double median_range_m) const;

  /// Keyframe j of `source` on the submap around keyframe i of `target`.
  ScanLoop verify(const PlacedKeyframes& target, std::size_t i, const PlacedKeyframes& source, std::size_t j,
                  const ExpectedPlace& expected) const;
  /// The best fit of the same near a known pose, weighed against nothing.
  ScanLoop register_near(const PlacedKeyframes& target, std::size_t i, const PlacedKeyframes& source,
                         std::size_t j, const UncertainPose<SE3>& T_i_j) const;

 private:
  struct Fit {
    Registration registration;
    SE3 T_i_j;
    double structure = 0;   ///< share of the scan's structure that it explains
    double likelihood = 0;  ///< relative to the best
    double weight = 0;      ///< with the prediction
    bool elsewhere = false;
    double place_sigma_m = 0;  ///< of the place elsewhere, relative to keyframe i
  };
  /// What a scan is weighed by.
  struct Setting {
    const ExpectedPlace& expected;
    Eigen::Vector3d up;              ///< in keyframe i's frame
    std::optional<double> storey_m;  ///< least height of a storey; nothing if it can be on one only
    double map_area_m2;              ///< that the target has seen
    double possible_m2;              ///< where the scan may have been taken

    /// Of the predicted height.
    double sigma_up_m() const;
  };
  /// What makes a scan doubtful, as weights relative to the best fit's.
  struct Alternatives {
    double fits = 0, unmapped = 0, storeys = 0;
    double doubt() const {
      const double all = fits + unmapped + storeys;
      return all / (1 + all);
    }
  };

  /// Best first.
  std::vector<Fit> fits_around(const PlacedKeyframes& target, std::size_t i, const ScanPyramid& scan,
                               const UncertainPose<SE3>& where) const;
  double reach_m(double median_range_m) const;
  /// Places away from i and j that may explain the scan, too. `best`: of the fits around i.
  std::vector<OtherPlace> other_places(const ComparedKeyframes& compared, const Setting& setting,
                                       double median_range_m, const Fit& best) const;
  /// Adds those around such a place, as poses from keyframe i.
  void add_fits_at(const OtherPlace& place, const PlacedKeyframes& target, std::size_t i,
                   const ScanPyramid& scan, std::vector<Fit>& fits) const;
  /// Sorts the fits by weight.
  Alternatives weigh(const Setting& setting, std::vector<Fit>& fits) const;
  LoopStatus status_of(const Fit& best, const Alternatives& alternatives) const;
  Alternatives alternatives_of(const std::vector<Fit>& weighed, const Setting& setting) const;
  /// Weight of storeys that were not seen, relative to a fit's.
  double unseen_storeys(const Setting& setting, const Fit& fit) const;
  LocalMap map_around(const PlacedKeyframes& robot, std::size_t i, double extent_m) const;
  std::shared_ptr<const ScanPyramid> source_around(const PlacedKeyframes& robot, std::size_t j) const;
  /// The submap has errors of its own: (I^-1 + minimum covariance)^-1, also for a singular I.
  SE3::Jacobian bounded(const SE3::Jacobian& information) const;

  ScanLoopParams params_;
  LoopVerificationParams of_;
  LocalMapParams map_params_;
  PoseSearchParams search_;
  RegistrationParams registration_;
};

}  // namespace radioslam
