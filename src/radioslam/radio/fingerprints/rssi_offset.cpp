#include "radioslam/radio/fingerprints/rssi_offset.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/statistics.hpp"
#include "radioslam/consistency/chi_squared.hpp"
#include "radioslam/geometry/linear_algebra.hpp"
#include "radioslam/radio/fingerprints/shared_access_points.hpp"

namespace radioslam {
namespace {

constexpr double kHuber = 1.345;         // 95 % efficient on normal residuals (Huber 1981)
constexpr double kRankTolerance = 1e-9;  // relative to the largest eigenvalue
constexpr std::size_t kMinRowsTogether = 16, kMaxBlocks = 64;  // in the table of two robots' fingerprints
constexpr std::size_t kBlocksAtOnce = 256;
constexpr double kMinSpread_db = 1e-3;  // readings are integers: identical ones need a nonzero scale

/// An access point that both fingerprints of a pair detected.
struct SharedReading {
  double difference_db = 0;  ///< first minus second
  double sum_dbm = 0;
  double detection = 0;  ///< sum of both rates
};

std::vector<SharedReading> shared_readings(const Fingerprint& a, const Fingerprint& b) {
  std::vector<SharedReading> shared;
  for_each_shared(a, b, [&](const FingerprintEntry& x, const FingerprintEntry& y) {
    const double first = static_cast<double>(x.rss_dbm), second = static_cast<double>(y.rss_dbm);
    shared.push_back(
        {first - second, first + second, static_cast<double>(x.detection_rate + y.detection_rate)});
  });
  return shared;
}

/// Gaussian similarity that is invariant to an offset, in one pass over both lists.
double offset_free_similarity(const Fingerprint& a, const Fingerprint& b, const SimilarityParams& params) {
  double shared = 0, sum = 0, squares = 0;
  for_each_shared(a, b, [&](const FingerprintEntry& x, const FingerprintEntry& y) {
    const double d = static_cast<double>(x.rss_dbm) - static_cast<double>(y.rss_dbm);
    shared += 1;
    sum += d;
    squares += d * d;
  });
  if (shared < std::max(2, params.min_shared)) return 0;
  const double variance = std::max(0.0, squares - sum * sum / shared) / (shared - 1);
  const double all = static_cast<double>(a.entries.size() + b.entries.size()) - shared;
  return std::exp(-variance / (2 * params.sigma_rss_db * params.sigma_rss_db)) * shared / all;
}

/// Mean difference over the access points with the highest detection rates, then the highest RSS.
double rssi_difference_db(const Fingerprint& a, const Fingerprint& b, int strongest) {
  std::vector<SharedReading> shared = shared_readings(a, b);
  std::stable_sort(shared.begin(), shared.end(), [](const SharedReading& x, const SharedReading& y) {
    return std::tie(x.detection, x.sum_dbm) > std::tie(y.detection, y.sum_dbm);
  });
  shared.resize(std::min(shared.size(), static_cast<std::size_t>(strongest)));
  double sum_db = 0;
  for (const SharedReading& reading : shared) sum_db += reading.difference_db;
  return sum_db / static_cast<double>(shared.size());
}

/// Two colocated fingerprints and their RSS difference.
struct ColocatedPair {
  std::size_t robot_a = 0, robot_b = 0;
  std::size_t i = 0, j = 0;  ///< indices of the fingerprints
  double difference_db = 0;  ///< readings of a minus those of b
};

/// The most similar fingerprint of a range, the first on ties.
struct MostSimilar {
  double similarity = 0;
  std::size_t of = 0;
};

/// A block of rows in the table of two robots' fingerprints, compared by one task.
struct RowBlock {
  std::size_t a = 0, b = 0;        ///< robots
  std::size_t begin = 0, end = 0;  ///< fingerprints of a
  std::vector<MostSimilar> of_i;   ///< per row, over all fingerprints of b
  std::vector<MostSimilar> of_j;   ///< per fingerprint of b, over the block's rows
};

void compare_rows(RowBlock& block, const std::vector<std::vector<Fingerprint>>& robots,
                  const SimilarityParams& similarity) {
  const auto &of_a = robots[block.a], &of_b = robots[block.b];
  block.of_i.resize(block.end - block.begin);
  block.of_j.resize(of_b.size());
  for (std::size_t i = block.begin; i < block.end; ++i)
    for (std::size_t j = 0; j < of_b.size(); ++j) {
      const double s = offset_free_similarity(of_a[i], of_b[j], similarity);
      MostSimilar &row = block.of_i[i - block.begin], &column = block.of_j[j];
      if (s > row.similarity) row = {s, j};
      if (s > column.similarity) column = {s, i};
    }
}

/// The rows of two robots' table in several blocks, so that two robots keep many threads busy.
std::vector<RowBlock> row_blocks(const std::vector<std::vector<Fingerprint>>& robots, std::size_t a,
                                 std::size_t b) {
  const std::size_t rows = robots[a].size();
  const std::size_t together = std::max(kMinRowsTogether, (rows + kMaxBlocks - 1) / kMaxBlocks);
  std::vector<RowBlock> blocks;
  for (std::size_t begin = 0; begin < rows; begin += together)
    blocks.push_back({a, b, begin, std::min(rows, begin + together), {}, {}});
  return blocks;
}

/// Mutual best matches of two robots' fingerprints, from all blocks of their table.
std::vector<ColocatedPair> mutual_pairs(const RowBlock* first, const RowBlock* last,
                                        const std::vector<std::vector<Fingerprint>>& robots,
                                        const RssiOffsetParams& params) {
  std::vector<MostSimilar> of_j = first->of_j;
  for (const RowBlock* block = first + 1; block != last; ++block)
    for (std::size_t j = 0; j < of_j.size(); ++j)
      if (block->of_j[j].similarity > of_j[j].similarity) of_j[j] = block->of_j[j];
  std::vector<ColocatedPair> pairs;
  for (const RowBlock* block = first; block != last; ++block)
    for (std::size_t i = block->begin; i < block->end; ++i) {
      const auto [s, j] = block->of_i[i - block->begin];
      if (s > 0 && s >= params.min_similarity && of_j[j].of == i)
        pairs.push_back(
            {block->a, block->b, i, j,
             rssi_difference_db(robots[block->a][i], robots[block->b][j], params.strongest_shared)});
    }
  return pairs;
}

/// All pairs of robots, the second with the larger index.
std::vector<std::pair<std::size_t, std::size_t>> robot_pairs(std::size_t robots) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t b = 1; b < robots; ++b)
    for (std::size_t a = 0; a < b; ++a) pairs.emplace_back(a, b);
  return pairs;
}

