#include "radioslam/places/scan_context_index.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/places/context_keys.hpp"

namespace radioslam {
namespace {

constexpr int kMaxCoarseBands = 32;
constexpr int kCoarseFrequencies = 8;
constexpr int kCoarseShifts = 32;

Eigen::VectorXf key_of(const ScanContext& context, const ScanContextIndexParams& params) {
  return params.key == "ring" ? ring_key(context) : spectral_key(context);
}

SectorDft coarse_dft(int sectors) {
  return {sectors, std::min(kCoarseFrequencies, sectors / 2 + 1), kCoarseShifts};
}

Eigen::MatrixXf coarse_spectra(const ScanContext& context) {
  return band_spectra(context, std::min(kMaxCoarseBands, context.rings()), kCoarseFrequencies);
}

/// Of places `indices`, keeps the `count` ones with the greatest scores[place in this list]; ties by index.
void keep_greatest(const Eigen::VectorXf& scores, std::size_t count, std::vector<std::size_t>& indices) {
  if (indices.size() <= count) return;
  std::vector<std::pair<float, std::size_t>> order;
  order.reserve(indices.size());
  for (std::size_t k = 0; k < indices.size(); ++k)
    order.emplace_back(-scores[static_cast<Eigen::Index>(k)], indices[k]);
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end());
  indices.resize(count);
  for (std::size_t k = 0; k < count; ++k) indices[k] = order[k].second;
}

std::vector<std::size_t> allowed_indices(std::size_t size, const ScanContextIndex::Allowed& allowed) {
  std::vector<std::size_t> indices(size);
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  if (allowed) std::erase_if(indices, [&](std::size_t index) { return !allowed(index); });
  return indices;
}

}  // namespace

ScanContextIndex::ScanContextIndex(const ScanContextIndexParams& params) : params_(params) {}

void ScanContextIndex::add(ScanContext context) {
  RADIOSLAM_CHECK(contexts_.empty() || (context.rings() == contexts_.front().rings() &&
                                        context.sectors() == contexts_.front().sectors()),
                  "grids of one shape");
  if (!coarse_dft_) coarse_dft_ = coarse_dft(context.sectors());
  const Eigen::VectorXf key = key_of(context, params_);
  keys_.insert(keys_.end(), key.begin(), key.end());
  half_squares_.push_back(key.squaredNorm() / 2);
  const Eigen::MatrixXf coarse = coarse_spectra(context);
  coarse_.insert(coarse_.end(), coarse.data(), coarse.data() + coarse.size());
  contexts_.push_back(std::move(context));
}

void ScanContextIndex::shrink_to_fit() {
  contexts_.shrink_to_fit();
  keys_.shrink_to_fit();
  half_squares_.shrink_to_fit();
  coarse_.shrink_to_fit();
}

/// Least |key - query| is the greatest key . query - |key|^2 / 2.
void ScanContextIndex::keep_nearest_keys(const ScanContext& query, std::size_t count,
                                         std::vector<std::size_t>& indices) const {
  if (indices.size() <= count) return;
  const auto n = static_cast<Eigen::Index>(size());
  const Eigen::VectorXf key = key_of(query, params_);
  const Eigen::Map<const Eigen::MatrixXf> keys(keys_.data(), key.size(), n);
  Eigen::VectorXf scores = -Eigen::Map<const Eigen::VectorXf>(half_squares_.data(), n);
  scores.noalias() += keys.transpose() * key;
  keep_greatest(scores(indices), count, indices);
}

void ScanContextIndex::keep_coarsely_best(const ScanContext& query, std::size_t count,
                                          std::vector<std::size_t>& indices) const {
  if (indices.size() <= count) return;
  const Eigen::MatrixXf coarse = coarse_spectra(query);
  const auto size = static_cast<std::size_t>(coarse.size());
  std::sort(indices.begin(), indices.end());
  Eigen::VectorXf scores(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    const Eigen::Map<const Eigen::MatrixXf> other(coarse_.data() + indices[k] * size, coarse.rows(),
                                                  coarse.cols());
    scores[static_cast<Eigen::Index>(k)] = coarse_dft_->correlation(coarse, other).maxCoeff();
  }
  keep_greatest(scores, count, indices);
}

std::vector<Neighbour> ScanContextIndex::best_of(const ScanContext& query,
                                                 const std::vector<std::size_t>& indices,
                                                 std::size_t count) const {
  std::vector<Neighbour> found;
  found.reserve(indices.size());
  for (const std::size_t index : indices) found.push_back({index, compare(query, contexts_[index])});
  const std::size_t kept = std::min(count, found.size());
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept), found.end(),
                    [](const Neighbour& a, const Neighbour& b) {
                      return std::pair(a.match.distance, a.index) < std::pair(b.match.distance, b.index);
                    });
  found.resize(kept);
  return found;
}

std::vector<Neighbour> ScanContextIndex::nearest(const ScanContext& query, std::size_t count,
                                                 const Allowed& allowed) const {
  std::vector<std::size_t> indices = allowed_indices(size(), allowed);
  keep_nearest_keys(query, std::max(count, static_cast<std::size_t>(params_.nearest_keys)), indices);
  keep_coarsely_best(query, std::max(count, static_cast<std::size_t>(params_.shortlist)), indices);
  return best_of(query, indices, count);
}

std::vector<Neighbour> ScanContextIndex::nearest_exhaustively(const ScanContext& query, std::size_t count,
                                                              const Allowed& allowed) const {
  return best_of(query, allowed_indices(size(), allowed), count);
}

}  // namespace radioslam
