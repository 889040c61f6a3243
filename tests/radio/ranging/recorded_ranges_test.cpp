// Range biases of recorded ultra-wideband ranges between four robots under motion capture.
#include <array>

#include "io/recorded_data.hpp"
#include "radio/ranging/known_biases.hpp"
#include "radioslam/io/text/csv.hpp"

namespace radioslam {
namespace {

TEST(RecordedRanges, BiasesOfTurtlebotPairsAreTwoToFiveDecimetres) {
  RADIOSLAM_RECORDED(path, "tiers/csv/4robots_data_01.csv");
  const Text text = read_text(path);
  CsvReader csv(text, {{"x1", "y1", "x3", "y3", "x4", "y4", "x5", "y5", "range_5_1", "range_5_3", "range_5_4",
                        "range_4_3", "range_4_1", "range_3_1"}});
  constexpr std::array<std::array<std::size_t, 2>, 6> kPairs{
      {{3, 0}, {3, 1}, {3, 2}, {2, 1}, {2, 0}, {1, 0}}};
  constexpr std::size_t kFirstRange = 8;
  std::vector<test::KnownRange> ranges;
  while (csv.next()) {
    const auto place = [&](std::size_t robot) {
      return Eigen::Vector2d(csv.number(2 * robot), csv.number(2 * robot + 1));
    };
    for (std::size_t pair = 0; pair < kPairs.size(); ++pair) {
      const double range_m = csv.number(kFirstRange + pair);
      if (range_m <= 0) continue;  // no measurement
      ranges.push_back({pair, range_m, (place(kPairs[pair][0]) - place(kPairs[pair][1])).norm()});
    }
  }
  const auto biases = test::known_biases(ranges, kPairs.size());
  for (std::size_t pair = 0; pair < biases.size(); ++pair) {
    const RangeBias& bias = biases[pair];
    RecordProperty("pair_" + std::to_string(pair),
                   std::to_string(bias.bias_m) + " spread " + std::to_string(bias.spread_m));
    EXPECT_GT(bias.count, 1000U);
    EXPECT_GT(bias.bias_m, 0.15);
    EXPECT_LT(bias.bias_m, 0.55);
    EXPECT_LT(bias.sigma_m, 0.01);
  }
}

}  // namespace
}  // namespace radioslam
