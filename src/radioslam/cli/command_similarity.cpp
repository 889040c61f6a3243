// radioslam similarity: how alike the WiFi fingerprints of one or two recordings are, pair by pair.
#include <algorithm>
#include <array>
#include <charconv>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/cli/command_options.hpp"
#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/similarity_params.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/atomic_output.hpp"
#include "radioslam/io/numbers.hpp"
#include "radioslam/io/wifi_csv.hpp"
#include "radioslam/radio/fingerprint.hpp"
#include "radioslam/radio/similarity.hpp"

namespace radioslam::cli {
namespace {

constexpr std::array kMeasures{SimilarityMeasure::kCosine,    SimilarityMeasure::kGaussian,
                               SimilarityMeasure::kDetection, SimilarityMeasure::kSlide,
                               SimilarityMeasure::kMended,    SimilarityMeasure::kSorensen};

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
  throw InputError("--measure " + name, 0, "there is no such measure" + did_you_mean(name, names));
}

/// The fingerprints of each input, over access points numbered in common.
std::vector<std::vector<Fingerprint>> read_fingerprints(const std::vector<std::string>& inputs,
                                                        const FingerprintParams& params) {
  std::vector<Text> texts;
  for (const auto& input : inputs) texts.push_back(read_text(input));
  std::vector<std::vector<Fingerprint>> fingerprints;
  for (const auto& scans : read_wifi(texts).receivers)
    fingerprints.push_back(make_fingerprints(scans, params));
  return fingerprints;
}

void append_shortest(std::string& out, float value) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
  out.append(buffer.data(), end);
}

/// One row per pair; of one recording with itself, each pair once and none with itself.
std::string pair_rows(const std::vector<std::vector<Fingerprint>>& fingerprints,
                      const std::vector<std::vector<float>>& table, double minimum) {
  const bool with_itself = fingerprints.size() == 1;
  const auto& first = fingerprints.front();
  const auto& second = fingerprints.back();
  std::string rows = "t_i_s,t_j_s,similarity\n";
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = with_itself ? i + 1 : 0; j < second.size(); ++j) {
      if (static_cast<double>(table[i][j]) < minimum) continue;
      rows += format_stamp(first[i].stamp) + "," + format_stamp(second[j].stamp) + ",";
      append_shortest(rows, table[i][j]);
      rows += '\n';
    }
  }
  return rows;
}

void write_similarity(const SimilarityOptions& options) {
  const auto measure = measure_named(options.measure);
  const auto settings = collect_settings(options.parameters.config_path, options.parameters.set);
  const auto params = with_settings(SimilarityCommandParams{}, settings);
  OutputFile output(options.output);
  const auto fingerprints = read_fingerprints(options.inputs, params.radio.fingerprint);
  const auto table =
      similarity_table(fingerprints.front(), fingerprints.back(), measure, params.radio.similarity);
  const std::string rows = pair_rows(fingerprints, table, options.minimum);
  output.commit(rows);
  std::cout << options.output << ": " << std::count(rows.begin(), rows.end(), '\n') - 1 << " pairs of "
            << fingerprints.front().size() << " x " << fingerprints.back().size() << " fingerprints\n";
}

}  // namespace

void add_similarity(CLI::App& program) {
  const auto options = std::make_shared<SimilarityOptions>();
  auto* command = program.add_subcommand("similarity", "Compare WiFi fingerprints pair by pair");
  command->add_option("WIFI", options->inputs, "One or two wifi.csv; two are compared with each other")
      ->required()
      ->expected(1, 2);
  add_output_option(*command, options->output, "The table to write: t_i_s,t_j_s,similarity");
  command->add_option("--measure", options->measure, "cosine, gaussian, detection, slide, mended or sorensen")
      ->required()
      ->type_name("NAME");
  command->add_option("--min", options->minimum, "Leave out pairs less alike than this, 0 to 1; default 0")
      ->check(number_from(0, 1))
      ->type_name("S");
  add_parameter_options(*command, options->parameters);
  add_threads_option(*command);
  command->footer(
      "`radioslam parameters similarity` lists what --set can change.\n\n"
      "Example: where did b hear what a heard?\n"
      "  radioslam similarity a/wifi.csv b/wifi.csv --measure detection --min 0.3 -o pairs.csv");
  command->callback([options] { write_similarity(*options); });
}

}  // namespace radioslam::cli
