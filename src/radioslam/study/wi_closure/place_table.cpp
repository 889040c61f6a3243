#include "radioslam/study/wi_closure/place_table.hpp"

#include <functional>
#include <utility>

namespace radioslam {
namespace {

using Seeds = std::vector<PlaceStudy>;
using OfRun = std::function<std::optional<double>(const PlaceRun&)>;

double to_number(std::size_t count) { return static_cast<double>(count); }

/// Rows that depend on the parameters of place recognition, with one cell per way of running.
class PlaceRunRows {
 public:
  PlaceRunRows(const Seeds& seeds, std::size_t settings, const PublishedPlaces& published,
               std::vector<StudyRow>& rows)
      : seeds_(seeds), settings_(settings), published_(published), rows_(rows) {}

  void add(const std::string& label, PublishedCells published, int decimals, const OfRun& value) {
    add_texts(label, std::move(published), [&](PlaceRun PlaceRuns::*run) {
      return number_text(
          median_over(seeds_, [&](const PlaceStudy& seed) { return value(seed.runs[settings_].*run); }),
          decimals);
    });
  }

  void add_count(const std::string& label, PublishedCells published, std::size_t PlaceCounts::*count) {
    add(label, std::move(published), 0,
        [count](const PlaceRun& run) { return to_number(run.places.*count); });
  }

  /// Bytes sent, and their share of what sending all would take.
  void add_bytes(const std::string& kind, std::size_t PlaceBytes::*count) {
    add(kind + " sent, kB [5]", {}, 1,
        [count](const PlaceRun& run) { return 1e-3 * to_number(run.places.bytes.*count); });
    add(kind + " sent, % of all [5]", {}, 1, [count](const PlaceRun& run) -> std::optional<double> {
      const double all = to_number(run.places.bytes_all.*count);
      return all > 0 ? std::optional(100 * to_number(run.places.bytes.*count) / all) : std::nullopt;
    });
  }

  void add_in_one_frame() {
    add_texts("missions with all robots in one frame", {}, [&](PlaceRun PlaceRuns::*run) {
      std::size_t count = 0;
      for (const PlaceStudy& seed : seeds_) count += (seed.runs[settings_].*run).in_one_frame ? 1U : 0U;
      return std::to_string(count) + " of " + std::to_string(seeds_.size());
    });
  }

 private:
  template <class Text>
  void add_texts(const std::string& label, PublishedCells published, const Text& text) {
    const PlaceSettings settings = seeds_.front().runs[settings_].settings;
    if (settings == published_.without) published = {};
    rows_.push_back(
        {word_for(settings) + (": " + label),
         {std::move(published.baseline), std::move(published.pruned), text(&PlaceRuns::without_radio),
          text(&PlaceRuns::unpruned), text(&PlaceRuns::pruned)}});
  }

