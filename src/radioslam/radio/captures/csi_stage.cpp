#include "radioslam/radio/captures/csi_stage.hpp"

#include <algorithm>
#include <optional>

#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/captures/csi_aoa.hpp"
#include "radioslam/radio/captures/csi_tracks.hpp"

namespace radioslam {
namespace {

/// Outcome of an attempt.
struct Attempted {
  std::optional<AoaEstimate> estimate;
  std::string reason;  ///< why there is no estimate
};

Attempted measure(const Mission& mission, const CsiTracks& tracks, const CsiAttempt& attempt,
                  const AoaParams& params) {
  auto [track, reason] = tracks.track_of(attempt);
  if (!track) return {std::nullopt, std::move(reason)};
  AoaResult result = estimate_aoa(*track, mission.robots[attempt.receiver].odometry, attempt.window.begin,
                                  attempt.window.end, params);
  if (!result.estimate) return {std::nullopt, explain(result.reason)};
  return {std::move(result.estimate), {}};
}

CsiRefusals count_refusals(const std::vector<CsiAttempt>& attempts, const std::vector<Attempted>& attempted) {
  CsiRefusals counts;
  for (std::size_t k = 0; k < attempts.size(); ++k)
    if (!attempted[k].estimate)
      ++counts[{attempts[k].receiver, attempts[k].transmitter, attempted[k].reason}];
  return counts;
}

}  // namespace

MeasuredCsi measure_csi(const Mission& mission, const CsiStageParams& params, const Progress& progress) {
  MeasuredCsi result;
  const auto has_csi = [](const Robot& robot) { return robot.csi && !robot.csi->captures.empty(); };
  if (std::none_of(mission.robots.begin(), mission.robots.end(), has_csi)) return result;
  CsiTracks tracks(mission, params, result.notes);
  if (params.clock_offset) tracks.set_clocks(result.notes);
  std::vector<CsiAttempt> attempts = tracks.attempts();
  std::stable_sort(attempts.begin(), attempts.end(),
                   [](const CsiAttempt& a, const CsiAttempt& b) { return a.window.begin < b.window.begin; });
  std::vector<Attempted> attempted(attempts.size());
  constexpr std::size_t kRound = 16;
  for (std::size_t done = 0; done < attempts.size(); done += kRound) {
    report_progress(progress, "angles of arrival",
                    static_cast<double>(done) / static_cast<double>(attempts.size()));
    parallel_for(std::min(kRound, attempts.size() - done), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = done + begin; k < done + end; ++k)
        attempted[k] = measure(mission, tracks, attempts[k], params.aoa);
    });
  }
  for (std::size_t k = 0; k < attempts.size(); ++k) {
    if (!attempted[k].estimate) continue;
    AoaMeasurement measured = measurement_of(mission, attempts[k], *attempted[k].estimate);
    result.profiles.push_back(profile_of(mission, attempts[k], *attempted[k].estimate));
    result.profiles.back().paths = measured.paths;
    result.aoa_measurements.push_back(std::move(measured));
  }
  note_refusals(mission, count_refusals(attempts, attempted), result.notes);
  return result;
}

}  // namespace radioslam
