#include "radioslam/pipeline/recordings_stage.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/pipeline/occupancy_image.hpp"
#include "radioslam/pipeline/stage_clock.hpp"
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

/// Replaces the mission's captures by the angles measured from them.
void add_angles(Mission& mission, const std::vector<AoaMeasurement>& measured) {
  for (Robot& robot : mission.robots) robot.csi.reset();
  mission.aoa_measurements.insert(mission.aoa_measurements.end(), measured.begin(), measured.end());
  std::stable_sort(mission.aoa_measurements.begin(), mission.aoa_measurements.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
}

bool is_not_empty(const MeasuredCsi& csi) { return !csi.aoa_measurements.empty() || !csi.notes.empty(); }

}  // namespace

bool has_raw_recordings(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty() || robot.csi; });
}

MeasuredRecordings measure_recordings(Mission& mission, const RunParams& params, const Progress& progress) {
  MeasuredRecordings measured;
  StageClock timed;
  measured.scans =
      timed("scans", [&] { return measure_scans(mission, params.scans, params.keyframe, progress); });
  measured.csi = timed("angles", [&] { return measure_csi(mission, params.csi, progress); });
  measured.timings = timed.timings();
  add_angles(mission, measured.csi.aoa_measurements);
  if (!is_not_empty(measured.csi)) measured.timings.pop_back();
  if (measured.scans.scans == 0) measured.timings.erase(measured.timings.begin());
  return measured;
}

void add_recording_results(RunResult& result, MeasuredRecordings measured, const Mission& mission,
                           const RunParams& params, const RunOptions& options) {
  const MeasuredScans& scans = measured.scans;
  MeasuredCsi& csi = measured.csi;
  result.timings.insert(result.timings.begin(), measured.timings.begin(), measured.timings.end());
  if (scans.scans > 0) count_scans(result, scans);
  if (has_scans(mission) && !options.overlap_only) {
    StageClock timed;
    timed("scan picture",
          [&] { add_occupancy_images(result, mission, params.scans.lidar, params.occupancy_image); });
    result.timings.push_back(timed.timings().front());
  }
  if (is_not_empty(csi))
    result.counts["arrivals_measured"] = static_cast<double>(csi.aoa_measurements.size());
  result.notes.insert(result.notes.end(), scans.notes.begin(), scans.notes.end());
  for (auto& note : csi.notes) result.notes.push_back(std::move(note));
  add_estimated_azimuths(csi.profiles, result.robots);
  result.aoa_measurements = std::move(csi.profiles);
}

}  // namespace radioslam
