#include "radioslam/radio/aoa/steering_sums.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "radio/aoa/waves.hpp"

namespace radioslam {
namespace {

using namespace waves;

struct NamedKernel {
  const char* name;
  BeamKernel kernel;
};

std::vector<NamedKernel> kernels() {
  std::vector<NamedKernel> all{{"narrow", beam_kernel_sse2()}};
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) all.push_back({"wide", beam_kernel_avx2()});
#endif
  return all;
}

Eigen::Matrix3Xd places(int snapshots, Rng& rng) {
  Eigen::Matrix3Xd positions(3, snapshots);
  for (int k = 0; k < snapshots; ++k)
    positions.col(k) =
        Eigen::Vector3d(rng.uniform(-0.8, 0.8), rng.uniform(-0.8, 0.8), rng.uniform(-0.3, 0.3));
  return positions;
}

BeamDirection direction_to(const WaveSource& source) {
  const Eigen::Vector3f u = towards(source).cast<float>();
  return {u.x(), u.y(), u.z(), static_cast<float>(source.curvature_per_m)};
}

/// Plane waves and waves from 1 to 20 m in all directions.
std::vector<WaveSource> sources(Rng& rng) {
  std::vector<WaveSource> list{{0.3, 0, 0}, {-3, 0.5, 0}, {1.2, -0.2, 1}};
  for (int k = 0; k < 12; ++k)
    list.push_back({rng.uniform(-std::numbers::pi, std::numbers::pi), rng.uniform(-1, 1),
                    k % 2 == 0 ? 0 : rng.uniform(0.05, 1)});
  return list;
}

std::complex<double> direct_sum(const Eigen::Matrix3Xd& positions, const Eigen::VectorXcd& signal,
                                const WaveSource& source) {
  std::complex<double> z = 0;
  for (Eigen::Index k = 0; k < signal.size(); ++k)
    z += signal[k] * std::polar(1.0, kWavenumber_radpm * further_m(source, positions.col(k)));
  return z;
}

struct Shape {
  int snapshots, signals;
};

/// Sizes around multiples of eight and of the kernel's chunks of 256.
const std::vector<Shape> kShapes{{1, 1},   {7, 2},   {8, 3},   {13, 4},  {61, 5},
                                 {255, 6}, {256, 7}, {257, 8}, {300, 1}, {777, 8}};

std::vector<BeamSum> sums_of(BeamKernel kernel, const BeamInput& input, const std::vector<WaveSource>& from) {
  std::vector<BeamDirection> directions;
  for (const WaveSource& source : from) directions.push_back(direction_to(source));
  std::vector<BeamSum> sums(from.size());
  std::memset(static_cast<void*>(sums.data()), 0x7f, sums.size() * sizeof(BeamSum));  // stale memory
  kernel(input, directions.data(), directions.size(), sums.data());
  return sums;
}

TEST(BeamSums, AreTheDirectSums) {
  Rng rng(1);
  for (const Shape& shape : kShapes) {
    const Eigen::Matrix3Xd positions = places(shape.snapshots, rng);
    const Eigen::MatrixXcd signals = noise(shape.snapshots, shape.signals, 3, rng);
    const BeamInput input = beam_input(positions, kWavenumber_radpm, signals);
    const auto from = sources(rng);
    for (const auto& [name, kernel] : kernels()) {
      const auto sums = sums_of(kernel, input, from);
      for (std::size_t d = 0; d < from.size(); ++d)
        for (Eigen::Index r = 0; r < shape.signals; ++r) {
          const auto z = std::complex<double>(sums[d].z[static_cast<std::size_t>(r)]);
          const auto truth = direct_sum(positions, signals.col(r), from[d]);
          EXPECT_LT(std::abs(z - truth), 1e-4 * signals.col(r).cwiseAbs().sum())
              << name << ' ' << shape.snapshots << " snapshots, source " << d << ", signal " << r;
        }
    }
  }
}

TEST(BeamSums, AreTheSameBytesOfEveryKernel) {
  const auto all = kernels();
  if (all.size() < 2) GTEST_SKIP() << "this machine has one kernel";
  Rng rng(2);
  for (const Shape& shape : kShapes) {
    const BeamInput input = beam_input(places(shape.snapshots, rng), kWavenumber_radpm,
                                       noise(shape.snapshots, shape.signals, 1, rng));
    const auto from = sources(rng);
    const auto narrow = sums_of(all[0].kernel, input, from), wide = sums_of(all[1].kernel, input, from);
    EXPECT_EQ(std::memcmp(narrow.data(), wide.data(), narrow.size() * sizeof(BeamSum)), 0)
        << shape.snapshots << " snapshots, " << shape.signals << " signals";
  }
}

TEST(BeamSums, OfAWaveAtItsOwnSourceAddUp) {
  const Wave wave{{2.5, 0.1, 0.4}, 0, {0, 2}};
  const SyntheticArray array = array_of({wave}, arc(101, 0.5, 2));
  const BeamInput input = beam_input(array.positions_m, kWavenumber_radpm, array.channel.leftCols(1));
  EXPECT_EQ(input.padded, 104U);
  const auto sums = sums_of(beam_kernel(), input, {wave.source});
  EXPECT_NEAR(std::abs(std::complex<double>(sums[0].z[0]) - std::complex<double>(0, 202)), 0, 0.02);
}

TEST(BeamSums, OfUnusedSignalsAreZero) {
  Rng rng(3);
  const BeamInput input = beam_input(places(20, rng), kWavenumber_radpm, noise(20, 3, 1, rng));
  for (const auto& [name, kernel] : kernels())
    for (const BeamSum& sum : sums_of(kernel, input, sources(rng)))
      for (std::size_t r = 3; r < BeamInput::kMaxSignals; ++r)
        EXPECT_EQ(sum.z[r], std::complex<float>(0)) << name;
}

}  // namespace
}  // namespace radioslam
