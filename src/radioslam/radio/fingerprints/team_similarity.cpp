#include "radioslam/radio/fingerprints/team_similarity.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "radioslam/base/check.hpp"
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

/// The pairs of rows [begin, end) of similarity at least `minimum`; `pairs` are ordered.
std::vector<SimilarPair> rows_of(const std::vector<SimilarPair>& pairs, double minimum, std::size_t begin,
                                 std::size_t end) {
  const auto row = [&](std::size_t i) {
    return std::partition_point(pairs.begin(), pairs.end(), [i](const SimilarPair& p) { return p.i < i; });
  };
  std::vector<SimilarPair> rows;
  std::copy_if(row(begin), row(end), std::back_inserter(rows),
               [&](const SimilarPair& pair) { return static_cast<double>(pair.similarity) >= minimum; });
  return rows;
}

/// The pairs i < j of which one at least is new, ordered.
std::vector<SimilarPair> pairs_of_new(const std::vector<Fingerprint>& all, const EarlierNumbers& earlier,
                                      const SimilarityQuery& query) {
  std::vector<Fingerprint> added;
  std::vector<std::uint32_t> number;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (earlier[i]) continue;
    added.push_back(all[i]);
    number.push_back(i);
  }
  std::vector<SimilarPair> pairs;
  for (const auto& [row, j, similarity] : SimilarityJoin::between(added, all, query).pairs()) {
    const std::uint32_t i = number[row];
    if (i < j || earlier[j]) pairs.push_back({std::min(i, j), std::max(i, j), similarity});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// With the numbers of now, without those that are gone.
std::vector<SimilarPair> renumbered(const std::vector<SimilarPair>& pairs, const EarlierNumbers& earlier,
                                    std::size_t before) {
  constexpr auto kGone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> now(before, kGone);
  for (std::uint32_t i = 0; i < earlier.size(); ++i)
    if (earlier[i]) now[*earlier[i]] = i;
  std::vector<SimilarPair> kept;
  for (const auto& [i, j, similarity] : pairs)
    if (now[i] != kGone && now[j] != kGone) kept.push_back({now[i], now[j], similarity});
  return kept;
}

}  // namespace

struct TeamSimilarity::Source {
  struct Joined {
    double minimum = 0;
    std::vector<SimilarPair> pairs;  ///< ordered
  };

  std::vector<std::vector<float>> table;
  std::vector<Fingerprint> fingerprints;
  SimilarityMeasure measure = SimilarityMeasure::kSorensen;
  SimilarityParams params;
  std::optional<FingerprintComparison> comparison = {};  ///< absent: `table` is used
  std::optional<Joined> joined = {};

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
    if (joined && joined->minimum <= minimum)
      return [=, this](std::size_t begin, std::size_t end) {
        return rows_of(joined->pairs, minimum, begin, end);
      };
    if (!comparison)
      return [=, this](std::size_t begin, std::size_t end) { return pairs_of_table(minimum, begin, end); };
    return [join = SimilarityJoin::within(fingerprints, {measure, params, minimum})](
               std::size_t begin, std::size_t end) { return join.pairs_of(begin, end); };
  }
};

TeamSimilarity::TeamSimilarity(std::vector<Fingerprint> fingerprints, SimilarityMeasure measure,
                               const SimilarityParams& params) {
  Source source{{}, std::move(fingerprints), measure, params};
  source.comparison.emplace(source.fingerprints, measure, params);
  source_ = std::make_shared<const Source>(std::move(source));
}

TeamSimilarity::TeamSimilarity(std::vector<std::vector<float>> table)
    : TeamSimilarity(Source{std::move(table), {}, {}, {}}) {}

TeamSimilarity::TeamSimilarity(Source source) : source_(std::make_shared<const Source>(std::move(source))) {}

TeamSimilarity TeamSimilarity::joined(double minimum) const {
  Source source = *source_;
  source.joined = {minimum, {}};
  for_each_row(minimum, [&](std::span<const SimilarPair> row) {
    source.joined->pairs.insert(source.joined->pairs.end(), row.begin(), row.end());
  });
  return TeamSimilarity(std::move(source));
}

TeamSimilarity TeamSimilarity::grown(std::vector<Fingerprint> fingerprints,
                                     const EarlierNumbers& earlier) const {
  RADIOSLAM_CHECK(source_->joined && source_->comparison, "only fingerprints that were joined grow");
  Source source{{}, std::move(fingerprints), source_->measure, source_->params};
  source.comparison.emplace(source.fingerprints, source.measure, source.params);
  const auto& [minimum, before] = *source_->joined;
  const auto known = renumbered(before, earlier, size());
  const auto added = pairs_of_new(source.fingerprints, earlier, {source.measure, source.params, minimum});
  source.joined = {minimum, {}};
  std::merge(known.begin(), known.end(), added.begin(), added.end(),
             std::back_inserter(source.joined->pairs));
  return TeamSimilarity(std::move(source));
}

std::optional<double> TeamSimilarity::joined_from() const {
  return source_->joined ? std::optional(source_->joined->minimum) : std::nullopt;
}

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
