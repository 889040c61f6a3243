#include "radioslam/rendezvous_world/rendezvous_run.hpp"

#include <chrono>

#include "radioslam/rendezvous_world/run_record.hpp"
#include "radioslam/rendezvous_world/simulated_team.hpp"

namespace radioslam {
namespace {

constexpr int kIterationsPerStep = 20;  ///< where metres count, not iterations: before a run is given up

}  // namespace

RendezvousRun run_rendezvous(const RendezvousRunParams& params, const RendezvousRunOptions& options,
                             const Progress& progress) {
  const auto begin = std::chrono::steady_clock::now();
  const int limit = params.metres_each > 0
                        ? static_cast<int>(kIterationsPerStep * params.metres_each / params.step_m)
                        : params.iterations;
  SimulatedTeam team(params, options);
  RunRecord record(team, params.sensing_range_m);
  for (int iteration = 1; iteration <= limit && !team.all_have_walked(); ++iteration) {
    report_progress(progress, "iterations", static_cast<double>(iteration - 1) / limit);
    team.step();
    record.add(team, options.keep_moments);
  }
  RendezvousRun run = record.conclude(team);
  run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return run;
}

}  // namespace radioslam
