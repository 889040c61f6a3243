#include "radioslam/report/report.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "report/sample_run.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::json;
using sample::make_sample;
using sample::Sample;

const std::string kDataBegins = "<script type=\"application/json\" id=\"data\">";

std::string data_text(const std::string& page) {
  const auto begin = page.find(kDataBegins);
  EXPECT_NE(begin, std::string::npos);
  const auto from = begin + kDataBegins.size();
  return page.substr(from, page.find("</script", from) - from);
}

Json data_of(const std::string& page) { return Json::parse(data_text(page)); }

std::string judged_page(const Sample& sample, const ReportParams& params = {}) {
  return render_report(sample.result, &sample.truth, sample.metrics, params);
}

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
  const std::string page = judged_page(make_sample());
  EXPECT_FALSE(std::regex_search(markup(page), std::regex("(src|href)\\s*=|<link|<iframe|<img|<object")));
  EXPECT_EQ(count_of(page, "@import"), 0u);
  EXPECT_EQ(count_of(page, "url("), 0u);
  EXPECT_EQ(count_of(page, "<script src"), 0u);
  EXPECT_EQ(count_of(page, "default-src 'none'"), 1u);                     // and the browser sees to it
  std::set<std::string> allowed{"http://www.w3.org", "https://d3js.org"};  // namespaces, and d3's banner
  const std::regex address("https?://[A-Za-z0-9.]+");
  for (std::sregex_iterator found(page.begin(), page.end(), address), end; found != end; ++found)
    EXPECT_EQ(allowed.count(found->str()), 1u) << found->str();
}

TEST(Report, HoldsEveryPartOfThePage) {
  const std::string page = judged_page(make_sample({.keyframes = 20, .closures = 5}));
  for (const char* mark : {"@style@", "@script@", "@d3@", "@licence@", "@data@"})
    EXPECT_EQ(count_of(page, mark), 0u) << mark;
  EXPECT_EQ(count_of(page, "d3js.org v5"), 1u);
  EXPECT_EQ(count_of(page, "Redistributions in binary form"), 1u);
  EXPECT_EQ(page.substr(page.size() - 8), "</html>\n");
}

TEST(Report, DataAreTheRunsNumbers) {
  const Sample sample = make_sample({.keyframes = 50, .closures = 30});
  const Json data = data_of(judged_page(sample));
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
  const std::string text = data_text(judged_page(make_sample({.keyframes = 200})));
  EXPECT_FALSE(std::regex_search(text, std::regex("\\.[0-9]{12}")));
  EXPECT_EQ(count_of(text, "-0.0,"), 0u);
}

TEST(Report, JudgesDeadReckoningUnderTheSameRules) {
  const Sample sample = make_sample();
  std::vector<EstimatedTrajectory> odometry;
  for (const auto& robot : sample.result.robots) odometry.push_back({robot.id, robot.odometry});
  const auto expected = evaluate_trajectories(odometry, sample.truth, 2);
  const Json accuracy = data_of(judged_page(sample))["accuracy"];
  EXPECT_NEAR(accuracy["dead_reckoning"]["rmse_m"].get<double>(), expected.ate->rmse_m, 0.00051);
  EXPECT_NEAR(accuracy["ratio"].get<double>(), sample.metrics.ate->rmse_m / expected.ate->rmse_m, 1e-5);
}

TEST(Report, QuantilesRunFromTheLeastToTheLargestError) {
  const Sample sample = make_sample();
  const auto quantiles = data_of(judged_page(sample))["accuracy"]["quantiles_m"].get<std::vector<double>>();
  double largest = 0;
  for (const auto& robot : sample.metrics.robots)
    for (const auto& error : robot.errors) largest = std::max(largest, error.error_m);
  EXPECT_NEAR(quantiles.back(), largest, 0.00051);
  EXPECT_NEAR(quantiles[100], sample.metrics.ate->median_m, 0.01);
  for (std::size_t q = 1; q < quantiles.size(); ++q) EXPECT_LE(quantiles[q - 1], quantiles[q]);
}

