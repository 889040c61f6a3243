// Raw recordings of a mission, measured before anything else: laser scans become odometry and loops of each
// robot, captures of channel state information become angles of arrival between robots.
//
// The mission that leaves here has odometry and angles and no captures; a run's stages need nothing more.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/pipeline/csi_stage.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/pipeline/scan_stage.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct MeasuredRecordings {
  MeasuredScans scans;
  MeasuredCsi csi;
  std::vector<StageTiming> timings;  ///< of those of the two that there was something for
};

/// Scans or captures, of which odometry and angles have to be made first.
bool has_raw_recordings(const Mission& mission);

/// Gives robots with scans their odometry, and puts angles in the place of captures.
MeasuredRecordings measure_recordings(Mission& mission, const RunParams& params, const Progress& progress);

/// What was measured, in the result of a run on the same mission.
void add_recording_results(RunResult& result, MeasuredRecordings measured, const Mission& mission,
                           const RunParams& params, const RunOptions& options);

}  // namespace radioslam
