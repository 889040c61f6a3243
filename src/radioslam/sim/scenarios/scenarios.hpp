// Registry of the scenarios that `simulate SCENARIO` offers, by name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "radioslam/sim/scenarios/carpark.hpp"
#include "radioslam/sim/scenarios/city.hpp"
#include "radioslam/sim/scenarios/corridors.hpp"
#include "radioslam/sim/scenarios/csi_room.hpp"
#include "radioslam/sim/scenarios/hall.hpp"
#include "radioslam/sim/scenarios/kitti.hpp"
#include "radioslam/sim/scenarios/simulation.hpp"

namespace radioslam {

/// The parameters of any scenario; one alternative each.
using ScenarioParams =
    std::variant<CarparkParams, CityParams, CorridorsParams, CsiRoomParams, HallParams, KittiParams>;

/// Whether a scenario needs a recorded drive.
inline bool needs_recording(const ScenarioParams& params) {
  return std::holds_alternative<KittiParams>(params);
}

/// A scenario's name, description and default parameters.
struct Scenario {
  std::string_view name;
  std::string_view description;  ///< one line
  ScenarioParams defaults;
};

/// All scenarios, in the order in which to list them.
std::span<const Scenario> scenarios();

/// The scenario of that name, or null.
const Scenario* find_scenario(std::string_view name);

/// Calls visit(const Field&, value&) for every parameter of a scenario.
template <class Visitor>
void visit_scenario_fields(ScenarioParams& params, Visitor&& visit) {
  std::visit([&](auto& chosen) { std::decay_t<decltype(chosen)>::visit_fields(chosen, visit); }, params);
}
template <class Visitor>
void visit_scenario_fields(const ScenarioParams& params, Visitor&& visit) {
  std::visit([&](const auto& chosen) { std::decay_t<decltype(chosen)>::visit_fields(chosen, visit); },
             params);
}

/// Runs the scenario that the parameters belong to; `drive` is required if it needs a recording.
Simulation simulate(const ScenarioParams& params, std::uint64_t seed, const RecordedDrive& drive = {});

}  // namespace radioslam
