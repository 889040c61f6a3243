// radioslam similarity: computes the pairwise similarity of the WiFi fingerprints of one or two recordings.
#include <algorithm>
#include <array>
#include <cstddef>
#include <future>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/base/parallel.hpp"
#include "radioslam/base/progress.hpp"
#include "radioslam/base/suggestion.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/commands/similarity_params.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"

namespace radioslam::cli {
namespace {

// CSV table of similar fingerprint pairs (t_i_s,t_j_s,similarity), ordered by the two stamps. The table may
// exceed the available memory, so it is computed and written in blocks of rows.

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

/// Appends the table to `output` and returns its number of pairs. `first` are the join's rows, `second` its
/// columns. Uses all threads; the output does not depend on their number.
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

constexpr std::array kMeasures{SimilarityMeasure::kCosine,        SimilarityMeasure::kGaussian,
                               SimilarityMeasure::kDetection,     SimilarityMeasure::kProduct,
                               SimilarityMeasure::kGeometricMean, SimilarityMeasure::kSorensen};

struct SimilarityOptions {
  std::vector<std::string> inputs;
  std::string output;
  std::string measure;
  double minimum = 0;
  ParameterOptions parameters;
};

SimilarityMeasure measure_named(const std::string& name) {
  if (const auto measure = similarity_measure(name)) return *measure;
  std::vector<std::string> names;
  for (const auto measure : kMeasures) names.emplace_back(to_string(measure));
  throw InputError("--measure " + name, 0, "unknown similarity measure" + did_you_mean(name, names));
}

/// The fingerprints of each input; all inputs use the same numbering of access points.
std::vector<std::vector<Fingerprint>> read_fingerprints(const std::vector<std::string>& inputs,
                                                        const FingerprintParams& params) {
  std::vector<Text> texts;
  for (const auto& input : inputs) texts.push_back(read_tool_output(input));
  std::vector<std::vector<Fingerprint>> fingerprints;
  for (const auto& scans : read_wifi(texts).receivers)
    fingerprints.push_back(make_fingerprints(scans, params));
  return fingerprints;
}

void write_similarity(const SimilarityOptions& options) {
  const auto measure = measure_named(options.measure);
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto params = with_settings(SimilarityCommandParams{}, settings);
  refuse_replacing_inputs(options.output, options.inputs);
  OutputFile output(options.output);
  const auto fingerprints = read_fingerprints(options.inputs, params.radio.fingerprint);
  const auto &first = fingerprints.front(), &second = fingerprints.back();
  const SimilarityQuery query{measure, params.radio.similarity, options.minimum};
  const auto join = fingerprints.size() == 1 ? SimilarityJoin::within(first, query)
                                             : SimilarityJoin::between(first, second, query);
  std::size_t pairs = 0;
  {
    ProgressLine line;
    pairs = write_similarity_table(join, first, second, output, line.progress());
  }
  output.commit();
  std::cout << options.output << ": " << pairs << " pairs of " << first.size() << " x " << second.size()
            << " fingerprints\n";
}

}  // namespace

void add_similarity(CLI::App& program) {
  const auto options = std::make_shared<SimilarityOptions>();
  auto* command = program.add_subcommand("similarity", "Compute pairwise similarities of WiFi fingerprints");
  command
      ->add_option(
          "WIFI", options->inputs,
          "One wifi.csv, whose fingerprints are compared with one another, or two, which are compared with "
          "each other")
      ->required()
      ->expected(1, 2);
  add_output_option(*command, options->output, "CSV table to write: t_i_s,t_j_s,similarity");
  command
      ->add_option("--measure", options->measure,
                   "Similarity measure: cosine, gaussian, detection, slide, mended or sorensen")
      ->required()
      ->type_name("NAME");
  command
      ->add_option("--min", options->minimum,
                   "Omit pairs with a similarity below this, from 0 to 1 (default: 0)")
      ->check(number_from(0, 1))
      ->type_name("S");
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "`radioslam parameters similarity` lists the parameters for --set and --config.\n\n"
      "Example: where did robot b receive the same access points as robot a?\n"
      "  radioslam similarity a/wifi.csv b/wifi.csv --measure detection --min 0.3 -o pairs.csv");
  command->callback([options] { write_similarity(*options); });
}

}  // namespace radioslam::cli
