// Place recognition with scans on the page: from pairs to closures, and the closures on the map.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "radioslam/report/closure_data.hpp"
#include "report/sample_page.hpp"

namespace radioslam {
namespace {

using sample::data_of;
using sample::evaluated_page;
using sample::Json;
using sample::make_sample;
using sample::Sample;

ClosureResult scan_closure(const RunResult& result, std::size_t i, std::size_t j, ClosureStatus status) {
  ClosureResult closure;
  closure.robot_i = RobotIndex(i);
  closure.robot_j = RobotIndex(j);
  closure.stamp_i = result.robots[i].estimate[2].stamp;
  closure.stamp_j = result.robots[j].estimate[7].stamp;
  closure.kind = ClosureKind::kLidar;
  closure.status = status;
  if (status == ClosureStatus::kRejected) closure.reason = "the scans do not fit";
  return closure;
}

/// Two accepted closures between robots, one of which the truth covers, a rejected one, and one of a robot
/// with itself.
Sample sample_with_places() {
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  RunResult& result = sample.result;
  result.counts["place_pairs"] = 1200;
  result.counts["place_pairs_allowed"] = 300;
  result.counts["descriptor_pairs"] = 150;
  result.counts["registrations"] = 3;
  result.counts["registrations_verified"] = 2;
  result.closures.push_back(scan_closure(result, 0, 1, ClosureStatus::kAccepted));
  result.closures.push_back(scan_closure(result, 2, 1, ClosureStatus::kAccepted));
  result.closures.push_back(scan_closure(result, 0, 2, ClosureStatus::kRejected));
  result.closures.back().statistic = 0.65;
  result.closures.push_back(scan_closure(result, 1, 1, ClosureStatus::kAccepted));
  return sample;
}

TEST(ReportPlaces, CountPairsByStep) {
  const Json places = data_of(evaluated_page(sample_with_places()))["places"];
  EXPECT_EQ(places["pairs"], 1200);
  EXPECT_EQ(places["allowed"], 300);
  EXPECT_EQ(places["compared"], 150);
  EXPECT_EQ(places["registered"], 3);
  EXPECT_EQ(places["verified"], 2);
  EXPECT_EQ(places["accepted"], 2);
  EXPECT_FALSE(places.contains("true"));
  EXPECT_FALSE(places.contains("false"));
}

TEST(ReportPlaces, AreComparedWithTheTruth) {
  const ComparedClosures of_scans{.accepted = 5, .true_accepted = 3, .rejected = 4, .true_rejected = 1};
  const PageData places = place_data(sample_with_places().result, {{ClosureKind::kLidar, of_scans}});
  EXPECT_EQ(places["true"], 3);
  EXPECT_EQ(places["false"], 2);
  EXPECT_FALSE(place_data(sample_with_places().result, {{ClosureKind::kMatch, of_scans}}).contains("true"));
}

TEST(ReportPlaces, AreAbsentWithoutScansOfSeveralRobots) {
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  EXPECT_TRUE(data_of(evaluated_page(sample))["places"].is_null());
  sample.result.counts["place_pairs"] = 0;
  EXPECT_TRUE(data_of(evaluated_page(sample))["places"].is_null());
}

TEST(ReportPlaces, ClosuresOnTheMapHaveTheirReasonAndStatistic) {
  const Json closures = data_of(evaluated_page(sample_with_places()))["closures"];
  const Json& drawn = closures["drawn"];
  std::vector<std::string> seen;
  for (std::size_t c = 0; c < drawn["group"].size(); ++c) {
    const Json& group = closures["groups"][drawn["group"][c].get<std::size_t>()];
    const Json& reason = closures["reasons"][drawn["reason"][c].get<std::size_t>()];
    EXPECT_EQ(reason["kind"], group["kind"]);
    EXPECT_EQ(reason["status"], group["status"]);
    if (group["kind"] != "lidar" || group["status"] != "rejected") continue;
    seen.push_back(reason["reason"].get<std::string>());
    EXPECT_EQ(drawn["robot_i"][c], 0);
    EXPECT_EQ(drawn["robot_j"][c], 2);
    EXPECT_EQ(drawn["statistic"][c], 0.65);
  }
  EXPECT_EQ(seen, (std::vector<std::string>{"the scans do not fit"}));
}

}  // namespace
}  // namespace radioslam
