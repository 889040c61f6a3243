// Angles of arrival out of the WSR data set beside what its authors got: figures of many links, by what the
// receiver saw and by motion.
//
// A link without an estimate counts as one that is off by half a turn. What a link and its errors are tells
// aoa_links.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/io/wsr_results.hpp"
#include "radioslam/study/aoa_links.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// What became of many links.
struct AoaFigures {
  std::size_t links = 0;
  std::optional<double> median_rad;
  std::optional<double> within_10_deg;              ///< share of the links
  std::optional<double> best_of_4_within_10_deg;    ///< share with one of the four strongest peaks
  std::optional<double> within_sigma;               ///< share within 1.645 of its own sigma
  std::optional<double> own_frame_median_rad = {};  ///< in the motion's own frame
};

/// Ours, theirs of the same links, and theirs of all.
struct AoaGroup {
  WsrSight sight;
  WsrMotion motion;
  AoaFigures ours, published, published_all;
};

/// Those that have any link of ours.
std::vector<AoaGroup> group_links(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published);

StudyTable aoa_table(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published);
/// A row per link: trial,transmitter,sight,motion,peak azimuths, errors.
std::string aoa_links_csv(const std::vector<AoaLink>& links);

const char* word_for(WsrSight sight);
const char* word_for(WsrMotion motion);

}  // namespace radioslam
