// What the authors of the WSR data set got out of it (its 2D-Displacement_output_files): a JSON file per set
// and motion, <LOS|NLOS>..._using_<groundtruth|t265>_displacement.json,
//   {trial: [{"a_INFO_Transmitting_robot": {"Name"}, "b_INFO_Receiving_robot": {"groundtruth_start_position":
//   {"x", "y", "z"}}, "d_INFO_AOA_profile": {"Top_N_peaks": {"1": {"azimuth_error"}, ...}}}, ...]}
// with degrees. Trials are numbered anew; what tells which is which is where motion capture saw them start.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/io/wsr_trial.hpp"

namespace radioslam {

/// One transmitter of one trial.
struct WsrResult {
  WsrSight sight = WsrSight::kLineOfSight;
  WsrMotion motion = WsrMotion::kMotionCapture;
  std::string transmitter;
  Eigen::Vector3d start_m = Eigen::Vector3d::Zero();  ///< a row of the trial's motion capture
  std::vector<double> errors_rad;  ///< of the azimuths' peaks, the strongest first; at least one
};

/// Of the folder, or of its default_configuration where it has several. Refuses (InputError) a folder without
/// such files, and files that are not like that.
std::vector<WsrResult> read_wsr_results(const std::filesystem::path& folder);

}  // namespace radioslam