/// Colocated pairs of the whole team.
std::vector<ColocatedPair> colocated_pairs(const std::vector<std::vector<Fingerprint>>& robots,
                                           const SimilarityParams& similarity,
                                           const RssiOffsetParams& params) {
  const auto of_robots = robot_pairs(robots.size());
  std::vector<ColocatedPair> all;
  for (std::size_t next = 0; next < of_robots.size();) {
    // Only as many blocks at once as keep the threads busy; more would cost memory.
    std::vector<RowBlock> blocks;
    std::vector<std::size_t> ends;
    for (; next < of_robots.size() && blocks.size() < kBlocksAtOnce; ++next) {
      auto of_two = row_blocks(robots, of_robots[next].first, of_robots[next].second);
      std::move(of_two.begin(), of_two.end(), std::back_inserter(blocks));
      ends.push_back(blocks.size());
    }
    parallel_for(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) compare_rows(blocks[k], robots, similarity);
    });
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
      if (end == begin) continue;
      const auto pairs = mutual_pairs(blocks.data() + begin, blocks.data() + end, robots, params);
      if (pairs.size() >= static_cast<std::size_t>(params.min_pairs))
        all.insert(all.end(), pairs.begin(), pairs.end());
      begin = end;
    }
  }
  return all;
}

/// Factor on the covariance for the error of a fingerprint that its pairs share.
double pair_correlation_factor(const std::vector<ColocatedPair>& pairs) {
  std::set<std::pair<std::size_t, std::size_t>> fingerprints;
  for (const ColocatedPair& pair : pairs) {
    fingerprints.emplace(pair.robot_a, pair.i);
    fingerprints.emplace(pair.robot_b, pair.j);
  }
  const double per_fingerprint =
      2 * static_cast<double>(pairs.size()) / static_cast<double>(fingerprints.size());
  return (1 + per_fingerprint) / 2;
}

/// Offsets at the minimum, and the information of the pairs without the prior.
struct OffsetSolution {
  Eigen::VectorXd offsets_db;
  Eigen::MatrixXd information;  ///< 1/dB^2; singular along a common offset of connected robots
};

/// One step of iterative reweighting; `spread_db` is the scale of the pairs' residuals.
OffsetSolution reweighted(const std::vector<ColocatedPair>& pairs, const Eigen::VectorXd& offsets_db,
                          double spread_db, double prior_sigma_db) {
  const Eigen::Index robots = offsets_db.size();
  OffsetSolution next{Eigen::VectorXd::Zero(robots), Eigen::MatrixXd::Zero(robots, robots)};
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(robots);
  for (const ColocatedPair& pair : pairs) {
    const auto a = static_cast<Eigen::Index>(pair.robot_a), b = static_cast<Eigen::Index>(pair.robot_b);
    const double residual = std::abs(pair.difference_db - offsets_db[a] + offsets_db[b]) / spread_db;
    const double weight = kHuber / std::max(residual, kHuber) / (spread_db * spread_db);
    next.information(a, a) += weight;
    next.information(b, b) += weight;
    next.information(a, b) -= weight;
    next.information(b, a) -= weight;
    gradient[a] += weight * pair.difference_db;
    gradient[b] -= weight * pair.difference_db;
  }
  Eigen::MatrixXd posterior = next.information;
  posterior.diagonal().array() += 1 / (prior_sigma_db * prior_sigma_db);
  next.offsets_db = Cholesky<Eigen::MatrixXd>(posterior).solve(gradient);
  return next;
}