  const Seeds& seeds_;
  std::size_t settings_;
  const PublishedPlaces& published_;
  std::vector<StudyRow>& rows_;
};

using OfSearch = std::function<const PairCounts&(const PlaceStudy&)>;

/// Pairs by one criterion, before any scan is compared.
void add_criterion_rows(const Seeds& seeds, const std::string& criterion, const PublishedPlaces& published,
                        const OfSearch& of, std::vector<StudyRow>& rows) {
  const auto of_search = [&](std::size_t PairCounts::*count) {
    return number_text(
        median_over(seeds, [&](const PlaceStudy& seed) { return std::optional(to_number(of(seed).*count)); }),
        0);
  };
  const auto share = [&](std::optional<double> (*ratio)(const PairCounts&)) {
    return percent_text(median_over(seeds, [&](const auto& seed) { return ratio(of(seed)); }), 1);
  };
  const std::string true_ones = of_search(&PairCounts::true_pairs);
  rows.push_back(
      {"true pairs, " + criterion,
       {published.true_pairs.baseline, published.true_pairs.pruned, true_ones, true_ones, true_ones}});
  const auto add_pruned = [&](const std::string& label, const std::string& thesis, std::string pruned) {
    rows.push_back({criterion + ": " + label,
                    {not_published(), thesis, not_published(), not_published(), std::move(pruned)}});
  };
  add_pruned("kept", published.kept, of_search(&PairCounts::kept));
  add_pruned("true kept", published.true_kept, of_search(&PairCounts::true_kept));
  add_pruned("recall", published.recall, share(recall));
  add_pruned("false pairs rejected", published.false_rejected, share(rejected_false));
}

void add_search_rows(const Seeds& seeds, const PublishedPlaces& published, std::vector<StudyRow>& rows) {
  const std::string all = number_text(
      median_over(
          seeds,
          [](const PlaceStudy& seed) { return std::optional(to_number(seed.search.candidates.pairs)); }),
      0);
  rows.push_back({"pairs of keyframes", {published.pairs, published.pairs, all, all, all}});
  add_criterion_rows(
      seeds, "18 % of views in common", published,
      [](const PlaceStudy& seed) -> const PairCounts& { return seed.search.candidates; }, rows);
  if (seeds.front().within_radius)
    add_criterion_rows(
        seeds, "within " + number_text(seeds.front().radius_m, 1) + " m", published,
        [](const PlaceStudy& seed) -> const PairCounts& { return seed.within_radius->candidates; }, rows);
}

void add_place_rows(const PublishedPlaces& published, PlaceRunRows& rows) {
  rows.add_count("pairs of keyframes with scans", {published.pairs, published.pairs}, &PlaceCounts::pairs);
  rows.add_count("allowed [2]", {published.pairs, published.kept}, &PlaceCounts::allowed);
  rows.add_count("descriptors compared", {}, &PlaceCounts::compared);
  rows.add_count("registrations", {}, &PlaceCounts::registrations);
  rows.add_count("verified", {}, &PlaceCounts::verified);
  rows.add_bytes("descriptors", &PlaceBytes::descriptors);
  rows.add_bytes("scans", &PlaceBytes::scans);
  rows.add("closures accepted", {}, 0, [](const PlaceRun& run) { return to_number(run.closures.accepted); });
  rows.add("true accepted", {}, 0, [](const PlaceRun& run) { return to_number(run.closures.true_accepted); });
}

void add_outcome_rows(const PlaceTableText& text, PlaceRunRows& rows) {
  rows.add_in_one_frame();
  rows.add("ATE, m", text.published.ate_m, 2, [](const PlaceRun& run) { return run.ate_m; });
  rows.add(text.scans_s, {}, 1, [](const PlaceRun& run) { return run.scans_s; });
  rows.add("pruning, s", {not_published(), text.published.search_s}, 3,
           [](const PlaceRun& run) { return run.overlap_s; });
  rows.add("place recognition, s", {}, 2, [](const PlaceRun& run) { return run.places_s; });
  rows.add("alignment, optimisation and the rest, s", {}, 1,
           [](const PlaceRun& run) { return run.rest_s(); });
  rows.add("whole run, s", text.published.total_s, 1, [](const PlaceRun& run) { return run.total_s; });
}

std::vector<std::string> notes_on_places() {
  return {
      "[2] Of one robot, a keyframe every places.stride_m (by default a fifth of the range) is compared with "
      "those of the other that "
      "pruning leaves; comparisons and registrations are those of all rounds (places.rounds; with "
      "DiSCo-SLAM's "
      "parameters one). Without radio nothing aligns the robots at first, and all pairs are compared by "
      "descriptor.",
      "[5] By one robot of each pair to the other: the descriptors of keyframes that may be registered, and "
      "the scans of those that are, 21 bytes a surfel.",
      "No radio: the same recordings without ranges and angles. No pruning: `run --no-prune`, which also "
      "trusts the closures without weighing them against the radio.",
      "A closure is true within 0.3 m and 3 degrees of the true relative pose.",
      "DiSCo-SLAM: its parameters (table 4.1): 64 rings, 60 sectors, the range of the LiDAR, 50 nearest ring "
      "keys, descriptors within 0.2, one candidate. Loosened: as the thesis did for KITTI 08, within 1, ten "
      "candidates.",
      "With pruning, pairs are proposed by predicted poses first: the distance of the descriptors then has "
      "no limit, keys are not searched, and one candidate means one team alignment.",
      "Its consistent set (PCM) is taken from five matches on, with a threshold of 100, loosened: 20, on a "
      "norm that adds metres to radians (consistency.covariance=identity). Without counterpart is its "
      "icp_threshold 5, a mean squared distance of 5 m^2 after registration: registrations are tested here "
      "as "
      "everywhere in `run`."};
}

}  // namespace

StudyTable place_table(const std::vector<PlaceStudy>& seeds, PlaceTableText text) {
  StudyTable table{std::move(text.title),
                   seeds_text(seeds.front().seed, seeds.size()) + ". " + text.scene,
                   {"thesis: baseline", "Wi-Closure", "no radio", "no pruning", "pruning"},
                   {},
                   std::move(text.notes)};
  add_search_rows(seeds, text.published, table.rows);
  for (std::size_t k = 0; k < seeds.front().runs.size(); ++k) {
    PlaceRunRows of_settings(seeds, k, text.published, table.rows);
    add_place_rows(text.published, of_settings);
    add_outcome_rows(text, of_settings);
  }
  for (std::string& note : notes_on_places()) table.notes.push_back(std::move(note));
  return table;
}

}  // namespace radioslam
