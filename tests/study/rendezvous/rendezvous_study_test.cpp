#include "radioslam/study/rendezvous/rendezvous_study.hpp"

#include <gtest/gtest.h>

#include "radioslam/study/rendezvous/rendezvous_json.hpp"
#include "radioslam/study/study_page.hpp"

namespace radioslam {
namespace {

RendezvousFigure figure_of(const std::vector<std::string>& names, const RendezvousRun& run) {
  RendezvousFigure figure{"a figure", "a caption", {}};
  for (const std::string& name : names) figure.series.push_back({name, {run}});
  return figure;
}

TEST(RendezvousStudy, ShowsWhatTheRunsSay) {
  RendezvousRunParams params;
  params.iterations = 5;
  params.obstacles = 2;
  RendezvousRunOptions options;
  options.keep_moments = true;
  const RendezvousRun run = run_rendezvous(params, options);
  const std::vector<std::string> policies{"random", "scheduled", "active", "anchored"};
  const std::vector<std::string> weights{"off", "published", "posterior", "left out by label"};
  RendezvousStudy study;
  study.team_error = study.true_error = figure_of(policies, run);
  study.trial = study.trials = {figure_of(policies, run)};
  study.outliers = {figure_of(weights, run)};
  study.angles = {0.15, {0.01, -0.2, 3}};
  study.growth = {{2, run.seconds}};
  study.replays.push_back({"a run", params, arena_of(params, options.seed), run});

  const StudyTable table = rendezvous_table(study);
  for (const StudyRow& row : table.rows) EXPECT_EQ(row.cells.size(), table.columns.size()) << row.label;

  const auto json = rendezvous_page_json(study);
  const auto& replay = json["replays"][0];
  ASSERT_EQ(replay["iterations"].size(), 5U);
  EXPECT_EQ(replay["boxes"].size(), 2U);
  const auto& last = replay["iterations"][4];
  EXPECT_EQ(last["truth"].size(), 2U);
  EXPECT_NEAR(last["truth"][1][0].get<double>(), run.moments[4][1].truth.translation().x(), 0.01);
  EXPECT_EQ(json["charts"][0]["series"][2]["points"].size(), 5U);
  EXPECT_EQ(rendezvous_json(study)["figures"][0]["series"][0]["runs"][0]["error"].size(), 5U);
  EXPECT_NE(render_rendezvous_page(study).find("\"replays\""), std::string::npos);
}

}  // namespace
}  // namespace radioslam