double spread_about(const std::vector<ColocatedPair>& pairs, const Eigen::VectorXd& offsets_db) {
  std::vector<double> residuals;
  for (const ColocatedPair& pair : pairs)
    residuals.push_back(std::abs(pair.difference_db - offsets_db[static_cast<Eigen::Index>(pair.robot_a)] +
                                 offsets_db[static_cast<Eigen::Index>(pair.robot_b)]));
  return std::max(kMinSpread_db, kMadToSigma * upper_median(std::move(residuals)));
}

OffsetSolution solve(const std::vector<ColocatedPair>& pairs, std::size_t robots,
                     const RssiOffsetParams& params) {
  OffsetSolution solution{Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robots)), {}};
  for (int k = 0; k < params.max_iterations; ++k)
    solution = reweighted(pairs, solution.offsets_db, spread_about(pairs, solution.offsets_db),
                          params.prior_sigma_db);
  solution.information /= pair_correlation_factor(pairs);
  return solution;
}

/// Observable combinations of the offsets, and their information.
struct ObservableOffsets {
  Eigen::MatrixXd directions;   ///< robots x combinations, orthonormal
  Eigen::VectorXd information;  ///< 1/dB^2
};

/// One combination fewer than robots per connected group: its common offset is unobservable.
ObservableOffsets observable_offsets(const Eigen::MatrixXd& information) {
  const auto eigen = symmetric_eigen(information);
  const Eigen::VectorXd& values = eigen.values;  // ascending
  const double least = kRankTolerance * values[values.size() - 1];
  const Eigen::Index observable = (values.array() > least).count();
  return {eigen.vectors.rightCols(observable), values.tail(observable)};
}

/// Whether the offsets are jointly significant, with a sigma of at least min_sigma_db per robot.
bool offsets_are_significant(const ObservableOffsets& observable, const Eigen::VectorXd& offsets_db,
                             const RssiOffsetParams& params) {
  const Eigen::ArrayXd along = (observable.directions.transpose() * offsets_db).array();
  const Eigen::ArrayXd variance =
      observable.information.array().inverse() + params.min_sigma_db * params.min_sigma_db;
  const double statistic = (along.square() / variance).sum();
  return chi_squared_tail(statistic, static_cast<int>(along.size())) < params.false_alarm_probability;
}

/// Standard deviation of each robot's offset from the mean of its connected group.
Eigen::VectorXd sigmas_db(const ObservableOffsets& observable, const RssiOffsetParams& params) {
  const double prior = 1 / (params.prior_sigma_db * params.prior_sigma_db);
  const Eigen::VectorXd variance = (observable.information.array() + prior).inverse();
  const Eigen::VectorXd of_robot = observable.directions.cwiseAbs2() * variance;
  return (of_robot.array() + params.min_sigma_db * params.min_sigma_db).sqrt();
}

/// Result before any pair: robots with fingerprints are kNotObserved if another robot has some too.
RssiOffsets no_offsets(const std::vector<std::vector<Fingerprint>>& robots, const RssiOffsetParams& params) {
  RssiOffsets result{std::vector<RssiOffsetEstimate>(robots.size(), {0, params.prior_sigma_db, 0}), false};
  const auto heard = std::count_if(robots.begin(), robots.end(), [](const auto& of) { return !of.empty(); });
  for (std::size_t r = 0; r < robots.size(); ++r)
    if (params.prior_sigma_db > 0 && heard > 1 && !robots[r].empty())
      result.robots[r].status = RssiOffsetStatus::kNotObserved;
  return result;
}

}  // namespace

RssiOffsets estimate_rssi_offsets(const std::vector<std::vector<Fingerprint>>& robots,
                                  const SimilarityParams& similarity, const RssiOffsetParams& params) {
  RssiOffsets result = no_offsets(robots, params);
  if (params.prior_sigma_db <= 0) return result;
  const std::vector<ColocatedPair> pairs = colocated_pairs(robots, similarity, params);
  if (pairs.empty()) return result;
  const OffsetSolution solution = solve(pairs, robots.size(), params);
  const ObservableOffsets observable = observable_offsets(solution.information);
  result.shown = offsets_are_significant(observable, solution.offsets_db, params);
  const Eigen::VectorXd sigma_db = sigmas_db(observable, params);
  for (const ColocatedPair& pair : pairs) {
    ++result.robots[pair.robot_a].pairs;
    ++result.robots[pair.robot_b].pairs;
  }
  for (std::size_t r = 0; r < robots.size(); ++r) {
    RssiOffsetEstimate& robot = result.robots[r];
    if (robot.pairs == 0) continue;
    robot.status = result.shown ? RssiOffsetStatus::kCorrected : RssiOffsetStatus::kNotSignificant;
    if (result.shown) robot.offset_db = solution.offsets_db[static_cast<Eigen::Index>(r)];
    robot.sigma_db = sigma_db[static_cast<Eigen::Index>(r)];
  }
  return result;
}

void remove_rssi_offset(std::vector<Fingerprint>& fingerprints, double offset_db) {
  for (Fingerprint& fingerprint : fingerprints)
    for (FingerprintEntry& entry : fingerprint.entries) entry.rss_dbm -= static_cast<float>(offset_db);
}

}  // namespace radioslam
