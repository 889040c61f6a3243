// Inertial smoothing, noise inflation and motion prediction on drives of up to 1,000 s with scans at 10 Hz
// and IMU samples at 200 Hz.
#include <benchmark/benchmark.h>

#include "inertial/simulated_drive.hpp"
#include "radioslam/inertial/odometry_noise_inflation.hpp"
#include "radioslam/inertial/preintegration.hpp"

namespace radioslam {
namespace {

test::SimulatedDrive long_drive(double duration_s) {
  test::DrivePlan plan;
  plan.duration_s = duration_s;
  return test::simulate_drive(plan, {}, {}, Rng(1));
}

void smoother(benchmark::State& state) {
  const auto sim = long_drive(static_cast<double>(state.range(0)));
  int iterations = 0;
  for (auto _ : state) {
    const auto smoothed = smooth_inertially(sim.drive, sim.samples, {}, {});
    iterations = smoothed->iterations;
    benchmark::DoNotOptimize(smoothed);
  }
  state.counters["iterations"] = iterations;
}
BENCHMARK(smoother)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

void noise_of_states(benchmark::State& state) {
  const auto sim = long_drive(static_cast<double>(state.range(0)));
  const auto smoothed = smooth_inertially(sim.drive, sim.samples, {}, {});
  for (auto _ : state) benchmark::DoNotOptimize(odometry_noise_inflation(*smoothed, {}));
}
BENCHMARK(noise_of_states)->Arg(100)->Arg(1000)->Unit(benchmark::kMillisecond);

/// Predicts 20 poses within a scan of 0.1 s.
void prediction(benchmark::State& state) {
  const auto sim = long_drive(10);
  std::vector<Stamp> stamps;
  for (int k = 1; k <= 20; ++k) stamps.push_back(Stamp::from_seconds(5 + 0.005 * k));
  for (auto _ : state)
    benchmark::DoNotOptimize(predict_motion(sim.truth[50], sim.drive.stamps[50], sim.samples, stamps, {}));
}
BENCHMARK(prediction)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace radioslam
