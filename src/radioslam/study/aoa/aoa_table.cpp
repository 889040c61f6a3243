#include "radioslam/study/aoa/aoa_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/alignment.hpp"
#include "radioslam/geometry/se2.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

/// Tolerance for the authors' start positions, which are motion capture positions with six decimals.
constexpr double kSamePosition_m = 5e-6;
/// Lever arm of the antenna from the base's centre, to which wheel odometry refers.
const Eigen::Vector3d kAntennaFromBase_m(0, 0.16, 0);

const char* reason_text(AoaFailure reason) {
  switch (reason) {
    case AoaFailure::kNoMotion:
      return "no motion";
    case AoaFailure::kTooFewPackets:
      return "too few packets";
    case AoaFailure::kNoOdometry:
      return "no odometry at the packets' times";
    case AoaFailure::kTooWide:
      return "a way that is too wide";
    case AoaFailure::kZeroChannel:
      return "a channel of zeros";
  }
  return "";
}

const char* reason_text(TwoWayFailure reason) {
  switch (reason) {
    case TwoWayFailure::kTooFewExchanges:
      return "too few packets";
    case TwoWayFailure::kOtherSubcarriers:
      return "other subcarriers at the other end";
    case TwoWayFailure::kIncoherent:
      return "phases that do not agree";
  }
  return "";
}

/// A trajectory of a trial, and the lever arm of the antenna on the moving body.
struct Motion {
  WsrMotion kind;
  const Trajectory<SE3>* trajectory;
  Eigen::Vector3d antenna_m;
};

std::vector<Motion> motions_of(const WsrTrial& trial) {
  std::vector<Motion> motions{{WsrMotion::kMotionCapture, &trial.motion_capture, Eigen::Vector3d::Zero()}};
  if (trial.tracking_camera)
    motions.push_back({WsrMotion::kTrackingCamera, &*trial.tracking_camera, Eigen::Vector3d::Zero()});
  if (trial.wheel_odometry)
    motions.push_back({WsrMotion::kWheelOdometry, &*trial.wheel_odometry, kAntennaFromBase_m});
  return motions;
}

Eigen::Vector3d mean_position_m(const Trajectory<SE3>& trajectory) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [stamp, pose] : trajectory) sum += pose.translation();
  return sum / static_cast<double>(trajectory.size());
}

/// Yaw of the planar alignment of a motion's antenna trajectory with that of motion capture.
double frame_turn_rad(const Motion& motion, const Trajectory<SE3>& truth) {
  std::vector<Eigen::Vector2d> moved, true_positions;
  for (const auto& [stamp, pose] : *motion.trajectory)
    if (const auto there = truth.at(stamp)) {
      moved.emplace_back((pose * motion.antenna_m).head<2>());
      true_positions.emplace_back(there->translation().head<2>());
    }
  if (moved.size() < 2) return 0;
  const auto n = std::ssize(moved);
  Eigen::Matrix2Xd source(2, n), target(2, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    source.col(k) = moved[static_cast<std::size_t>(k)];
    target.col(k) = true_positions[static_cast<std::size_t>(k)];
  }
  const SE2 T_target_source = align_points(source, target);
  return T_target_source.angle();
}

bool starts_in(const WsrResult& result, const WsrTrial& trial) {
  return std::any_of(trial.motion_capture.begin(), trial.motion_capture.end(), [&](const auto& row) {
    return (row.pose.translation() - result.start_m).cwiseAbs().maxCoeff() < kSamePosition_m;
  });
}

std::vector<double> published_errors(const WsrTrial& trial, const AoaLink& link,
                                     const std::vector<WsrResult>& published) {
  for (const WsrResult& result : published)
    if (result.sight == link.sight && result.motion == link.motion &&
        result.transmitter == link.transmitter && starts_in(result, trial))
      return result.errors_rad;
  return {};
}

void measure(const WsrTrial& trial, const WsrTransmitter& transmitter, const Motion& motion,
             const AoaParams& params, AoaLink& link) {
  const auto both = two_way_track(trial.receiver, transmitter.address, transmitter.heard, trial.carrier_hz,
                                  motion.antenna_m, params.two_way);
  if (!both.track) {
    link.reason = reason_text(both.reason);
    return;
  }
  const auto result = estimate_aoa(*both.track, *motion.trajectory, motion.trajectory->front().stamp,
                                   motion.trajectory->back().stamp, params);
  if (result.estimate) {
    link.peaks = result.estimate->peaks;
    link.profile = result.estimate->profile;
  } else {
    link.reason = reason_text(result.reason);
  }
}

