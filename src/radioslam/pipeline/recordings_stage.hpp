// What raw recordings measure, before anything else: laser scans the odometry and loop closures of each
// robot, CSI captures angles of arrival between robots. The mission stays as it was recorded.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/pipeline/stage_clock.hpp"
#include "radioslam/radio/captures/csi_stage.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct MeasuredRecordings {
  Mission mission;  ///< as recorded, with the odometry of its scans and the angles of its captures
  MeasuredScans scans;
  MeasuredCsi csi;
};

MeasuredRecordings measure_recordings(const Mission& recorded, const RunParams& params, StageClock& timed,
                                      const Progress& progress);

/// Adds the results of these recordings to those of a run on the same mission.
void add_recording_results(RunResult& result, MeasuredRecordings measured, const RunParams& params,
                           const RunOptions& options, StageClock& timed);

}  // namespace radioslam
