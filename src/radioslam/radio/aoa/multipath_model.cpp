#include "radioslam/radio/aoa/multipath_model.hpp"

#include <algorithm>
#include <numbers>

#include "radioslam/geometry/linear_algebra.hpp"

namespace radioslam {
namespace {

/// A path of unit amplitude as the outer product of these vectors.
struct Atom {
  Eigen::VectorXcd over_snapshots;
  Eigen::RowVectorXcd over_subcarriers;
};

Atom atom_of(const WavePath& path, const SyntheticArray& array) {
  Atom atom{Eigen::VectorXcd(array.positions_m.cols()),
            Eigen::RowVectorXcd(static_cast<Eigen::Index>(array.subcarrier_hz.size()))};
  for (Eigen::Index k = 0; k < atom.over_snapshots.size(); ++k)
    atom.over_snapshots[k] =
        std::polar(1.0, -array.wavenumber_radpm * excess_path_m(path.source, array.positions_m.col(k)));
  for (Eigen::Index s = 0; s < atom.over_subcarriers.size(); ++s)
    atom.over_subcarriers[s] = std::polar(
        1.0, -2 * std::numbers::pi * array.subcarrier_hz[static_cast<std::size_t>(s)] * path.delay_s);
  return atom;
}

Eigen::VectorXcd amplitudes(const std::vector<Atom>& atoms, const Eigen::MatrixXcd& channel) {
  const auto n = std::ssize(atoms);
  Eigen::MatrixXcd gram(n, n);
  Eigen::VectorXcd right(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Atom& a = atoms[static_cast<std::size_t>(i)];
    right[i] = (a.over_snapshots.adjoint() * channel * a.over_subcarriers.adjoint()).value();
    for (Eigen::Index j = 0; j < n; ++j) {
      const Atom& b = atoms[static_cast<std::size_t>(j)];
      gram(i, j) = a.over_snapshots.dot(b.over_snapshots) * a.over_subcarriers.dot(b.over_subcarriers);
    }
  }
  return ldlt_solve(gram, right);
}

}  // namespace

std::vector<WavePath> find_paths(const SyntheticArray& array, const WaveGrid& grid, const DelayTable& delays,
                                 int count) {
  std::vector<WavePath> paths;
  std::vector<Atom> atoms;
  SyntheticArray residual = array;
  for (int k = 0; k < count; ++k) {
    const ArrayBeams beams = array_beams(residual, grid, delays);
    const auto best = std::max_element(beams.power.begin(), beams.power.end()) - beams.power.begin();
    WavePath path{grid.source(static_cast<std::size_t>(best)),
                  delays.delay_s(beams.best_delay[static_cast<std::size_t>(best)]), 0};
    atoms.push_back(atom_of(path, array));
    paths.push_back(path);
    const Eigen::VectorXcd c = amplitudes(atoms, array.channel);
    residual.channel = array.channel;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      paths[i].amplitude = c[static_cast<Eigen::Index>(i)];
      residual.channel -= paths[i].amplitude * atoms[i].over_snapshots * atoms[i].over_subcarriers;
    }
  }
  return paths;
}

std::vector<WavePath> refine_paths(std::vector<WavePath> paths, const SyntheticArray& array,
                                   const DelayTable& delays, const SourceBounds& bounds, int rounds) {
  std::vector<Atom> atoms;
  for (const WavePath& path : paths) atoms.push_back(atom_of(path, array));
  const auto solve = [&] {
    const Eigen::VectorXcd c = amplitudes(atoms, array.channel);
    for (std::size_t i = 0; i < paths.size(); ++i) paths[i].amplitude = c[static_cast<Eigen::Index>(i)];
  };
  solve();
  for (int round = 0; round < rounds; ++round)
    for (std::size_t i = 0; i < paths.size(); ++i) {
      SyntheticArray alone = array;
      for (std::size_t j = 0; j < paths.size(); ++j)
        if (j != i) alone.channel -= paths[j].amplitude * atoms[j].over_snapshots * atoms[j].over_subcarriers;
      const BeamObjective objective({alone}, delays, paths[i].source);
      paths[i].source = objective.climb(paths[i].source, bounds);
      atoms[i] = atom_of(paths[i], array);
      paths[i].delay_s = delays.best_delay_s(atoms[i].over_snapshots.adjoint() * alone.channel);
      atoms[i] = atom_of(paths[i], array);
      solve();
    }
  return paths;
}

Eigen::MatrixXcd channel_of(const std::vector<WavePath>& paths, const SyntheticArray& array) {
  Eigen::MatrixXcd channel =
      Eigen::MatrixXcd::Zero(array.positions_m.cols(), static_cast<Eigen::Index>(array.subcarrier_hz.size()));
  for (const WavePath& path : paths) {
    const Atom atom = atom_of(path, array);
    channel += path.amplitude * atom.over_snapshots * atom.over_subcarriers;
  }
  return channel;
}

}  // namespace radioslam
