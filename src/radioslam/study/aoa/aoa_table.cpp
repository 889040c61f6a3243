#include "radioslam/study/aoa/aoa_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

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
