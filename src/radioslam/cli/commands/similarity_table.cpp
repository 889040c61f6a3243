#include "radioslam/cli/commands/similarity_table.hpp"

#include <algorithm>
#include <future>
#include <string>

#include "radioslam/base/parallel.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam::cli {
namespace {

constexpr std::size_t kMaxPairsPerTask = std::size_t{1} << 21U;
constexpr std::size_t kBytesPerRound = std::size_t{64} << 20U;  // approximate size of the text
constexpr std::size_t kMaxTasksPerThread = 64;

/// The stamp field ("12.5,") of every fingerprint.
std::vector<std::string> stamp_fields(const std::vector<Fingerprint>& fingerprints) {
  std::vector<std::string> fields;
  for (const auto& fingerprint : fingerprints) fields.push_back(format_stamp(fingerprint.stamp) + ",");
  return fields;
}

struct PairRows {
  std::size_t pairs = 0;
  std::string text;
};

class PairTable {
 public:
  PairTable(const SimilarityJoin& join, const std::vector<Fingerprint>& first,
            const std::vector<Fingerprint>& second)
      : join_(&join),
        first_(stamp_fields(first)),
        second_(stamp_fields(second)),
        rows_per_task_(std::clamp(kMaxPairsPerTask / std::max<std::size_t>(1, join.columns()), std::size_t{1},
                                  SimilarityJoin::kRowsTogether)) {}

  std::size_t tasks() const { return (join_->rows() + rows_per_task_ - 1) / rows_per_task_; }

  std::vector<PairRows> round(std::size_t begin, std::size_t end) const {
    std::vector<PairRows> done(end - begin);
    parallel_for(done.size(), 1, [&](std::size_t first, std::size_t last) {
      for (std::size_t k = first; k < last; ++k) done[k] = task(begin + k);
    });
    return done;
  }

 private:
  PairRows task(std::size_t k) const {
    const std::size_t begin = k * rows_per_task_;
    const auto pairs = join_->pairs_of(begin, std::min(join_->rows(), begin + rows_per_task_));
    PairRows rows{pairs.size(), {}};
    for (const SimilarPair& pair : pairs) {
      (rows.text += first_[pair.i]) += second_[pair.j];
      append_number(rows.text, pair.similarity);
      rows.text += '\n';
    }
    return rows;
  }

  const SimilarityJoin* join_;
  std::vector<std::string> first_, second_;
  std::size_t rows_per_task_;
};

std::size_t append_rows(const std::vector<PairRows>& round, OutputFile& output) {
  std::size_t pairs = 0;
  for (const PairRows& rows : round) {
    output.append(rows.text);
    pairs += rows.pairs;
  }
  return pairs;
}

/// Number of tasks that yield about kBytesPerRound, if they produce as much text as those of the last round.
std::size_t tasks_like(const std::vector<PairRows>& round) {
  std::size_t bytes = 1;
  for (const PairRows& rows : round) bytes += rows.text.size();
  return std::clamp(kBytesPerRound * round.size() / bytes, thread_count(),
                    kMaxTasksPerThread * thread_count());
}

}  // namespace

std::size_t write_similarity_table(const SimilarityJoin& join, const std::vector<Fingerprint>& first,
                                   const std::vector<Fingerprint>& second, OutputFile& output,
                                   const Progress& progress) {
  const PairTable table(join, first, second);
  output.append("t_i_s,t_j_s,similarity\n");
  std::size_t pairs = 0, tasks = thread_count();
  std::future<std::size_t> written;  // the previous round is written while the next one is computed
  for (std::size_t begin = 0; begin < table.tasks();) {
    const std::size_t end = std::min(table.tasks(), begin + tasks);
    std::vector<PairRows> round = table.round(begin, end);
    tasks = tasks_like(round);
    if (written.valid()) pairs += written.get();
    written = std::async(std::launch::async,
                         [&output, done = std::move(round)] { return append_rows(done, output); });
    begin = end;
    report_progress(progress, "similarity", static_cast<double>(end) / static_cast<double>(table.tasks()));
  }
  return written.valid() ? pairs + written.get() : pairs;
}

}  // namespace radioslam::cli
