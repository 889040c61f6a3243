#include "radioslam/report/report.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "radioslam/eval/team_estimate.hpp"
#include "report/sample_page.hpp"

namespace radioslam {
namespace {

using sample::data_of;
using sample::data_text;
using sample::evaluated_page;
using sample::Json;
using sample::kDataBegins;
using sample::make_sample;
using sample::Sample;

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// The page's own markup, without its data, without d3 and without its style. (std::regex recurses once per
/// character, and ran out of stack on the style under the sanitizers.)
std::string markup(const std::string& page) {
  const std::string end = "</style>";
  std::string text = page.substr(0, page.find(kDataBegins));
  for (auto at = text.find("<style>"); at != std::string::npos; at = text.find("<style>"))
    text.erase(at, text.find(end, at) + end.size() - at);
  return text;
}

TEST(Report, LoadsNothing) {
  const std::string page = evaluated_page(make_sample());
  EXPECT_FALSE(std::regex_search(markup(page), std::regex("(src|href)\\s*=|<link|<iframe|<img|<object")));
  EXPECT_EQ(count_of(page, "@import"), 0u);
  EXPECT_EQ(count_of(page, "url("), 0u);
  EXPECT_EQ(count_of(page, "<script src"), 0u);
  EXPECT_EQ(count_of(page, "default-src 'none'"), 1u);                     // enforced by the browser
  std::set<std::string> allowed{"http://www.w3.org", "https://d3js.org"};  // namespaces, and d3's banner
  const std::regex address("https?://[A-Za-z0-9.]+");
  for (std::sregex_iterator found(page.begin(), page.end(), address), end; found != end; ++found)
    EXPECT_EQ(allowed.count(found->str()), 1u) << found->str();
}

TEST(Report, HoldsEveryPartOfThePage) {
  const std::string page = evaluated_page(make_sample({.keyframes = 20, .closures = 5}));
  for (const char* mark : {"@style@", "@script@", "@d3@", "@licence@", "@data@"})
    EXPECT_EQ(count_of(page, mark), 0u) << mark;
  EXPECT_EQ(count_of(page, "d3js.org v5"), 1u);
  EXPECT_EQ(count_of(page, "Redistributions in binary form"), 1u);
  EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
}

TEST(Report, DataAreTheRunsNumbers) {
  const Sample sample = make_sample({.keyframes = 50, .closures = 30});
  const Json data = data_of(evaluated_page(sample));
  const SE3& T = sample.metrics.T_truth_estimate;
  ASSERT_EQ(data["robots"].size(), 3u);
  EXPECT_EQ(data["frame"], "truth");
  for (std::size_t r = 0; r < 3; ++r) {
    const auto& robot = sample.result.robots[r];
    const Json& shown = data["robots"][r];
    EXPECT_EQ(shown["id"], robot.id);
    ASSERT_EQ(shown["estimate"]["x"].size(), robot.estimate.size());
    for (std::size_t k = 0; k < robot.estimate.size(); ++k) {
      const Eigen::Vector3d p = T * robot.estimate[k].pose.translation();
      EXPECT_NEAR(shown["estimate"]["x"][k].get<double>(), p.x(), 0.00051);
      EXPECT_NEAR(shown["estimate"]["y"][k].get<double>(), p.y(), 0.00051);
      EXPECT_NEAR(data["start_s"].get<double>() + shown["estimate"]["t"][k].get<double>(),
                  robot.estimate[k].stamp.seconds(), 0.00101);
    }
    EXPECT_NEAR(shown["truth"]["x"][7].get<double>(), sample.truth.robots[r].poses[7].pose.translation().x(),
                0.00051);
    EXPECT_NEAR(shown["ate"]["rmse_m"].get<double>(), sample.metrics.robots[r].ate->rmse_m, 0.00051);
    EXPECT_EQ(shown["errors"]["error_m"].size(), sample.metrics.robots[r].errors.size());
  }
}

TEST(Report, NumbersAreShort) {
  const std::string text = data_text(evaluated_page(make_sample({.keyframes = 200})));
  EXPECT_FALSE(std::regex_search(text, std::regex("\\.[0-9]{12}")));
  EXPECT_EQ(count_of(text, "-0.0,"), 0u);
}

TEST(Report, EvaluatesDeadReckoningUnderTheSameRules) {
  const Sample sample = make_sample();
  std::vector<EstimatedTrajectory> odometry;
  for (const auto& robot : sample.result.robots) odometry.push_back({robot.id, robot.odometry});
  const auto expected = evaluate_trajectories(odometry, sample.truth, 2);
  const Json accuracy = data_of(evaluated_page(sample))["accuracy"];
  EXPECT_NEAR(accuracy["dead_reckoning"]["rmse_m"].get<double>(), expected.ate->rmse_m, 0.00051);
  EXPECT_NEAR(accuracy["ratio"].get<double>(), sample.metrics.ate->rmse_m / expected.ate->rmse_m, 1e-5);
}

TEST(Report, StatedSigmasStandBesideTheErrors) {
  Sample sample = make_sample({.keyframes = 50});
  sample.metrics = evaluate_trajectories(team_estimate(sample.result), sample.truth, 2);
  const Json page = data_of(evaluated_page(sample));
  for (std::size_t r = 0; r < sample.result.robots.size(); ++r) {
    const Json& errors = page["robots"][r]["errors"];
    ASSERT_EQ(errors["sigma_m"].size(), errors["error_m"].size());
    for (std::size_t k = 0; k < errors["sigma_m"].size(); ++k)
      EXPECT_NEAR(errors["sigma_m"][k].get<double>(), sample.result.robots[r].sigma_team_m[k], 0.00051);
  }
  EXPECT_NEAR(page["accuracy"]["share_within_3_sigma"].get<double>(),
              sample.metrics.team_consistency->share_within_3_sigma, 0.00006);
  for (auto& robot : sample.result.robots) robot.sigma_position_m.clear(), robot.sigma_team_m.clear();
  sample.metrics = evaluate_trajectories(team_estimate(sample.result), sample.truth, 2);
  const Json without = data_of(evaluated_page(sample));
  EXPECT_FALSE(without["robots"][0]["errors"].contains("sigma_m"));
  EXPECT_FALSE(without["accuracy"].contains("share_within_3_sigma"));
}

TEST(Report, QuantilesRunFromTheLeastToTheLargestError) {
  const Sample sample = make_sample();
  const auto quantiles =
      data_of(evaluated_page(sample))["accuracy"]["quantiles_m"].get<std::vector<double>>();
  double largest = 0;
  for (const auto& robot : sample.metrics.robots)
    for (const auto& error : robot.errors) largest = std::max(largest, error.error_m);
  EXPECT_NEAR(quantiles.back(), largest, 0.00051);
  EXPECT_NEAR(quantiles[100], sample.metrics.ate->median_m, 0.01);
  for (std::size_t q = 1; q < quantiles.size(); ++q) EXPECT_LE(quantiles[q - 1], quantiles[q]);
}

TEST(Report, ClosuresAreAtTheirKeyframes) {
  const Sample sample = make_sample({.keyframes = 100, .closures = 200});
  const Json closures = data_of(evaluated_page(sample))["closures"];
  const Json& drawn = closures["drawn"];
  ASSERT_EQ(drawn["group"].size(), 200u);
  std::multiset<std::tuple<int, int, int, int>> expected, shown;
  for (const auto& c : sample.result.closures) {
    const auto keyframe = [&](RobotIndex robot, Stamp stamp) {
      const auto& estimate = sample.result.robots[robot.index()].estimate;
      return static_cast<int>(
          std::find_if(estimate.begin(), estimate.end(), [&](const auto& p) { return p.stamp == stamp; }) -
          estimate.begin());
    };
    expected.insert(
        {c.robot_i.value, keyframe(c.robot_i, c.stamp_i), c.robot_j.value, keyframe(c.robot_j, c.stamp_j)});
  }
  for (std::size_t c = 0; c < 200; ++c)
    shown.insert({drawn["robot_i"][c].get<int>(), drawn["keyframe_i"][c].get<int>(),
                  drawn["robot_j"][c].get<int>(), drawn["keyframe_j"][c].get<int>()});
  EXPECT_EQ(shown, expected);
}

TEST(Report, ThinningCountsEverything) {
  const Sample sample = make_sample({.keyframes = 500, .closures = 3000});
  ReportParams params;
  params.max_closures = 300;
  params.max_poses = 300;
  params.max_errors = 300;
  const Json data = data_of(evaluated_page(sample, params));
  std::size_t count = 0, drawn = 0, by_reason = 0;
  for (const Json& group : data["closures"]["groups"]) {
    count += group["count"].get<std::size_t>();
    drawn += group["drawn"].get<std::size_t>();
  }
  for (const Json& row : data["closures"]["reasons"]) by_reason += row["count"].get<std::size_t>();
  EXPECT_EQ(count, 3000u);
  EXPECT_EQ(by_reason, 3000u);
  EXPECT_LE(drawn, 300u);
  EXPECT_GE(drawn, 290u);
  for (const Json& robot : data["robots"]) {
    EXPECT_EQ(robot["estimate"]["x"].size(), 100u);
    EXPECT_EQ(robot["sigma_m"].size(), 100u);
    EXPECT_EQ(robot["keyframes"], 500);
  }
  for (std::size_t c = 0; c < drawn; ++c)
    EXPECT_LT(data["closures"]["drawn"]["keyframe_i"][c].get<int>(), 100);
}

TEST(Report, LargeCountsAreExact) {
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  sample.result.counts["pairs"] = 7167256;
  sample.result.counts["share"] = 0.123456789;
  const Json counts = data_of(evaluated_page(sample))["counts"];
  EXPECT_EQ(counts["pairs"], 7167256);
  EXPECT_EQ(counts["share"], 0.123457);
}

TEST(Report, ForeignTextStaysText) {
  const std::string hostile = "</script><script>alert(1)</script><!--\"'&\n\xff";
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  const std::string harmless = evaluated_page(sample);
  sample.result.mission_name = hostile;
  sample.result.robots[0].id = sample.truth.robots[0].id = hostile;
  sample.result.closures[0].reason = hostile;
  sample.result.notes = {hostile};
  sample.result.unplaced = {hostile};
  sample.result.parameters[0].description = hostile;
  const std::string page = evaluated_page(sample);
  EXPECT_EQ(count_of(page, "<script"), count_of(harmless, "<script"));
  EXPECT_EQ(count_of(page, "</script"), count_of(harmless, "</script"));
  EXPECT_EQ(data_text(page).find('<'), std::string::npos);
  const auto name = data_of(page)["mission"].get<std::string>();
  EXPECT_EQ(name.substr(0, hostile.size() - 1), hostile.substr(0, hostile.size() - 1));
}

TEST(Report, NothingOnThePageBecomesMarkup) {
  const std::string page = evaluated_page(make_sample({.keyframes = 20, .closures = 5}));
  const std::string script = page.substr(page.rfind("<script>"));
  for (const char* way :
       {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", ".html(", "eval("})
    EXPECT_EQ(count_of(script, way), 0u) << way;
}

TEST(Report, SameRunSameBytes) { EXPECT_EQ(evaluated_page(make_sample()), evaluated_page(make_sample())); }

TEST(Report, WithoutTruthThereIsNoEvaluation) {
  const Sample sample = make_sample({.keyframes = 50});
  const Json data = data_of(render_report(sample.result));
  EXPECT_EQ(data["frame"], "estimate");
  EXPECT_FALSE(data.contains("accuracy"));
  for (const Json& robot : data["robots"])
    for (const char* key : {"truth", "errors", "ate", "dead_reckoning"})
      EXPECT_FALSE(robot.contains(key)) << key;
  EXPECT_NEAR(data["robots"][0]["estimate"]["x"][3].get<double>(),
              sample.result.robots[0].estimate[3].pose.translation().x(), 0.00051);
}

TEST(Report, AnEmptyRunIsAPage) {
  const Json data = data_of(render_report(RunResult{}));
  EXPECT_TRUE(data["robots"].empty());
  EXPECT_TRUE(data["closures"]["groups"].empty());
  EXPECT_FALSE(data.contains("similarity"));
}

TEST(Report, RobotsWithoutPosesHaveNoClosuresDrawn) {
  Sample sample = make_sample({.keyframes = 20, .closures = 50});
  sample.result.robots[1].estimate = {};
  sample.result.robots[1].odometry = {};
  sample.result.robots[1].sigma_position_m.clear();
  sample.result.robots[1].sigma_team_m.clear();
  const Json data = data_of(render_report(sample.result));
  EXPECT_TRUE(data["robots"][1]["estimate"]["x"].empty());
  for (std::size_t c = 0; c < data["closures"]["drawn"]["group"].size(); ++c) {
    EXPECT_NE(data["closures"]["drawn"]["robot_i"][c], 1);
    EXPECT_NE(data["closures"]["drawn"]["robot_j"][c], 1);
  }
}

TEST(Report, WhatIsNotANumberIsNull) {
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  sample.result.robots[0].sigma_position_m[3] = std::numeric_limits<double>::infinity();
  sample.result.robots[0].scale_error = std::nan("");
  const Json robot = data_of(render_report(sample.result))["robots"][0];
  EXPECT_TRUE(robot["sigma_m"][3].is_null());
  EXPECT_TRUE(robot["scale_error"].is_null());
}

TEST(Report, SpaceHasHeights) {
  const Json data =
      data_of(evaluated_page(make_sample({.robots = 1, .keyframes = 30, .closures = 0, .dimension = 3})));
  EXPECT_EQ(data["robots"][0]["estimate"]["z"].size(), 30u);
  EXPECT_FALSE(
      data_of(evaluated_page(make_sample({.keyframes = 30})))["robots"][0]["estimate"].contains("z"));
}

TEST(Report, ShowsClosuresAgainstTheTruth) {
  const auto sample = make_sample({});
  const ClosuresByKind compared{{ClosureKind::kAoa, {6, 3, 2, 1, 3, 2, 1}}};
  const Json rows =
      data_of(render_report(sample.result, &sample.truth, sample.metrics, compared))["closures"]["compared"];
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0]["kind"], "aoa");
  EXPECT_EQ(rows[0]["direct_found"], 3);
  EXPECT_EQ(rows[0]["wrong_path"], 2);
  EXPECT_EQ(rows[0]["none_direct"], 1);
}

}  // namespace
}  // namespace radioslam
