// radioslam similarity: computes the pairwise similarity of the WiFi fingerprints of one or two recordings.
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "radioslam/cli/commands.hpp"
#include "radioslam/cli/commands/command_options.hpp"
#include "radioslam/cli/commands/output_path_check.hpp"
#include "radioslam/cli/commands/similarity_params.hpp"
#include "radioslam/cli/commands/similarity_table.hpp"
#include "radioslam/cli/config.hpp"
#include "radioslam/cli/parameters.hpp"
#include "radioslam/cli/progress_line.hpp"
#include "radioslam/cli/suggestion.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/wifi/wifi_csv.hpp"
#include "radioslam/radio/fingerprints/fingerprint.hpp"
#include "radioslam/radio/fingerprints/similarity.hpp"
#include "radioslam/radio/fingerprints/similarity_join.hpp"

namespace radioslam::cli {
namespace {

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
  for (const auto& input : inputs) texts.push_back(read_text(input));
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
