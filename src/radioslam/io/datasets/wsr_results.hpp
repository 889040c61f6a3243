// Reads the results that the authors of the WSR data set published (2D-Displacement_output_files): one JSON
// file per set and motion, <LOS|NLOS>..._using_<groundtruth|t265>_displacement.json,
//   {trial: [{"a_INFO_Transmitting_robot": {"Name"}, "b_INFO_Receiving_robot": {"groundtruth_start_position":
//   {"x", "y", "z"}}, "d_INFO_AOA_profile": {"Top_N_peaks": {"1": {"azimuth_error"}, ...}}}, ...]}
// Angles are in degrees. The trials have other numbers than in the data set; they are identified by the start
// position in the motion capture.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/datasets/wsr_trial.hpp"

namespace radioslam {

/// One transmitter of one trial.
struct WsrResult {
  WsrSight sight = WsrSight::kLineOfSight;
  WsrMotion motion = WsrMotion::kMotionCapture;
  std::string transmitter;
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero();  ///< start position, a row of the trial's motion capture
  std::vector<double> errors_rad;  ///< azimuth errors of the peaks, strongest first; at least one
};

/// Reads the results in the folder, or in its default_configuration if there are several. Refuses
/// (InputError) a folder without such files, and malformed files.
std::vector<WsrResult> read_wsr_results(const std::filesystem::path& folder);

}  // namespace radioslam
