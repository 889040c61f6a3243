#include "radioslam/pipeline/recordings_stage.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/pipeline/csi_arrivals.hpp"
#include "radioslam/pipeline/scan_picture.hpp"
#include "radioslam/pipeline/stage_clock.hpp"

namespace radioslam {
namespace {

void count_scans(RunResult& result, const MeasuredScans& scans) {
  result.counts["scans"] = static_cast<double>(scans.scans);
  result.counts["scans_registered"] = static_cast<double>(scans.registered);
  result.counts["scans_of_few_points"] = static_cast<double>(scans.too_few);
  result.counts["scans_lost"] = static_cast<double>(scans.unmatched);
  result.counts["scan_closures_accepted"] =
      static_cast<double>(std::count_if(result.closures.begin(), result.closures.end(), [](const auto& c) {
        return c.kind == ClosureKind::kLidar && c.status == ClosureStatus::kAccepted;
      }));
}

bool has_scans(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty(); });
}

/// The angles measured in the mission's captures in place of the captures.
void add_angles(Mission& mission, const std::vector<ArrivalMeasurement>& measured) {
  for (Robot& robot : mission.robots) robot.csi.reset();
  mission.arrivals.insert(mission.arrivals.end(), measured.begin(), measured.end());
  std::stable_sort(mission.arrivals.begin(), mission.arrivals.end(),
                   [](const auto& a, const auto& b) { return a.stamp < b.stamp; });
}

bool has_something(const MeasuredCsi& csi) { return !csi.arrivals.empty() || !csi.notes.empty(); }

}  // namespace

bool has_raw_recordings(const Mission& mission) {
  return std::any_of(mission.robots.begin(), mission.robots.end(),
                     [](const Robot& robot) { return !robot.lidar.empty() || robot.csi; });
}

MeasuredRecordings measure_recordings(Mission& mission, const RunParams& params, const Progress& progress) {
  MeasuredRecordings measured;
  StageClock clock(measured.timings);
  measured.scans =
      clock.time("scans", [&] { return measure_scans(mission, params.scans, params.keyframe, progress); });
  measured.csi = clock.time("angles", [&] { return measure_csi(mission, params.csi, progress); });
  add_angles(mission, measured.csi.arrivals);
  if (!has_something(measured.csi)) measured.timings.pop_back();
  if (measured.scans.scans == 0) measured.timings.erase(measured.timings.begin());
  return measured;
}

void add_recording_results(RunResult& result, MeasuredRecordings measured, const Mission& mission,
                           const RunParams& params, const RunOptions& options) {
  const MeasuredScans& scans = measured.scans;
  MeasuredCsi& csi = measured.csi;
  result.timings.insert(result.timings.begin(), measured.timings.begin(), measured.timings.end());
  if (scans.scans > 0) count_scans(result, scans);
  if (has_scans(mission) && !options.overlap_only)
    StageClock(result.timings).time("scan picture", [&] {
      add_scan_pictures(result, mission, params.scans.lidar, params.scan_picture);
    });
  if (has_something(csi)) result.counts["arrivals_measured"] = static_cast<double>(csi.arrivals.size());
  result.notes.insert(result.notes.end(), scans.notes.begin(), scans.notes.end());
  for (auto& note : csi.notes) result.notes.push_back(std::move(note));
  add_estimated_azimuths(csi.profiles, result.robots);
  result.arrivals = std::move(csi.profiles);
}

}  // namespace radioslam