constexpr double kNear_rad = 10 * kRadiansPerDegree;
constexpr double kSigmas = 1.645;  ///< 90 % of a normal distribution are within
constexpr std::size_t kBestOf = 4;
constexpr WsrSight kSights[] = {WsrSight::kLineOfSight, WsrSight::kNoLineOfSight};
constexpr WsrMotion kMotions[] = {WsrMotion::kMotionCapture, WsrMotion::kTrackingCamera,
                                  WsrMotion::kWheelOdometry};

double share_of(std::size_t part, std::size_t whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

/// Errors of each link's peaks, strongest first; pi for a link without any.
using LinkErrors = std::vector<std::vector<double>>;

AoaFigures figures_of(const LinkErrors& links) {
  AoaFigures figures{links.size(), {}, {}, {}, {}};
  if (links.empty()) return figures;
  std::vector<double> strongest;
  std::size_t near = 0, near_best = 0;
  for (const auto& errors : links) {
    const auto is_near = [](double error_rad) { return std::abs(error_rad) <= kNear_rad; };
    const auto last = errors.begin() + static_cast<std::ptrdiff_t>(std::min(errors.size(), kBestOf));
    strongest.push_back(std::abs(errors.front()));
    if (is_near(errors.front())) ++near;
    if (std::any_of(errors.begin(), last, is_near)) ++near_best;
  }
  figures.median_rad = median_of(std::move(strongest));
  figures.within_10_deg = share_of(near, links.size());
  figures.best_of_4_within_10_deg = share_of(near_best, links.size());
  return figures;
}

AoaFigures our_figures(const std::vector<const AoaLink*>& links) {
  LinkErrors errors;
  std::size_t covered = 0;
  for (const AoaLink* link : links) {
    errors.push_back({error_rad(*link)});
    for (std::size_t p = 1; p < link->peaks.size(); ++p) errors.back().push_back(error_rad(*link, p));
    if (!link->peaks.empty() && error_rad(*link) <= kSigmas * link->peaks.front().sigma_rad) ++covered;
  }
  AoaFigures figures = figures_of(errors);
  std::vector<double> in_own_frame;
  for (const AoaLink* link : links) in_own_frame.push_back(own_frame_error_rad(*link));
  if (links.empty()) return figures;
  figures.within_sigma = share_of(covered, links.size());
  figures.own_frame_median_rad = median_of(std::move(in_own_frame));
  return figures;
}

StudyRow figures_row(const std::string& label, const AoaFigures& figures) {
  const auto degrees = [](std::optional<double> rad) {
    return rad ? std::optional(*rad / kRadiansPerDegree) : std::nullopt;
  };
  return {label,
          {number_text(static_cast<double>(figures.links), 0), number_text(degrees(figures.median_rad), 1),
           percent_text(figures.within_10_deg, 0), percent_text(figures.best_of_4_within_10_deg, 0),
           percent_text(figures.within_sigma, 0), number_text(degrees(figures.own_frame_median_rad), 1)}};
}

std::size_t unmeasured(const std::vector<AoaLink>& links) {
  return static_cast<std::size_t>(
      std::count_if(links.begin(), links.end(), [](const AoaLink& link) { return link.peaks.empty(); }));
}

std::vector<std::string> notes(const std::vector<AoaLink>& links, bool has_published) {
  std::vector<std::string> notes{
      "Errors are those of the strongest peak's azimuth, relative to the direction from the mean motion "
      "capture position to the transmitter, whatever motion the estimate used; best of 4: ratio of links "
      "with one of the four strongest peaks within 10°. In its own frame: relative to the motion's frame, "
      "rotated to motion capture's by the best alignment of the trajectories."};
  if (has_published)
    notes.emplace_back(
        "The authors' figures are computed from their published results, which contain no wheel odometry; "
        "same trials are those that start at a motion capture position of an evaluated trial.");
  if (const std::size_t count = unmeasured(links); count > 0)
    notes.push_back(std::to_string(count) + " of " + std::to_string(links.size()) +
                    " links have no estimate; they count as errors of 180°.");
  return notes;
}

}  // namespace

double error_rad(const AoaLink& link, std::size_t peak) {
  if (peak >= link.peaks.size()) return std::numbers::pi;
  return std::abs(wrap_angle(link.peaks[peak].azimuth_rad - link.true_azimuth_rad));
}

double own_frame_error_rad(const AoaLink& link) {
  if (link.peaks.empty()) return std::numbers::pi;
  return std::abs(wrap_angle(link.peaks.front().azimuth_rad + link.frame_turn_rad - link.true_azimuth_rad));
}

