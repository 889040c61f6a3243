// Processing of raw recordings before all other stages: laser scans become odometry and loop closures of each
// robot, CSI captures become angles of arrival between robots.
//
// Afterwards the mission contains odometry and angles and no captures; later stages need nothing else.
#pragma once

#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/mission/mission.hpp"
#include "radioslam/odometry/scan_stage.hpp"
#include "radioslam/pipeline/params.hpp"
#include "radioslam/pipeline/pipeline.hpp"
#include "radioslam/radio/captures/csi_stage.hpp"
#include "radioslam/results/results.hpp"

namespace radioslam {

struct MeasuredRecordings {
  MeasuredScans scans;
  MeasuredCsi csi;
  std::vector<StageTiming> timings;  ///< of the steps that had input
};

/// Whether there are scans or captures to process.
bool has_raw_recordings(const Mission& mission);

/// Adds odometry to robots with scans and replaces captures by angles of arrival.
MeasuredRecordings measure_recordings(Mission& mission, const RunParams& params, const Progress& progress);

/// Adds the results of these recordings to those of a run on the same mission.
void add_recording_results(RunResult& result, MeasuredRecordings measured, const Mission& mission,
                           const RunParams& params, const RunOptions& options);

}  // namespace radioslam
