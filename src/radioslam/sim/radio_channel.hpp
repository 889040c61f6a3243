// Radio links between moving robots: distances, and the directions from which each heard the other.
//
// Links are drawn at times when two robots are within radio range, one in each of as many equal parts of
// those times, so that they spread over the mission. A distance is the true one plus Gaussian noise. An
// angle measurement (arrival_paths.hpp) holds the direct path, unless it is missing, and false ones, the
// strongest first. What a receiver measures of a transmitter is drawn from a stream of its own: switching
// one thing on or off leaves the others' noise as it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/fields.hpp"
#include "radioslam/base/random.hpp"
#include "radioslam/geometry/se3.hpp"
#include "radioslam/geometry/trajectory.hpp"
#include "radioslam/mission/radio_links.hpp"

namespace radioslam {

/// Which robots of a link measure angles.
inline constexpr const char* kAngleEnds = "both|one|none";

/// How often robots hear each other and what they make of it.
struct RadioChannelParams {
  int links = 40;
  double radio_range_m = 100;
  bool ranges = true;
  std::string angle_ends = "both";
  double sigma_range_m = 0.5;
  double sigma_angle_deg = 10;
  double time_offset_s = 0;
  double missing_direct_share = 0.15;
  int min_false_paths = 0;
  int max_false_paths = 5;
  double false_elevation_deg = 20;
  bool mirror = false;
  double mirror_stretch_m = 150;
  double mirror_distance_m = 12;
  double sigma_power_db = 4;
  double false_power_db = -5;
  double mirror_power_db = -1;

  template <class Self, class Visitor>
  static void visit_fields(Self& self, Visitor&& visit) {
    visit(Field{"links", "", 0, 100000, "links per pair of robots"}, self.links);
    visit(Field{"radio_range_m", "m", 0.1, 1e6, "robots further apart do not hear each other"},
          self.radio_range_m);
    visit(Field{"ranges", "", 0, 1, "whether links measure distances"}, self.ranges);
    visit(Field{"angle_ends", "", 0, 0, "which robots of a link measure angles; one: the first of the two",
                kAngleEnds},
          self.angle_ends);
    visit(Field{"sigma_range_m", "m", 0.001, 1000, "noise of distances; 0.5 in the published test"},
          self.sigma_range_m);
    visit(Field{"sigma_angle_deg", "deg", 0.01, 90, "noise of angles; 10 in the published test"},
          self.sigma_angle_deg);
    visit(Field{"time_offset_s", "s", 0, 60, "angles are measured this much later than distances"},
          self.time_offset_s);
    visit(Field{"missing_direct_share", "", 0, 1, "share of the angle measurements without a direct path"},
          self.missing_direct_share);
    visit(Field{"min_false_paths", "", 0, 100, "paths from anywhere per angle measurement, at least"},
          self.min_false_paths);
    visit(Field{"max_false_paths", "", 0, 100, "and at most"}, self.max_false_paths);
    visit(Field{"false_elevation_deg", "deg", 0, 90, "they come from at most so far above or below"},
          self.false_elevation_deg);
    visit(Field{"mirror", "", 0, 1, "whether a wall shows the transmitter's mirror image at every angle"},
          self.mirror);
    visit(Field{"mirror_stretch_m", "m", 1, 1e6, "way of the first robot along which that wall is the same"},
          self.mirror_stretch_m);
    visit(Field{"mirror_distance_m", "m", 0, 1000, "from that robot's street to the wall"},
          self.mirror_distance_m);
    visit(Field{"sigma_power_db", "dB", 0, 60, "spread of every path's power"}, self.sigma_power_db);
    visit(Field{"false_power_db", "dB", -100, 100, "mean power of false paths over that of direct ones"},
          self.false_power_db);
    visit(Field{"mirror_power_db", "dB", -100, 100, "mean power of mirror images, likewise"},
          self.mirror_power_db);
  }
};

/// What the links of a team measured, in time order, and which paths are direct (see Truth).
struct RadioLinks {
  std::vector<RangeMeasurement> ranges;
  std::vector<ArrivalMeasurement> arrivals;
  std::vector<std::optional<int>> direct_paths;
};

/// Links between all pairs of robots that move along `truth` (T_common_body). Robots that never come within
/// range have none. Dimension 2 measures no elevation. Cost: a distance per pair and 50 ms.
RadioLinks simulate_links(const std::vector<Trajectory<SE3>>& truth, int dimension,
                          const RadioChannelParams& params, const Rng& rng);

/// Between two times at which robots may hear each other. Links fall on these, so no two of a pair share one.
inline constexpr double kTimeInRangeStep_s = 0.05;

/// When two robots are within `within_m` of each other at t and both still move at t + offset.
std::vector<Stamp> times_in_range(const Trajectory<SE3>& a, const Trajectory<SE3>& b, double within_m,
                                  double offset_s = 0);

}  // namespace radioslam
