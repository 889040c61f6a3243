// The tables of `radioslam anchors`: distances between static anchors, and ranges to them.
//   id_i,id_j,distance_m[,sigma_m]                                    DISTANCES.csv
//   t_s,robot_i,robot_j,range_m,sigma_m[,antenna_i,antenna_j]         RANGES.csv, as radio/ranges.csv
// Every row is checked and refused with its line: ids that cannot name a file, equal ids, numbers that are
// not finite or not positive. A pair's distance may stand there several times.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/io/text.hpp"
#include "radioslam/radio/anchor_distances.hpp"
#include "radioslam/radio/range_epochs.hpp"

namespace radioslam {

struct DistanceTable {
  std::vector<std::string> anchors;  ///< in the order in which they are first named
  std::vector<AnchorDistance> distances;
};

/// `default_sigma_m` is that of rows without one.
DistanceTable read_distances(const Text& text, double default_sigma_m);

/// Two antennas that measure their distance: "robot" or "robot/antenna", "anchor" or "anchor/antenna".
struct AntennaPair {
  std::string receiver, anchor;
};

/// One robot's ranges to anchors, in the order of time, then of the rows.
struct ReceiverRanges {
  std::string robot;
  std::vector<AntennaPair> pairs;   ///< in the order in which they are first named
  std::vector<AnchorRange> ranges;  ///< `sight.anchor` counts through the anchors given
};

struct RangeTable {
  std::vector<ReceiverRanges> receivers;  ///< in the order in which they are first named
  std::size_t between_receivers = 0;      ///< rows without an anchor, not used
  std::size_t between_anchors = 0;        ///< rows between two anchors, not used
};

/// Whoever is no anchor is a robot. Refuses a table none of whose rows names an anchor.
RangeTable read_anchor_ranges(const Text& text, const std::vector<std::string>& anchors);

}  // namespace radioslam
