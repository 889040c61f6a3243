#include "radioslam/radio/fingerprints/team_similarity.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/base/parallel.hpp"
#include "radioslam/radio/fingerprints/fingerprint_comparison.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kTasksAtOnce = 64;  // of kRowsTogether rows each; bounds the pairs held in memory

void visit_rows(std::span<const SimilarPair> pairs,
                const std::function<void(std::span<const SimilarPair>)>& visit) {
  for (auto begin = pairs.begin(); begin != pairs.end();) {
    const auto end = std::find_if(begin, pairs.end(), [&](const SimilarPair& p) { return p.i != begin->i; });
    visit({begin, end});
    begin = end;
  }
}

}  // namespace

struct TeamSimilarity::Source {
  std::vector<std::vector<float>> table;
  std::vector<Fingerprint> fingerprints;
  SimilarityMeasure measure = SimilarityMeasure::kSorensen;
  SimilarityParams params;
  std::optional<FingerprintComparison> comparison;  ///< absent: `table` is used

  float of(std::size_t i, std::size_t j) const {
    if (!comparison) return table[i][j];
    return static_cast<float>(comparison->similarity(std::min(i, j), std::max(i, j)));
  }

  std::vector<SimilarPair> pairs_of_table(double minimum, std::size_t begin, std::size_t end) const {
    std::vector<SimilarPair> pairs;
    for (auto i = static_cast<std::uint32_t>(begin); i < end; ++i)
      for (std::uint32_t j = i + 1; j < table.size(); ++j)
        if (static_cast<double>(table[i][j]) >= minimum) pairs.push_back({i, j, table[i][j]});
    return pairs;
  }

  /// The pairs i < j of rows [begin, end).
  std::function<std::vector<SimilarPair>(std::size_t begin, std::size_t end)> row_finder(
      double minimum) const {
    if (!comparison)
      return [=, this](std::size_t begin, std::size_t end) { return pairs_of_table(minimum, begin, end); };
    return [join = SimilarityJoin::within(fingerprints, {measure, params, minimum})](
               std::size_t begin, std::size_t end) { return join.pairs_of(begin, end); };
  }
};

TeamSimilarity::TeamSimilarity(std::vector<Fingerprint> fingerprints, SimilarityMeasure measure,
                               const SimilarityParams& params) {
  Source source{{}, std::move(fingerprints), measure, params, {}};
  source.comparison.emplace(source.fingerprints, measure, params);
  source_ = std::make_shared<const Source>(std::move(source));
}

TeamSimilarity::TeamSimilarity(std::vector<std::vector<float>> table)
    : source_(std::make_shared<const Source>(Source{std::move(table), {}, {}, {}, {}})) {}

std::optional<TeamSimilarity> TeamSimilarity::among(std::vector<Fingerprint> fingerprints) const {
  if (!source_->comparison) return std::nullopt;
  return TeamSimilarity(std::move(fingerprints), source_->measure, source_->params);
}

std::size_t TeamSimilarity::size() const {
  return source_->comparison ? source_->comparison->size() : source_->table.size();
}

float TeamSimilarity::of(std::size_t i, std::size_t j) const { return source_->of(i, j); }

void TeamSimilarity::for_each_pair(double minimum,
                                   const std::function<void(const SimilarPair&)>& visit) const {
  for_each_row(minimum,
               [&](std::span<const SimilarPair> row) { std::for_each(row.begin(), row.end(), visit); });
}

void TeamSimilarity::for_each_row(double minimum,
                                  const std::function<void(std::span<const SimilarPair>)>& visit) const {
  const auto pairs_of = source_->row_finder(minimum);
  constexpr std::size_t kTask = SimilarityJoin::kRowsTogether, kRows = kTask * kTasksAtOnce;
  for (std::size_t first = 0; first < size(); first += kRows) {
    const std::size_t rows = std::min(kRows, size() - first);
    std::vector<std::vector<SimilarPair>> found((rows + kTask - 1) / kTask);
    parallel_for(found.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t)
        found[t] = pairs_of(first + t * kTask, std::min(first + (t + 1) * kTask, size()));
    });
    for (const auto& of_task : found) visit_rows(of_task, visit);
  }
}

}  // namespace radioslam
