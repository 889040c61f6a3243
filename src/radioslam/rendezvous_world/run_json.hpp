// A simulated team's run as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "radioslam/rendezvous_world/rendezvous_run.hpp"

namespace radioslam {

/// What `radioslam rendezvous --json` prints of a run.
nlohmann::ordered_json rendezvous_run_json(const RendezvousRun& run);

}  // namespace radioslam