std::vector<AoaLink> measure_wsr_trial(const WsrTrial& trial, const std::vector<WsrResult>& published,
                                       const AoaParams& params) {
  const std::vector<Motion> motions = motions_of(trial);
  const Eigen::Vector3d here_m = mean_position_m(trial.motion_capture);
  std::vector<AoaLink> links(motions.size() * trial.transmitters.size());
  parallel_for(links.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const Motion& motion = motions[k / trial.transmitters.size()];
      const WsrTransmitter& transmitter = trial.transmitters[k % trial.transmitters.size()];
      const Eigen::Vector3d there_m = transmitter.position_m - here_m;
      links[k] = {trial.name,
                  transmitter.name,
                  trial.sight,
                  motion.kind,
                  std::atan2(there_m.y(), there_m.x()),
                  {},
                  {},
                  {}};
      links[k].frame_turn_rad = frame_turn_rad(motion, trial.motion_capture);
      links[k].published_rad = published_errors(trial, links[k], published);
      measure(trial, transmitter, motion, params, links[k]);
    }
  });
  return links;
}

const char* word_for(WsrSight sight) {
  return sight == WsrSight::kLineOfSight ? "line of sight" : "no line of sight";
}

const char* word_for(WsrMotion motion) {
  switch (motion) {
    case WsrMotion::kMotionCapture:
      return "motion capture";
    case WsrMotion::kTrackingCamera:
      return "tracking camera";
    case WsrMotion::kWheelOdometry:
      return "wheel odometry";
  }
  return "";
}

std::vector<AoaGroup> group_links(const std::vector<AoaLink>& links,
                                  const std::vector<WsrResult>& published) {
  std::vector<AoaGroup> groups;
  for (const WsrSight sight : kSights)
    for (const WsrMotion motion : kMotions) {
      std::vector<const AoaLink*> chosen;
      LinkErrors same, all;
      for (const AoaLink& link : links) {
        if (link.sight != sight || link.motion != motion) continue;
        chosen.push_back(&link);
        if (!link.published_rad.empty()) same.push_back(link.published_rad);
      }
      for (const WsrResult& result : published)
        if (result.sight == sight && result.motion == motion) all.push_back(result.errors_rad);
      if (!chosen.empty())
        groups.push_back({sight, motion, our_figures(chosen), figures_of(same), figures_of(all)});
    }
  return groups;
}

StudyTable aoa_table(const std::vector<AoaLink>& links, const std::vector<WsrResult>& published) {
  StudyTable table{
      "Angles of arrival of the WSR data set",
      "Direction of each transmitter, from packets in both directions, while the robot drives an arc.",
      {"links", "median, °", "within 10°", "best of 4", "within 1.645 σ", "median in its own frame, °"},
      {},
      notes(links, !published.empty())};
  for (const AoaGroup& group : group_links(links, published)) {
    const std::string name = std::string(word_for(group.sight)) + ", " + word_for(group.motion);
    table.rows.push_back(figures_row(name, group.estimated));
    if (group.published.links > 0)
      table.rows.push_back(figures_row(name + ": authors, same trials", group.published));
    if (group.published_all.links > 0)
      table.rows.push_back(figures_row(name + ": authors, all trials", group.published_all));
  }
  return table;
}

std::string aoa_links_csv(const std::vector<AoaLink>& links) {
  std::string out =
      "trial,transmitter,sight,motion,true_azimuth_rad,azimuth_rad,sigma_rad,error_rad,best_of_4_error_rad,"
      "authors_error_rad,reason\n";
  for (const AoaLink& link : links) {
    out += link.trial + "," + link.transmitter + "," + word_for(link.sight) + "," + word_for(link.motion) +
           "," + format_number(link.true_azimuth_rad) + ",";
    if (!link.peaks.empty()) {
      double best_rad = std::numbers::pi;
      for (std::size_t p = 0; p < kBestOf; ++p) best_rad = std::min(best_rad, error_rad(link, p));
      out += format_number(link.peaks.front().azimuth_rad) + "," +
             format_number(link.peaks.front().sigma_rad) + "," + format_number(error_rad(link)) + "," +
             format_number(best_rad);
    } else {
      out += ",,,";
    }
    out += ",";
    if (!link.published_rad.empty()) out += format_number(std::abs(link.published_rad.front()));
    out += "," + link.reason + "\n";
  }
  return out;
}

}  // namespace radioslam
