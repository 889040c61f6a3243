// Names of the columns of matches.csv.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace radioslam {

inline constexpr std::string_view kMatchPoseColumns = "robot_i,t_i_s,robot_j,t_j_s,x,y,z,qx,qy,qz,qw";
inline constexpr std::string_view kMatchSigmaColumns = "sigma_t_m,sigma_r_rad";

/// cov_tx_tx, cov_tx_ty, ..., cov_rz_rz: the upper triangle of a match's covariance, row by row.
inline std::vector<std::string> match_covariance_columns() {
  constexpr std::string_view kAxes[] = {"tx", "ty", "tz", "rx", "ry", "rz"};
  std::vector<std::string> names;
  for (std::size_t row = 0; row < 6; ++row)
    for (std::size_t column = row; column < 6; ++column)
      names.push_back("cov_" + std::string(kAxes[row]) + "_" + std::string(kAxes[column]));
  return names;
}

}  // namespace radioslam
