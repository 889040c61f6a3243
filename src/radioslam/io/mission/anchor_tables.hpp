// Reads the tables of `radioslam anchors`: distances between static anchors, and ranges to them.
//   id_i,id_j,distance_m[,sigma_m]                                    DISTANCES.csv
//   t_s,robot_i,robot_j,range_m,sigma_m[,antenna_i,antenna_j]         RANGES.csv, as radio/ranges.csv
// Every row is checked; refused (InputError, with the line) are ids that are not valid file names, rows with
// twice the same id, and numbers that are not finite or not positive. A pair may have several distances.
#pragma once

#include <string>
#include <vector>

#include "radioslam/base/strong_id.hpp"
#include "radioslam/io/text/text.hpp"
#include "radioslam/radio/ranging/anchor_distances.hpp"
#include "radioslam/radio/ranging/range_epochs.hpp"

namespace radioslam {

struct DistanceTable {
  std::vector<std::string> anchors;  ///< in the order of first mention
  std::vector<AnchorDistance> distances;
};

/// `default_sigma_m` is used for rows without a sigma.
DistanceTable read_distances(const Text& text, double default_sigma_m);

/// Two antennas between which ranges were measured: "robot" or "robot/antenna", "anchor" or "anchor/antenna".
struct AntennaPair {
  std::string receiver, anchor;
};

/// One robot's ranges to anchors, sorted by time, then in the order of the rows.
struct ReceiverRanges {
  std::string robot;
  std::vector<AntennaPair> pairs;   ///< in the order of first mention
  std::vector<AnchorRange> ranges;  ///< `sight.anchor` is an index of the given anchors
};

struct RangeTable {
  std::vector<ReceiverRanges> receivers;  ///< in the order of first mention
  std::size_t between_receivers = 0;      ///< number of rows without an anchor, which are not used
  std::size_t between_anchors = 0;        ///< number of rows between two anchors, which are not used
};

/// Every id that is not an anchor is a robot. Refuses a table in which no row names an anchor.
RangeTable read_anchor_ranges(const Text& text, const std::vector<std::string>& anchors);

}  // namespace radioslam
