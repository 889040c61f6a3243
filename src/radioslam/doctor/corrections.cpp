#include "radioslam/doctor/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/doctor/text.hpp"

namespace radioslam {
namespace {

auto every_pair() {
  return [](std::size_t, std::size_t) { return true; };
}
auto pairs_of(std::size_t node) {
  return [node](std::size_t i, std::size_t j) { return i == node || j == node; };
}

void for_links(TeamLinks& team, TrackLink::Kind kind, const auto& change) {
  for (TrackLink& link : team.links)
    if (link.kind == kind) change(link);
}

bool has_links(const TeamLinks& team, TrackLink::Kind kind) {
  return std::any_of(team.links.begin(), team.links.end(),
                     [&](const TrackLink& link) { return link.kind == kind; });
}

Finding finding(std::string kind, std::string robot, std::string file, std::string found,
                std::string expected, std::string advice) {
  return {std::move(kind),  Severity::kWarning,  std::move(robot), std::move(file),
          std::move(found), std::move(expected), std::move(advice)};
}

/// Whether a robot may move so: at a speed that something drives at.
bool can_move_like(const Track& track, double factor) {
  constexpr double kSlowest_mps = 0.01, kFastest_mps = 60;
  if (track.empty()) return false;
  const double duration_s = track.rows().back().t_s - track.rows().front().t_s;
  const double path_m = factor * track.path_m();
  return path_m > kSlowest_mps * duration_s && path_m < kFastest_mps * duration_s;
}

void add_odometry(const Mission& mission, const TeamLinks& team, std::size_t r,
                  std::vector<Correction>& all) {
  const std::string& id = mission.robots[r].id;
  all.push_back({finding("handedness", id, odometry_file(id),
                         "the trajectory fits the radio links only as its mirror image",
                         "a right-handed frame, y to the left of x and yaw counter-clockwise",
                         "change the sign of y and of the yaw"),
                 [r](TeamLinks& links) { links.tracks[r].mirror(); }, pairs_of(r)});
  for (const Unit& unit : kLengthUnits) {
    if (!can_move_like(team.tracks[r], unit.si)) continue;
    all.push_back({finding("unit", id, odometry_file(id),
                           std::string("positions fit the radio links if they are in ") + unit.name, "metres",
                           "multiply the positions by " + number(unit.si)),
                   [r, unit](TeamLinks& links) { links.tracks[r].scale(unit.si); }, pairs_of(r)});
  }
}

/// Of a range between robots; else the sigma was not in the ranges' unit.
bool is_plausible_sigma_m(double sigma_m) { return sigma_m > 0.01 && sigma_m < 10; }

void add_ranges(std::vector<Correction>& all) {
  const auto scaled = [&](double factor, std::string kind, std::string found, std::string expected,
                          std::string advice) {
    all.push_back(
        {finding(std::move(kind), "", kRangesFile, std::move(found), std::move(expected), std::move(advice)),
         [factor](TeamLinks& team) {
           for_links(team, TrackLink::Kind::kRange, [&](TrackLink& link) {
             link.range_m *= factor, link.log_density += std::log(factor);
             if (is_plausible_sigma_m(factor * link.sigma)) link.sigma *= factor;
           });
         },
         every_pair()});
  };
  for (const Unit& unit : kLengthUnits)
    scaled(unit.si, "unit", std::string("distances fit the trajectories if they are in ") + unit.name,
           "metres", "multiply range_m and sigma_m by " + number(unit.si));
  scaled(0.5, "unit", "distances are twice those between the robots", "the distance, not the round trip",
         "divide range_m and sigma_m by two");
  scaled(2, "unit", "distances are half of those between the robots", "metres",
         "multiply range_m and sigma_m by two");
}

/// Whether most angles have an elevation.
bool has_elevations(const Mission& mission) {
  std::size_t paths = 0, measured = 0;
  for (const AoaMeasurement& angle : mission.aoa_measurements)
    for (const AoaPath& path : angle.paths) ++paths, measured += path.elevation_rad.has_value();
  return 2 * measured > paths;
}

/// Corrections of the angles of one receiver, or of all (`r` past the robots).
void add_angles(const Mission& mission, std::size_t r, std::vector<Correction>& all) {
  const bool is_all = r >= mission.robots.size();
  const std::string id = is_all ? "" : mission.robots[r].id;
  const auto changed = [&](std::string kind, std::string found, std::string expected, std::string advice,
                           auto azimuth) {
    const auto apply = [=](TeamLinks& team) {
      for_links(team, TrackLink::Kind::kAngle, [&](TrackLink& link) {
        if (is_all || link.a.node == r)
          for (AoaPath& path : link.paths) path.azimuth_rad = wrap_angle(azimuth(path, team, link));
      });
    };
    all.push_back(
        {finding(std::move(kind), id, kAnglesFile, std::move(found), std::move(expected), std::move(advice)),
         apply, is_all ? std::function<bool(std::size_t, std::size_t)>(every_pair()) : pairs_of(r)});
  };
  using std::numbers::pi;
  changed("handedness", "azimuths turn clockwise", "counter-clockwise from body x",
          "change the sign of azimuth_rad",
          [](const AoaPath& path, const TeamLinks&, const TrackLink&) { return -path.azimuth_rad; });
  changed("handedness", "azimuths turn clockwise from the robot's left or right",
          "counter-clockwise from body x", "replace azimuth_rad by pi/2 - azimuth_rad",
          [](const AoaPath& path, const TeamLinks&, const TrackLink&) { return pi / 2 - path.azimuth_rad; });
  if (has_elevations(mission))
    changed("column-order", "azimuths and elevations are exchanged", "azimuth_rad before elevation_rad",
            "exchange the two columns", [](const AoaPath& path, const TeamLinks&, const TrackLink&) {
              return path.elevation_rad.value_or(0);
            });
  changed("frame", "azimuths are those of the odometry's frame", "the receiver's body frame",
          "subtract the receiver's yaw from azimuth_rad",
          [](const AoaPath& path, const TeamLinks& team, const TrackLink& link) {
            const auto row = team.tracks[link.a.node].at(link.t_s);
            if (!row) return path.azimuth_rad;
            return path.azimuth_rad - SE3(Eigen::Vector3d::Zero(), row->rotation).yaw();
          });
}

Correction exchanged_ends() {
  return {finding("column-order", "", kAnglesFile,
                  "angles fit the trajectories with receiver and transmitter exchanged",
                  "the receiver measures the angle", "exchange the columns receiver and transmitter"),
          [](TeamLinks& team) {
            for_links(team, TrackLink::Kind::kAngle, [&](TrackLink& link) {
              if (link.b.node != team.world()) std::swap(link.a, link.b);
            });
          },
          every_pair()};
}

void add_fixes(const Mission& mission, std::size_t r, std::vector<Correction>& all) {
  const std::string& id = mission.robots[r].id;
  const auto apply = [r](TeamLinks& team) {
    for_links(team, TrackLink::Kind::kFix, [&](TrackLink& link) {
      if (link.a.node == r) std::swap(link.b.point_m.x(), link.b.point_m.y());
    });
  };
  const auto concerns = [r, world = mission.robots.size()](std::size_t i, std::size_t j) {
    return i == r && j == world;
  };
  all.push_back({finding("column-order", id, robot_file(id, "gnss.csv"),
                         "position fixes are a mirror image of the odometry", "x to the east, y to the north",
                         "exchange x_m and y_m"),
                 apply, concerns});
}

/// The range seen from above, if its ends are so much above each other.
void flatten(TrackLink& link, double height_m) {
  constexpr double kMinFlat_m = 0.5, kImpossible = 10, kSigmas = 4;
  if (link.range_m + kSigmas * link.sigma < height_m) link.log_density -= kImpossible;
  const double flat_m =
      std::sqrt(std::max(kMinFlat_m * kMinFlat_m, link.range_m * link.range_m - height_m * height_m));
  const double factor = link.range_m / flat_m;
  link.sigma *= factor;
  link.log_density += std::log(factor);
  link.range_m = flat_m;
}

/// Stated standard deviations far below those of the data.
void add_noise(const TeamLinks& team, const auto& add) {
  const auto noisier = [&](TrackLink::Kind kind, const char* file, const char* column, double factor) {
    if (!has_links(team, kind)) return;
    add(
        finding(
            "noise", "", file, "the measured noise is about " + number(factor) + " times the stated sigma",
            "a sigma within a factor of two", std::string("multiply ") + column + " by " + number(factor)),
        [kind, factor](TeamLinks& links) {
          for_links(links, kind, [&](TrackLink& link) {
            link.sigma *= factor;
            for (AoaPath& path : link.paths) path.sigma_rad *= factor;
          });
        },
        every_pair());
  };
  for (const double factor : {5., 12., 30.}) {
    noisier(TrackLink::Kind::kRange, kRangesFile, "sigma_m", factor);
    if (factor < 30) noisier(TrackLink::Kind::kAngle, kAnglesFile, "sigma_rad", factor);
  }
}

void add_heights(const Mission& mission, const TeamLinks& team, const auto& add) {
  const auto raised = [](auto concerns, double height_m) {
    return [=](TeamLinks& links) {
      for_links(links, TrackLink::Kind::kRange, [&](TrackLink& link) {
        if (concerns(std::min(link.a.node, link.b.node), std::max(link.a.node, link.b.node)))
          flatten(link, height_m);
      });
    };
  };
  const std::size_t world = team.world();
  for (const double height_m : {2., 4., 7., 12., 20., 35.}) {
    const auto anchors = [world](std::size_t, std::size_t j) { return j == world; };
    add(finding("height", "", "radio/anchors.csv",
                "distances fit the trajectories if the anchors are about " + number(height_m) +
                    " m above or below the robots",
                "antennas at the height that the mission states", "state the heights and use dimension 3"),
        raised(anchors, height_m), anchors);
    for (std::size_t r = 0; r < mission.robots.size(); ++r) {
      const auto robot = [r, world](std::size_t i, std::size_t j) {
        return j != world && (i == r || j == r);
      };
      add(finding("height", mission.robots[r].id, kRangesFile,
                  "distances fit the trajectories if the robot is about " + number(height_m) +
                      " m above or below the others",
                  "antennas at the same height in a planar mission", "state the heights and use dimension 3"),
          raised(robot, height_m), robot);
    }
  }
}

std::string seconds_text(double seconds) {
  return number(std::abs(seconds)) + " s " + (seconds > 0 ? "late" : "early");
}

}  // namespace

std::vector<Correction> discrete_corrections(const Mission& mission, const TeamLinks& team) {
  std::vector<Correction> all;
  const bool has_angles = has_links(team, TrackLink::Kind::kAngle);
  if (has_links(team, TrackLink::Kind::kRange)) add_ranges(all);
  if (has_angles) {
    add_angles(mission, mission.robots.size(), all);
    all.push_back(exchanged_ends());
  }
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    if (!mission.robots[r].fixes.empty()) add_fixes(mission, r, all);
    add_odometry(mission, team, r, all);
    if (has_angles) add_angles(mission, r, all);
  }
  return all;
}

