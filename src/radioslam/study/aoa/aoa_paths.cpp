#include "radioslam/study/aoa/aoa_paths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/units.hpp"
#include "radioslam/geometry/so3.hpp"
#include "radioslam/sim/sensors/csi_exchange.hpp"

namespace radioslam {
namespace {

constexpr double kBetween_rad = 25 * kRadiansPerDegree, kFound_rad = 5 * kRadiansPerDegree,
                 kDirect_rad = 2 * kRadiansPerDegree;
constexpr double kPath_m = 1, kTurn_rad = 1.5;  ///< of the arc
constexpr double kDrive_s = 8, kPackets_hz = 120, kPoses_hz = 50, kRest_s = 0.5;
constexpr double kSnr_db = 20, kWeakest_db = -6;
constexpr double kDirectDelay_s = 20e-9, kMinLater_s = 5e-9, kMaxLater_s = 40e-9;
constexpr double kCarrier_hz = 5.54e9;
constexpr MacAddress kMoving{0xa}, kStanding{0xb};
constexpr std::array<const char*, 3> kProfiles{"bartlett", "music", "sparse"};
constexpr std::array<AoaCards, 2> kCards{AoaCards::kIdeal, AoaCards::kDrifting};

CsiCardParams card_params(AoaCards cards) {
  CsiCardParams params;
  params.snr_db = kSnr_db;
  params.snr_distance_m = 1;
  if (cards == AoaCards::kDrifting) return params;
  params.carrier_offset_hz = params.carrier_walk_hz_per_sqrt_s = params.clock_rate_ppm = 0;
  params.random_phase = false;
  params.answer_jitter_us = params.late_answer_ratio = params.detection_delay_ns = 0;
  params.loss_ratio = params.late_stamp_ratio = 0;
  return params;
}

/// Three waves, the direct one first.
std::vector<PlaneWave> draw_waves(Rng rng) {
  std::array<double, 3> azimuths;
  const double first_rad = rng.uniform(-std::numbers::pi, std::numbers::pi);
  for (std::size_t w = 0; w < azimuths.size(); ++w)
    azimuths[w] = wrap_angle(first_rad + static_cast<double>(w) * kBetween_rad);
  std::swap(azimuths[0], azimuths[rng.below(azimuths.size())]);
  std::vector<PlaneWave> waves;
  for (const double azimuth_rad : azimuths) {
    const double weaker_db = rng.uniform(kWeakest_db, 0), later_s = rng.uniform(kMinLater_s, kMaxLater_s);
    const bool is_direct = waves.empty();
    waves.push_back({azimuth_rad, 0, is_direct ? 0 : weaker_db, kDirectDelay_s + (is_direct ? 0 : later_s)});
  }
  return waves;
}

/// An arc about the origin with any initial direction.
BodyAtTime drive_arc(double start_rad) {
  return [start_rad](double t_s) {
    constexpr double kRadius_m = kPath_m / kTurn_rad;
    const double share = std::clamp((t_s - kRest_s) / kDrive_s, 0.0, 1.0);
    const double angle = start_rad + kTurn_rad * share;
    return SE3({kRadius_m * std::cos(angle), kRadius_m * std::sin(angle), 0},
               so3_exp({0, 0, angle + std::numbers::pi / 2}));
  };
}

Trajectory<SE3> poses_of(const BodyAtTime& body) {
  std::vector<StampedPose<SE3>> poses;
  const auto count = static_cast<int>((kDrive_s + 2 * kRest_s) * kPoses_hz);
  for (int k = 0; k <= count; ++k) poses.push_back({Stamp::from_seconds(k / kPoses_hz), body(k / kPoses_hz)});
  return Trajectory<SE3>(std::move(poses));
}

struct Recorded {
  std::vector<PlaneWave> waves;  ///< the direct one first
  Trajectory<SE3> trajectory;
  std::optional<ChannelTrack> track;
};

Recorded record(std::uint64_t seed, AoaCards cards, const AoaParams& params) {
  const Rng rng(seed);
  const double end_s = kDrive_s + 2 * kRest_s;
  Recorded recorded{draw_waves(rng.split("waves")), {}, {}};
  const CsiMedium air{plane_wave_paths(recorded.waves), CsiBand::intel5300(kCarrier_hz), card_params(cards)};
  const BodyAtTime body = drive_arc(rng.split("arc").uniform(-std::numbers::pi, std::numbers::pi));
  const CsiRadio moving{kMoving, {{0, 0, 0}}, body, CsiCard(air.cards, end_s, rng.split("moving"))};
  const CsiRadio standing{kStanding,
                          {{0, 0, 0}},
                          [](double /*t_s*/) { return SE3(); },
                          CsiCard(air.cards, end_s, rng.split("standing"))};
  std::vector<SentPacket> asked;
  for (int k = 0; k < static_cast<int>(kDrive_s * kPackets_hz); ++k)
    asked.push_back({kRest_s + k / kPackets_hz, static_cast<std::uint32_t>(k)});
  ReceivedPackets received = exchange_packets(moving, standing, asked, air, rng.split("air"));
  const CsiCapture answers = record_as_sent(std::move(received.by_asker), air, rng.split("first host"));
  const CsiCapture questions = record_as_sent(std::move(received.by_answerer), air, rng.split("second host"));
  recorded.trajectory = poses_of(body);
  recorded.track =
      two_way_track(answers, kStanding, questions, kCarrier_hz, Eigen::Vector3d::Zero(), params.two_way)
          .track;
  return recorded;
}

double off_rad(const AoaPeak& peak, const PlaneWave& wave) {
  return std::abs(wrap_angle(peak.azimuth_rad - wave.azimuth_rad));
}

/// Error of the nearest peak that is not a cross term.
double nearest_rad(const std::vector<AoaPeak>& peaks, const PlaneWave& wave) {
  double nearest = std::numbers::pi;
  for (const AoaPeak& peak : peaks)
    if (!peak.is_cross_term) nearest = std::min(nearest, off_rad(peak, wave));
  return nearest;
}

AoaPathsRun evaluate(std::uint64_t seed, const Recorded& recorded, const AoaParams& params) {
  AoaPathsRun run{seed, false, 0, std::numbers::pi, std::numbers::pi, 0};
  if (!recorded.track) return run;
  const auto result = estimate_aoa(*recorded.track, recorded.trajectory, recorded.trajectory.front().stamp,
                                   recorded.trajectory.back().stamp, params);
  if (!result.estimate) return run;
  const auto& peaks = result.estimate->peaks;
  run.measured = true;
  for (const PlaneWave& wave : recorded.waves)
    if (nearest_rad(peaks, wave) <= kFound_rad) ++run.found;
  run.direct_error_rad = nearest_rad(peaks, recorded.waves.front());
  run.strongest_error_rad = off_rad(peaks.front(), recorded.waves.front());
  run.cross_terms = static_cast<int>(
      std::count_if(peaks.begin(), peaks.end(), [](const AoaPeak& peak) { return peak.is_cross_term; }));
  return run;
}

std::vector<std::string> profiles_of(const std::string& only) {
  if (!only.empty()) return {only};
  return {kProfiles.begin(), kProfiles.end()};
}

std::vector<AoaPathsCell> empty_table(std::size_t seeds, const std::vector<std::string>& profiles) {
  std::vector<AoaPathsCell> cells;
  for (const AoaCards cards : kCards)
    for (const std::string& profile : profiles)
      cells.push_back({profile, cards, std::vector<AoaPathsRun>(seeds)});
  return cells;
}

std::string share_text(const std::vector<AoaPathsRun>& runs, bool (*holds)(const AoaPathsRun&)) {
  const auto count = std::count_if(runs.begin(), runs.end(), holds);
  return percent_text(static_cast<double>(count) / static_cast<double>(runs.size()), 1);
}

}  // namespace

const char* word_for(AoaCards cards) {
  return cards == AoaCards::kIdeal ? "no carrier offset or jitter" : "carrier offset and jitter";
}

std::vector<AoaPathsCell> measure_aoa_paths(int seeds, std::uint64_t first_seed, const AoaParams& params,
                                            const Progress& progress, const std::string& profile) {
  const auto count = static_cast<std::size_t>(seeds);
  const std::vector<std::string> profiles = profiles_of(profile);
  std::vector<AoaPathsCell> cells = empty_table(count, profiles);
  const std::size_t batch = std::max<std::size_t>(thread_count(), 1) * 2;
  for (std::size_t done = 0; done < count; done += batch) {
    report_progress(progress, "aoa-paths", static_cast<double>(done) / static_cast<double>(count));
    parallel_for(std::min(batch, count - done), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = done + begin; k < done + end; ++k)
        for (std::size_t c = 0; c < cells.size(); c += profiles.size()) {
          const std::uint64_t seed = first_seed + k;
          const Recorded recorded = record(seed, cells[c].cards, params);
          for (std::size_t p = 0; p < profiles.size(); ++p) {
            AoaParams by_profile = params;
            by_profile.profile = profiles[p];
            cells[c + p].runs[k] = evaluate(seed, recorded, by_profile);
          }
        }
    });
  }
  return cells;
}

