#include "radioslam/pipeline/recordings_stage.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/pipeline/occupancy_image.hpp"
#include "radioslam/radio/captures/csi_aoa.hpp"

namespace radioslam {
namespace {

void count_scans(RunResult& result, const MeasuredScans& scans) {
  result.counts["scans"] = static_cast<double>(scans.scans);
  result.counts["scans_registered"] = static_cast<double>(scans.registered);
  result.counts["scans_of_few_points"] = static_cast<double>(scans.too_few);
  result.counts["scans_lost"] = static_cast<double>(scans.lost);
  result.counts["scan_closures_accepted"] =
      static_cast<double>(std::count_if(result.closures.begin(), result.closures.end(), [](const auto& c) {
        return c.kind == ClosureKind::kLidar && c.status == ClosureStatus::kAccepted;
      }));
}

bool has_scans(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty(); });
}

bool has_captures(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return robot.csi.has_value(); });
}

/// With the angles measured from captures beside those that were recorded.
void add_angles(Mission& mission, const std::vector<AoaMeasurement>& measured) {
  mission.aoa_measurements.insert(mission.aoa_measurements.end(), measured.begin(), measured.end());
  std::stable_sort(mission.aoa_measurements.begin(), mission.aoa_measurements.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
}

bool is_not_empty(const MeasuredCsi& csi) { return !csi.aoa_measurements.empty() || !csi.notes.empty(); }

}  // namespace

MeasuredRecordings measure_recordings(const Mission& recorded, const RunParams& params, StageClock& timed,
                                      const Progress& progress) {
  MeasuredRecordings measured{recorded, {}, {}};
  if (has_scans(recorded)) {
    measured.scans = timed("scans", measure_scans, recorded, params.scans, params.keyframe, progress);
    measured.mission = with_odometry(std::move(measured.mission), measured.scans);
  }
  if (has_captures(recorded)) {
    measured.csi = timed("angles", measure_csi, measured.mission, params.csi, progress);
    add_angles(measured.mission, measured.csi.aoa_measurements);
  }
  return measured;
}

void add_recording_results(RunResult& result, MeasuredRecordings measured, const RunParams& params,
                           const RunOptions& options, StageClock& timed) {
  const MeasuredScans& scans = measured.scans;
  MeasuredCsi& csi = measured.csi;
  if (scans.scans > 0) count_scans(result, scans);
  if (has_scans(measured.mission) && !options.overlap_only)
    timed("scan picture", add_occupancy_images, result, measured.mission, params.scans.lidar,
          params.occupancy_image);
  if (is_not_empty(csi))
    result.counts["arrivals_measured"] = static_cast<double>(csi.aoa_measurements.size());
  result.notes.insert(result.notes.end(), scans.notes.begin(), scans.notes.end());
  for (auto& note : csi.notes) result.notes.push_back(std::move(note));
  add_estimated_azimuths(csi.profiles, result.robots);
  result.aoa_measurements = std::move(csi.profiles);
}

}  // namespace radioslam