TEST(Report, ClosuresStandAtTheirKeyframes) {
  const Sample sample = make_sample({.keyframes = 100, .closures = 200});
  const Json closures = data_of(judged_page(sample))["closures"];
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
  params.maximum_closures = 300;
  params.maximum_poses = 300;
  params.maximum_errors = 300;
  const Json data = data_of(judged_page(sample, params));
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

/// Kept pairs per (robot_i, robot_j, bin_i, bin_j).
using Bins = std::map<std::tuple<std::size_t, std::size_t, std::size_t, std::size_t>, std::size_t>;

Bins bins_of(const Json& candidates) {
  Bins bins;
  for (const Json& m : candidates["matrices"])
    for (std::size_t k = 0; k < m["cell"].size(); ++k) {
      const auto cell = m["cell"][k].get<std::size_t>(), width = m["bins_i"].get<std::size_t>();
      bins[{m["robot_i"].get<std::size_t>(), m["robot_j"].get<std::size_t>(), cell % width, cell / width}] =
          m["count"][k].get<std::size_t>();
    }
  return bins;
}

std::size_t keyframe_of(const RunResult& result, RobotIndex robot, Stamp stamp) {
  const auto& estimate = result.robots[robot.index()].estimate;
  std::size_t k = 0;
  while (estimate[k].stamp != stamp) ++k;
  return k;
}

TEST(Report, EveryCandidateIsInItsBin) {
  const Sample sample = make_sample({.keyframes = 100, .closures = 5, .candidates = 900});
  ReportParams params;
  params.maximum_candidate_cells = 3 * 30 * 30;
  const Json candidates = data_of(judged_page(sample, params))["candidates"];
  Bins expected;
  for (const auto& c : sample.result.candidates)
    ++expected[{c.robot_i.index(), c.robot_j.index(),
                keyframe_of(sample.result, c.robot_i, c.stamp_i) * 30 / 100,
                keyframe_of(sample.result, c.robot_j, c.stamp_j) * 30 / 100}];
  EXPECT_EQ(bins_of(candidates), expected);
  EXPECT_EQ(candidates["kept"], 900);
  EXPECT_EQ(candidates["pairs"], 30000);
  EXPECT_EQ(candidates["distances_evaluated"], 1125);
}

TEST(Report, CandidatesInAnyOrderOfTheirRobotsAreTheSame) {
  Sample sample = make_sample({.keyframes = 60, .closures = 5, .candidates = 200});
  const Json before = data_of(judged_page(sample))["candidates"];
  for (auto& c : sample.result.candidates) {
    std::swap(c.robot_i, c.robot_j);
    std::swap(c.stamp_i, c.stamp_j);
  }
  EXPECT_EQ(data_of(judged_page(sample))["candidates"], before);
}

TEST(Report, TheFullestMatricesAreShownWithinTheBudget) {
  const Sample sample = make_sample({.robots = 12, .keyframes = 200, .closures = 5, .candidates = 20000});
  ReportParams params;
  params.maximum_matrices = 10;
  params.maximum_candidate_cells = 2000;
  const Json candidates = data_of(judged_page(sample, params))["candidates"];
  std::map<std::pair<int, int>, std::size_t> per_pair;
  for (const auto& c : sample.result.candidates) ++per_pair[{c.robot_i.value, c.robot_j.value}];
  std::vector<std::size_t> sizes;
  for (const auto& [robots, kept] : per_pair) sizes.push_back(kept);
  std::sort(sizes.rbegin(), sizes.rend());
  ASSERT_EQ(candidates["matrices"].size(), 10U);
  EXPECT_EQ(candidates["robot_pairs"], per_pair.size());
  std::size_t cells = 0;
  for (std::size_t m = 0; m < 10; ++m) {
    cells += candidates["matrices"][m]["cell"].size();
    EXPECT_EQ(candidates["matrices"][m]["kept"], sizes[m]);
  }
  EXPECT_LE(cells, 2000U);
  EXPECT_GT(cells, 500U);
}

TEST(Report, WithoutASearchThereAreNoCandidates) {
  const Json candidates = data_of(judged_page(make_sample({.keyframes = 20, .closures = 5})))["candidates"];
  EXPECT_TRUE(candidates["pairs"].is_null());
  EXPECT_TRUE(candidates["matrices"].empty());
}

TEST(Report, LargeCountsAreExact) {
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  sample.result.counts["pairs"] = 7167256;
  sample.result.counts["share"] = 0.123456789;
  const Json counts = data_of(judged_page(sample))["counts"];
  EXPECT_EQ(counts["pairs"], 7167256);
  EXPECT_EQ(counts["share"], 0.123457);
}

TEST(Report, AlternativesStandInThePagesFrameAndAreJudged) {
  const Sample sample = make_sample({.keyframes = 50, .closures = 5, .alternatives = 2});
  const Json data = data_of(judged_page(sample));
  ASSERT_EQ(data["alternatives"].size(), 2U);
  EXPECT_EQ(data["weight"], 0.6);
  const auto& other = sample.result.alternatives[1];
  const Json& shown = data["alternatives"][1];
  EXPECT_EQ(shown["weight"], 0.15);
  for (std::size_t r = 0; r < 3; ++r) {
    const Eigen::Vector3d p =
        sample.metrics.T_truth_estimate * other.robots[r].estimate[7].pose.translation();
    EXPECT_NEAR(shown["robots"][r]["x"][7].get<double>(), p.x(), 0.0051);
    EXPECT_NEAR(shown["robots"][r]["y"][7].get<double>(), p.y(), 0.0051);
  }
  std::vector<EstimatedTrajectory> team;
  for (const auto& robot : other.robots) team.push_back({robot.id, robot.estimate});
  EXPECT_NEAR(shown["ate_rmse_m"].get<double>(), evaluate_trajectories(team, sample.truth, 2).ate->rmse_m,
              0.00051);
  EXPECT_GT(shown["ate_rmse_m"].get<double>(), 2);
  const Json unjudged = data_of(render_report(sample.result))["alternatives"];
  EXPECT_FALSE(unjudged[1].contains("ate_rmse_m"));
}

TEST(Report, AlternativesKeepToTheirBudget) {
  const Sample sample = make_sample({.keyframes = 300, .closures = 5, .alternatives = 3});
  ReportParams params;
  params.maximum_alternative_poses = 180;
  std::size_t poses = 0;
  const Json data = data_of(judged_page(sample, params));
  for (const Json& other : data["alternatives"])
    for (const Json& robot : other["robots"]) poses += robot["x"].size();
  EXPECT_LE(poses, 180U);
  EXPECT_GE(poses, 170U);
}

TEST(Report, ForeignTextStaysText) {
  const std::string hostile = "</script><script>alert(1)</script><!--\"'&\n\xff";
  Sample sample = make_sample({.keyframes = 20, .closures = 5});
  const std::string harmless = judged_page(sample);
  sample.result.mission_name = hostile;
  sample.result.robots[0].id = sample.truth.robots[0].id = hostile;
  sample.result.closures[0].reason = hostile;
  sample.result.notes = {hostile};
  sample.result.unplaced = {hostile};
  sample.result.parameters[0].meaning = hostile;
  const std::string page = judged_page(sample);
  EXPECT_EQ(count_of(page, "<script"), count_of(harmless, "<script"));
  EXPECT_EQ(count_of(page, "</script"), count_of(harmless, "</script"));
  EXPECT_EQ(data_text(page).find('<'), std::string::npos);
  const auto name = data_of(page)["mission"].get<std::string>();
  EXPECT_EQ(name.substr(0, hostile.size() - 1), hostile.substr(0, hostile.size() - 1));
}

TEST(Report, NothingOnThePageBecomesMarkup) {
  const std::string page = judged_page(make_sample({.keyframes = 20, .closures = 5}));
  const std::string script = page.substr(page.rfind("<script>"));
  for (const char* way :
       {"innerHTML", "outerHTML", "insertAdjacentHTML", "document.write", ".html(", "eval("})
    EXPECT_EQ(count_of(script, way), 0u) << way;
}

TEST(Report, SameRunSameBytes) { EXPECT_EQ(judged_page(make_sample()), judged_page(make_sample())); }

TEST(Report, WithoutTruthThereIsNoJudgement) {
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
      data_of(judged_page(make_sample({.robots = 1, .keyframes = 30, .closures = 0, .dimension = 3})));
  EXPECT_EQ(data["robots"][0]["estimate"]["z"].size(), 30u);
  EXPECT_FALSE(data_of(judged_page(make_sample({.keyframes = 30})))["robots"][0]["estimate"].contains("z"));
}

}  // namespace
}  // namespace radioslam
