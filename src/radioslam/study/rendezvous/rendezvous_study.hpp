// The figures of Wang et al. (Active Rendezvous) that simulation can answer, beside simulated teams: error
// over time (4, 7, 8), true error against chance meetings (6), angles of arrival and outliers (10); how run
// time grows with the team; and runs to replay. Cost: about two minutes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "radioslam/base/progress.hpp"
#include "radioslam/rendezvous_world/rendezvous_run.hpp"
#include "radioslam/study/study_table.hpp"

namespace radioslam {

/// Runs of one policy, or of one way to weigh measurements, on the same floors.
struct RendezvousSeries {
  std::string name;
  std::vector<RendezvousRun> runs;  ///< per seed
};

/// A published figure, and the runs that answer it.
struct RendezvousFigure {
  std::string title, caption;
  std::vector<RendezvousSeries> series;
};

struct AngleErrors {
  double sigma_rad = 0;               ///< that was drawn
  std::vector<double> strongest_rad;  ///< strongest arrival against the true direction, per packet
};

struct TeamGrowth {
  int robots = 0;
  double seconds = 0;
};

/// A run to be shown on a map.
struct RendezvousReplay {
  std::string name;
  RendezvousRunParams params;
  Arena arena;
  RendezvousRun run;
};

struct RendezvousStudy {
  RendezvousFigure team_error;                  ///< figure 4
  RendezvousFigure true_error;                  ///< figure 6
  std::vector<RendezvousFigure> trial, trials;  ///< figures 7 and 8; open and with obstacles
  std::vector<RendezvousFigure> outliers;       ///< figure 10 a, per kind
  AngleErrors angles;                           ///< figure 10 b
  std::vector<TeamGrowth> growth;
  std::vector<RendezvousReplay> replays;
};

/// `seeds`: of figure 6 and the outliers; the others have as many as published.
RendezvousStudy study_rendezvous(std::uint64_t seed, int seeds, const Progress& progress = {});

StudyTable rendezvous_table(const RendezvousStudy& study);

}  // namespace radioslam
