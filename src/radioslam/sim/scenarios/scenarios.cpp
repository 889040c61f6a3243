#include "radioslam/sim/scenarios/scenarios.hpp"

#include <array>

namespace radioslam {
namespace {

/// Runs the scenario of its argument's type.
struct Simulate {
  std::uint64_t seed;
  const RecordedDrive& drive;

  Simulation operator()(const CarparkParams& params) const { return simulate_carpark(params, seed); }
  Simulation operator()(const CityParams& params) const { return simulate_city(params, seed); }
  Simulation operator()(const CorridorsParams& params) const { return simulate_corridors(params, seed); }
  Simulation operator()(const CsiRoomParams& params) const { return simulate_csi_room(params, seed); }
  Simulation operator()(const HallParams& params) const { return simulate_hall(params, seed); }
  Simulation operator()(const KittiParams& params) const { return simulate_kitti(params, drive, seed); }
};

}  // namespace

std::span<const Scenario> scenarios() {
  static const std::array<Scenario, 6> all{
      {{"carpark", "robots on the lanes of a car park: wheel odometry and WiFi scans", CarparkParams{}},
       {"city", "robots on the streets of a town: ranges and angles of arrival, unknown starts",
        CityParams{}},
       {"corridors", "robots in featureless corridors: scans and IMU samples, ranges and angles of arrival",
        CorridorsParams{}},
       {"csi", "robots that take turns to drive in a room: CSI of their packets, a few ranges",
        CsiRoomParams{}},
       {"hall", "robots between identical pillars: few links, aliased matches", HallParams{}},
       {"kitti", "a recorded drive cut in two: simulated ranges and angles of arrival", KittiParams{}}}};
  return all;
}

const Scenario* find_scenario(std::string_view name) {
  for (const auto& scenario : scenarios())
    if (scenario.name == name) return &scenario;
  return nullptr;
}

Simulation simulate(const ScenarioParams& params, std::uint64_t seed, const RecordedDrive& drive) {
  return std::visit(Simulate{seed, drive}, params);
}

}  // namespace radioslam
