#include "radioslam/rendezvous_world/run_json.hpp"

#include <cmath>

namespace radioslam {

using Json = nlohmann::ordered_json;

Json rendezvous_run_json(const RendezvousRun& run) {
  Json crossings = Json::array();
  for (const ErrorCrossing& each : run.crossings)
    crossings.push_back({{"iteration", each.iteration},
                         {"robot", each.robot},
                         {"before", each.before},
                         {"after", each.after}});
  return {{"error", run.error},
          {"error_std", run.error_std},
          {"sigma_m", run.sigma_m},
          {"ate_rmse_m", std::sqrt(run.ate_trans_mean_squared)},
          {"ate_trans_mean_squared", run.ate_trans_mean_squared},
          {"ate_rot_mean_squared", run.ate_rot_mean_squared},
          {"meetings", run.meetings},
          {"metres_walked", run.metres_walked},
          {"crossings", std::move(crossings)},
          {"open_crossings", run.open_crossings},
          {"delta", run.delta},
          {"nees", run.nees},
          {"covered_m2", run.covered_m2},
          {"iterations", run.iterations},
          {"seconds", run.seconds}};
}

}  // namespace radioslam