StudyTable aoa_paths_table(const std::vector<AoaPathsCell>& cells) {
  StudyTable table{"Three paths at once",
                   "Three plane waves 25 degrees apart, at 20 dB SNR, over an arc of one metre. The direct "
                   "one is strongest, the others are up to 6 dB weaker.",
                   {"runs", "all three within 5°", "direct within 2°", "strongest within 2° of it",
                    "median error of it, °", "ghosts named per run"},
                   {},
                   {}};
  for (const AoaPathsCell& cell : cells) {
    const auto& runs = cell.runs;
    double cross_terms = 0;
    std::vector<double> errors;
    for (const AoaPathsRun& run : runs) {
      cross_terms += run.cross_terms;
      errors.push_back(run.direct_error_rad / kRadiansPerDegree);
    }
    table.rows.push_back(
        {cell.profile + std::string(", ") + word_for(cell.cards),
         {number_text(static_cast<double>(runs.size()), 0),
          share_text(runs, [](const AoaPathsRun& run) { return run.found == 3; }),
          share_text(runs, [](const AoaPathsRun& run) { return run.direct_error_rad <= kDirect_rad; }),
          share_text(runs, [](const AoaPathsRun& run) { return run.strongest_error_rad <= kDirect_rad; }),
          number_text(median_of(std::move(errors)), 2),
          number_text(cross_terms / static_cast<double>(runs.size()), 2)}});
  }
  table.notes = {
      "A path is found if a peak that is not marked as a cross term is within 5 degrees of it; the direct "
      "path's error is that of the nearest such peak, or 180 degrees without one.",
      "Ghosts are cross terms: products of two paths, which two-way channels contain in addition to the "
      "paths."};
  return table;
}

}  // namespace radioslam
