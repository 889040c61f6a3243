// AoA accuracy on the WSR data set, compared with its authors' results: statistics over many links, by line
// of sight and by motion.
//
// A link without an estimate counts as an error of 180 degrees. Links and their errors are described below.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/datasets/wsr_results.hpp"
#include "radioslam/io/datasets/wsr_trial.hpp"
#include "radioslam/radio/aoa/aoa_estimate.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

// AoA links of the WSR data set: compares the strongest measured direction of each transmitter with its true
// position, for robots that drive an arc.
//
// The error is the azimuth's relative to atan2(transmitter - mean position by motion capture), for every
// motion, and includes the error of the motion's frame: wheel odometry has no initial heading, and that of a
// tracking camera drifts. The error in the motion's own frame, rotated to motion capture's by the best planar
// alignment of the two trajectories, is reported separately. A link without an estimate counts as an error of
// 180 degrees. The authors' links of the same trials are those of the same transmitter that start at a motion
// capture position of the trial.

/// One transmitter of one trial, by one motion.
struct AoaLink {
  std::string trial, transmitter;
  WsrSight sight = WsrSight::kLineOfSight;
  WsrMotion motion = WsrMotion::kMotionCapture;
  double true_azimuth_rad = 0;
  std::vector<AoaPeak> peaks;         ///< strongest first; empty without an estimate
  std::vector<double> published_rad;  ///< the authors' errors of their peaks; empty if not found
  std::string reason;                 ///< why there is no estimate
  std::vector<float> profile = {};    ///< power over azimuth from -pi; maximum 1
  double frame_turn_rad = 0;          ///< rotates the motion's frame to motion capture's
};

/// All links of a trial, by each of its motions. `published` may be empty.
std::vector<AoaLink> measure_wsr_trial(const WsrTrial& trial, const std::vector<WsrResult>& published,
                                       const AoaParams& params);

/// Absolute error of a peak; pi if it does not exist.
double error_rad(const AoaLink& link, std::size_t peak = 0);

/// Error of the strongest peak in the motion's own frame.
double own_frame_error_rad(const AoaLink& link);

/// Statistics of a set of links.
struct AoaFigures {
  std::size_t links = 0;
  std::optional<double> median_rad;
  std::optional<double> within_10_deg;              ///< ratio of the links
  std::optional<double> best_of_4_within_10_deg;    ///< ratio with one of the four strongest peaks within
  std::optional<double> within_sigma;               ///< ratio within 1.645 times their own sigma
  std::optional<double> own_frame_median_rad = {};  ///< in the motion's own frame
};

/// Statistics of this estimator, of the authors on the same links, and of the authors on all links.
struct AoaGroup {
  WsrSight sight;
  WsrMotion motion;
  AoaFigures estimated, published, published_all;
};

/// Groups with at least one measured link.
std::vector<AoaGroup> group_links(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published);

StudyTable aoa_table(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published);
/// A row per link: trial,transmitter,sight,motion,peak azimuths, errors.
std::string aoa_links_csv(const std::vector<AoaLink>& links);

const char* word_for(WsrSight sight);
const char* word_for(WsrMotion motion);

}  // namespace radioslam
