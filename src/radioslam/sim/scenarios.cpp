#include "radioslam/sim/scenarios.hpp"

#include <array>

namespace radioslam {
namespace {

Simulation simulate_one(const CarparkParams& params, std::uint64_t seed) {
  return simulate_carpark(params, seed);
}

}  // namespace

std::span<const Scenario> scenarios() {
  static const std::array<Scenario, 1> all{
      {{"carpark", "robots on the lanes of a car park, wheel odometry and WiFi scans", CarparkParams{}}}};
  return all;
}

const Scenario* find_scenario(std::string_view name) {
  for (const auto& scenario : scenarios())
    if (scenario.name == name) return &scenario;
  return nullptr;
}

Simulation simulate(const ScenarioParams& params, std::uint64_t seed) {
  return std::visit([&](const auto& chosen) { return simulate_one(chosen, seed); }, params);
}

}  // namespace radioslam