std::vector<Correction> clock_corrections(const Mission& mission, const TeamLinks& team, double seconds) {
  std::vector<Correction> all;
  const auto file = [&](TrackLink::Kind kind, const std::string& name) {
    if (!has_links(team, kind)) return;
    all.push_back({finding("clock", "", name, "times are " + seconds_text(seconds),
                           "the clock of the odometry", "subtract " + number(seconds) + " s from t_s"),
                   [kind, seconds](TeamLinks& links) {
                     for_links(links, kind, [&](TrackLink& link) { link.t_s -= seconds; });
                   },
                   every_pair()});
  };
  file(TrackLink::Kind::kRange, kRangesFile);
  file(TrackLink::Kind::kAngle, kAnglesFile);
  for (std::size_t r = 0; r < mission.robots.size(); ++r) {
    const std::string& id = mission.robots[r].id;
    all.push_back({finding("clock", id, odometry_file(id), "times are " + seconds_text(seconds),
                           "the clock of the other robots and of the radio",
                           "subtract " + number(seconds) + " s from all times of the robot"),
                   [r, seconds](TeamLinks& links) { links.tracks[r].shift(-seconds); }, pairs_of(r)});
    if (mission.robots[r].fixes.empty()) continue;
    all.push_back({finding("clock", id, robot_file(id, "gnss.csv"), "times are " + seconds_text(seconds),
                           "the clock of the odometry", "subtract " + number(seconds) + " s from t_s"),
                   [r, seconds](TeamLinks& links) {
                     for_links(links, TrackLink::Kind::kFix, [&](TrackLink& link) {
                       if (link.a.node == r) link.t_s -= seconds;
                     });
                   },
                   pairs_of(r)});
  }
  return all;
}

