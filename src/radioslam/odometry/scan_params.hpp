// Parameters of odometry and loop closure from laser scans.
#pragma once

#include <string>

#include "radioslam/base/fields.hpp"
#include "radioslam/lidar/clouds/cloud_store.hpp"
#include "radioslam/lidar/lidar_odometry.hpp"
#include "radioslam/odometry/inertial_params.hpp"
#include "radioslam/places/loops/scan_loops.hpp"

namespace radioslam {

/// Source of odometry for robots with both scans and recorded odometry.
enum class OdometrySource { kScans, kRecorded };

struct ScanStageParams {
  std::string odometry = "scans";
  double max_scan_gap_ratio = 3;
  double max_odometry_gap_ratio = 1.5;
  double acceleration_smoothing = 0.2;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    RADIOSLAM_BASIC_FIELD(odometry, "", 0, 0,
                          "source of odometry for robots with both scans and recorded odometry",
                          "scans|recorded");
    RADIOSLAM_FIELD(max_scan_gap_ratio, "", 1, 1e9,
                    "longest gap bridged by scan matching, in nominal scan intervals; recorded odometry "
                    "fills longer ones");
    RADIOSLAM_FIELD(max_odometry_gap_ratio, "", 0, 1e9,
                    "longest gap in recorded odometry used to deskew or predict scans, in nominal scan or "
                    "sample intervals");
    RADIOSLAM_FIELD(
        acceleration_smoothing, "", 1e-3, 1,
        "weight of the newest value in the mean acceleration, which sets the motion distortion covariance");
  }
};

inline OdometrySource odometry_source(const ScanStageParams& params) {
  return params.odometry == "recorded" ? OdometrySource::kRecorded : OdometrySource::kScans;
}

struct ScanParams {
  ScanStageParams stage;
  LidarParams lidar;
  CloudStoreParams clouds;
  PoseSearchParams search;
  ScanLoopParams loops;
  InertialParams inertial;

  template <class Self, class Visitor>
  static void visit_sections(Self& self, Visitor&& visit) {
    visit("scans", self.stage);
    LidarParams::visit_sections(self.lidar, visit);
    visit("clouds", self.clouds);
    visit("scan_search", self.search);
    visit("scan_loops", self.loops);
    InertialParams::visit_sections(self.inertial, visit);
  }
};

}  // namespace radioslam
