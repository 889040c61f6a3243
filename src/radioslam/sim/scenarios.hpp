// The scenarios that can be simulated, by name: what `simulate SCENARIO` offers.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>
#include <variant>

#include "radioslam/sim/carpark.hpp"
#include "radioslam/sim/city.hpp"
#include "radioslam/sim/corridors.hpp"
#include "radioslam/sim/csi_room.hpp"
#include "radioslam/sim/hall.hpp"
#include "radioslam/sim/kitti.hpp"
#include "radioslam/sim/simulation.hpp"

namespace radioslam {

/// The parameters of any scenario; one alternative each.
using ScenarioParams =
    std::variant<CarparkParams, CityParams, CorridorsParams, CsiRoomParams, HallParams, KittiParams>;

/// Does a scenario need a recorded drive?
inline bool needs_recording(const ScenarioParams& params) {
  return std::holds_alternative<KittiParams>(params);
}

/// A kind of world with robots in it.
struct Scenario {
  std::string_view name;
  std::string_view description;  ///< one line
  ScenarioParams defaults;
};

/// All scenarios, in the order in which to list them.
std::span<const Scenario> scenarios();

/// The scenario of that name, or none.
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

/// Runs the scenario that the parameters belong to; `drive` must be there if it needs a recording.
Simulation simulate(const ScenarioParams& params, std::uint64_t seed, const RecordedDrive& drive = {});

}  // namespace radioslam