std::vector<Correction> offset_corrections(const Mission& mission, const TeamLinks& team) {
  std::vector<Correction> all;
  const auto add = [&](Finding what, std::function<void(TeamLinks&)> apply,
                       std::function<bool(std::size_t, std::size_t)> concerns) {
    all.push_back({std::move(what), std::move(apply), std::move(concerns)});
  };
  const bool has_ranges = has_links(team, TrackLink::Kind::kRange);
  for (const double bias_m : {0.7, 1.5, 3., 6., 12., 20., -0.7, -1.5, -3., -6., -12.}) {
    if (!has_ranges) break;
    add(
        finding(
            "bias", "", kRangesFile,
            "distances are about " + number(std::abs(bias_m)) + " m too " + (bias_m > 0 ? "long" : "short"),
            "unbiased distances", "subtract the antenna delay, about " + number(bias_m) + " m"),
        [bias_m](TeamLinks& links) {
          for_links(links, TrackLink::Kind::kRange,
                    [&](TrackLink& link) { link.range_m = std::max(0.0, link.range_m - bias_m); });
        },
        every_pair());
  }
  for (std::size_t r = 0; r < mission.robots.size() && has_links(team, TrackLink::Kind::kAngle); ++r)
    for (const double bias_degrees : {15, -15, 30, -30, 60, -60, 90, -90, 120, -120, 150, -150, 180}) {
      const double bias_rad = radians(bias_degrees);
      add(
          finding("bias", mission.robots[r].id, kAnglesFile,
                  "azimuths are about " + number(degrees(bias_rad)) + " degrees too large",
                  "azimuths from body x",
                  "subtract " + number(bias_rad) + " from azimuth_rad, or check how the array is mounted"),
          [r, bias_rad](TeamLinks& links) {
            for_links(links, TrackLink::Kind::kAngle, [&](TrackLink& link) {
              if (link.a.node == r)
                for (AoaPath& path : link.paths) path.azimuth_rad = wrap_angle(path.azimuth_rad - bias_rad);
            });
          },
          pairs_of(r));
    }
  add_noise(team, add);
  if (!team.is_planar || !has_ranges) return all;
  add_heights(mission, team, add);
  return all;
}

}  // namespace radioslam
