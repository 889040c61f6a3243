// A mission as a folder: mission.yaml, and per robot odometry.tum and what else was recorded.
#pragma once

#include <filesystem>

#include "radioslam/mission/mission.hpp"
#include "radioslam/mission/truth.hpp"

namespace radioslam {

/// Reads mission.yaml, each robot's odometry.tum, wifi.csv, imu.csv and gnss.csv, radio/*.csv and
/// matches.csv, and the captures in csi/ of robots whose mission.yaml has the key `csi`. Lists the scans in
/// lidar/, which are read when they are asked for; a robot that has some needs no odometry.tum. Never reads
/// the truth. Every refusal is an InputError; one that no single file is to blame for names mission.yaml.
Mission read_mission(const std::filesystem::path& folder);

/// Reads robots/<id>/groundtruth.tum of the mission's robots; a robot without one has no poses. A truth
/// whose orientations are all the identity holds positions only. Also the labels of what was measured, where
/// a simulator wrote them (truth_labels.hpp).
Truth read_truth(const std::filesystem::path& folder, const Mission& mission);

/// Writes a mission's files into an existing folder (see OutputFolder). Truth may be empty. A robot without
/// odometry has no odometry.tum: such a folder becomes a mission that can be read when that is added.
void write_mission(const std::filesystem::path& folder, const Mission& mission, const Truth& truth = {});

}  // namespace radioslam
