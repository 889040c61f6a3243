// Reads factor graphs in JRL, the JSON Robot Log (McGann et al., github.com/DanMcGann/jrl), 2D or 3D:
//
//   {"measurements": {"a": [{"stamp": 1, "measurements": [MEASUREMENT, ...]}, ...], "b": ...},
//    "groundtruth": {"a": [{"key": KEY, POSE}, ...], ...},
//    "outlier_factors": {"a": [[entry, measurement], ...], ...}}
//
//   MEASUREMENT   "type": "BetweenFactorPose3", "key1", "key2", "measurement": {POSE}, "covariance"
//                 "type": "PriorFactorPose3", "key", "prior": {POSE}, "covariance"
//                 "type": "RangeFactorPose3", "key1", "key2", "measurement": metres, "covariance"
//   POSE          "type": "Pose3", "translation": [x, y, z], "rotation": [w, x, y, z]
//                 "type": "Pose2", "x", "y", "theta"
//
// Covariances are whole matrices row by row, of the error at the right: [rotation, translation] in space,
// [x, y, theta] in the plane. Keys are those of team_assembly.hpp. `groundtruth` is the truth, and the
// factors that `outlier_factors` does not name are labelled true. Measurements of other types are skipped,
// with a note. `initialization` is not read. Stamps of entries have no unit and name no pose: a pose's stamp
// is its index in seconds, as in g2o. Refused (InputError) are malformed measurements of these types,
// covariances that are not positive definite, edges from a pose to itself, and labels of measurements that do
// not exist.
#pragma once

#include <filesystem>

#include "radioslam/io/graph/team_graph_file.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Whether the path ends in .jrl, and perhaps .zst after it.
bool is_jrl_file(const std::filesystem::path& path);

/// Parses a graph; linear in the text, except for sorting the poses.
AnyTeamGraphFile read_jrl(const Text& text, StatedStarts starts = StatedStarts::kIgnored);

}  // namespace radioslam
