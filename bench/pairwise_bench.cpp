// Pairwise consistency of all pairs of matches between two trajectories; the argument is the number of
// matches.
#include <benchmark/benchmark.h>

#include "radioslam/base/random.hpp"
#include "radioslam/consistency/odometry_chain.hpp"
#include "radioslam/consistency/pairwise.hpp"

namespace radioslam {
namespace {

template <class Pose>
typename Pose::Tangent noise(Rng& rng, double sigma) {
  typename Pose::Tangent xi;
  for (int k = 0; k < Pose::kDof; ++k) xi[k] = rng.normal(0, sigma);
  return xi;
}

template <class Pose>
OdometryChain<Pose> walk(Rng& rng, std::size_t poses) {
  std::vector<Pose> chain(1);
  while (chain.size() < poses) chain.push_back(chain.back() * Pose::exp(noise<Pose>(rng, 0.3)));
  return {chain, std::vector(poses - 1, typename Pose::Jacobian(0.01 * Pose::Jacobian::Identity()))};
}

template <class Pose>
void all_pairs(benchmark::State& state) {
  constexpr std::size_t kPoses = 1000;
  Rng rng(1);
  const auto a = walk<Pose>(rng, kPoses), b = walk<Pose>(rng, kPoses);
  std::vector<RelativePoseMatch<Pose>> matches(static_cast<std::size_t>(state.range(0)));
  for (auto& match : matches)
    match = {rng.below(kPoses), rng.below(kPoses), Pose::exp(noise<Pose>(rng, 1)),
             Pose::Jacobian::Identity()};
  for (auto _ : state) benchmark::DoNotOptimize(pairwise_consistency(a, b, matches).statistics.data());
}

BENCHMARK(all_pairs<SE2>)->Arg(500)->Arg(2000)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(all_pairs<SE3>)->Arg(500)->Arg(2000)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace radioslam
