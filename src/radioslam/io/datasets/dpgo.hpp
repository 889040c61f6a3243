// Imports the measurement tables of dpgo (distributed pose graph optimization, Tian et al.;
// mit-acl/dpgo_ros):
//
//   robot_src,pose_src,robot_dst,pose_dst,qx,qy,qz,qw,tx,ty,tz,kappa,tau
//
// one table per robot, further columns are ignored. A row is the relative pose of robot_dst at pose_dst in
// the frame of robot_src at pose_src; robots and poses are numbers. Measurements between two robots stand in
// the tables of both and count once.
//
// kappa and tau are the precisions of SE-Sync (Rosen et al. 2019), whose cost is
//   f = sum kappa |R_j - R_i R|_F^2 + tau |t_j - t_i - R_i t|^2.
// With R_i^T R_j = R Exp(phi), |R_j - R_i R|_F^2 = |Exp(phi) - I|_F^2 = 4 (1 - cos |phi|) = 2 |phi|^2 to
// second order. This project's cost, the sum of squared Mahalanobis norms, is therefore f with the
// information tau of the translation and 2 kappa of the rotation, per axis.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "radioslam/io/graph/team_graph_file.hpp"
#include "radioslam/io/mission/imported_mission.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// The tables as one graph: robot 0 is `a`, 1 is `b`, ... Rows that cannot be read are left out, with a note.
/// Refuses (InputError) tables without usable rows.
TeamGraphFile<SE3> read_dpgo(std::span<const Text> tables);

/// Reads files, and from folders every *.csv below them.
TeamGraphFile<SE3> import_dpgo(const std::vector<std::filesystem::path>& sources);

/// The graph as a mission with a pose per second: odometry, and matches for all other measurements. The
/// odometry noise is a random walk with each robot's variance per step at its median step. Refuses robots
/// whose odometry has gaps; `source` is for the message.
ImportedMission mission_of_team(const TeamGraphFile<SE3>& file, const std::string& source);

}  // namespace radioslam
