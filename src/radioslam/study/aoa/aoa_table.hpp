// AoA accuracy on the WSR data set, compared with its authors' results: statistics over many links, by line
// of sight and by motion.
//
// A link without an estimate counts as an error of 180 degrees. See aoa_links.hpp for links and their errors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/datasets/wsr_results.hpp"
#include "radioslam/study/aoa/aoa_links.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

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
