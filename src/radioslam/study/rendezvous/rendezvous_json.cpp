#include "radioslam/study/rendezvous/rendezvous_json.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "radioslam/rendezvous_world/run_json.hpp"
#include "radioslam/report/rounding.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDecimals = 2;
constexpr double kDegree = std::numbers::pi / 180;

struct MeanAndSpread {
  double mean = 0, spread = 0;
};

template <class Value>
MeanAndSpread over_runs(const RendezvousSeries& series, const Value& value) {
  MeanAndSpread result;
  const auto count = static_cast<double>(series.runs.size());
  for (const RendezvousRun& run : series.runs) result.mean += value(run) / count;
  for (const RendezvousRun& run : series.runs)
    result.spread += (value(run) - result.mean) * (value(run) - result.mean) / count;
  result.spread = std::sqrt(result.spread);
  return result;
}

/// Mean over the runs, iteration by iteration, with a band of a standard deviation.
Json error_series(const RendezvousSeries& series) {
  Json points = Json::array(), band = Json::array();
  for (std::size_t k = 0; k < series.runs.front().error.size(); ++k) {
    const auto error = over_runs(series, [&](const RendezvousRun& run) { return run.error.at(k); });
    points.push_back({k + 1, rounded(error.mean, kDecimals)});
    band.push_back({k + 1, rounded(std::max(0.0, error.mean - error.spread), kDecimals),
                    rounded(error.mean + error.spread, kDecimals)});
  }
  Json json{{"name", series.name}, {"points", std::move(points)}};
  json["band"] = series.runs.size() > 1 ? std::move(band) : Json(nullptr);
  return json;
}

/// Iterations at which two robots of the run saw each other for the first time after a while.
Json meeting_marks(const RendezvousRun& run) {
  Json marks = Json::array();
  bool before = false;
  for (std::size_t k = 0; k < run.moments.size(); ++k) {
    const bool seeing = std::any_of(run.moments[k].begin(), run.moments[k].end(),
                                    [](const RobotMoment& moment) { return moment.seeing; });
    if (seeing && !before) marks.push_back({{"x", k + 1}, {"name", "meeting"}});
    before = seeing;
  }
  return marks;
}

Json error_chart(const RendezvousFigure& figure) {
  Json series = Json::array(), marks = Json::array();
  for (const RendezvousSeries& each : figure.series) {
    series.push_back(error_series(each));
    if (each.name == "active" && each.runs.size() == 1) marks = meeting_marks(each.runs.front());
  }
  return {{"kind", "lines"},
          {"title", figure.title},
          {"caption", figure.caption},
          {"x", "iteration"},
          {"y", "trajectory error"},
          {"threshold", figure.series.front().runs.front().delta},
          {"series", std::move(series)},
          {"marks", std::move(marks)}};
}

/// Mean squared errors relative to those of the first series, in percent.
Json true_error_chart(const RendezvousFigure& figure) {
  const auto squared = [](const RendezvousRun& run) { return run.ate_trans_mean_squared; };
  const double whole = over_runs(figure.series.front(), squared).mean;
  Json series = Json::array();
  for (const RendezvousSeries& each : figure.series) {
    const auto error = over_runs(each, squared);
    Json published = nullptr;
    if (each.name == "random") published = 100;
    if (each.name == "active") published = 36;
    series.push_back({{"name", each.name},
                      {"values", {std::move(published), rounded(100 * error.mean / whole, 1)}},
                      {"spread", {nullptr, rounded(100 * error.spread / whole, 1)}}});
  }
  return {{"kind", "bars"},
          {"title", figure.title},
          {"caption", figure.caption},
          {"y", "mean squared error (%)"},
          {"groups", {"Wang et al.", "here"}},
          {"series", std::move(series)}};
}

Json outlier_chart(const std::vector<RendezvousFigure>& figures) {
  Json groups = Json::array(), series = Json::array();
  for (const RendezvousFigure& figure : figures) groups.push_back(figure.title);
  for (std::size_t k = 0; k < figures.front().series.size(); ++k) {
    Json values = Json::array(), spread = Json::array();
    for (const RendezvousFigure& figure : figures) {
      const auto error =
          over_runs(figure.series[k], [](const RendezvousRun& run) { return run.ate_trans_mean_squared; });
      values.push_back(rounded(error.mean, kDecimals));
      spread.push_back(nullptr);
    }
    series.push_back({{"name", figures.front().series[k].name},
                      {"values", std::move(values)},
                      {"spread", std::move(spread)}});
  }
  return {{"kind", "bars"},
          {"title", "Figure 10 a: outliers, weighed by angles of arrival"},
          {"caption", figures.front().caption + " A share of 0.3 of the relative poses is wrong."},
          {"y", "mean squared error (m²)"},
          {"groups", std::move(groups)},
          {"series", std::move(series)}};
}

Json angle_chart(const AngleErrors& errors) {
  constexpr int kWidth = 3, kLast = 45;  // degrees
  Json edges = Json::array(), shares = Json::array(), curve = Json::array();
  for (int low = -kLast; low < kLast; low += kWidth) {
    const auto inside = [&](double error) {
      return error >= low * kDegree && error < (low + kWidth) * kDegree;
    };
    const auto count = std::count_if(errors.strongest_rad.begin(), errors.strongest_rad.end(), inside);
    edges.push_back(low);
    shares.push_back(
        rounded(static_cast<double>(count) / static_cast<double>(errors.strongest_rad.size()), 4));
  }
  edges.push_back(kLast);
  for (int at = -kLast; at <= kLast; ++at) {
    const double scaled = at * kDegree / errors.sigma_rad;
    const double density =
        std::exp(-0.5 * scaled * scaled) / (errors.sigma_rad * std::sqrt(2 * std::numbers::pi));
    curve.push_back({at, rounded(density * kWidth * kDegree, 4)});
  }
  return {
      {"kind", "histogram"},
      {"title", "Figure 10 b: errors of the strongest arrival"},
      {"caption",
       "10 robots on 900 m² with boxes, all packets heard; beyond the curve: reflections and shadowed direct "
       "paths."},
      {"x", "angle error (degrees)"},
      {"y", "share"},
      {"edges", std::move(edges)},
      {"series", {{{"name", "simulated"}, {"shares", std::move(shares)}}}},
      {"curve", {{"name", "normal, 8.5 degrees as in Wang et al."}, {"points", std::move(curve)}}}};
}

Json growth_chart(const std::vector<TeamGrowth>& growth) {
  Json points = Json::array();
  for (const TeamGrowth& each : growth) points.push_back({each.robots, rounded(each.seconds, kDecimals)});
  return {{"kind", "lines"},
          {"title", "Run time over the size of the team"},
          {"caption", "50 steps, 200 m² per robot, policy active."},
          {"x", "robots"},
          {"y", "seconds"},
          {"threshold", nullptr},
          {"series", {{{"name", "active"}, {"points", std::move(points)}, {"band", nullptr}}}},
          {"marks", Json::array()}};
}

Json iteration_json(const std::vector<RobotMoment>& moments) {
  Json json{{"truth", Json::array()},   {"estimate", Json::array()}, {"error", Json::array()},
            {"sigma_m", Json::array()}, {"asking", Json::array()},   {"serving", Json::array()},
            {"seeing", Json::array()}};
  for (const RobotMoment& moment : moments) {
    const auto& truth = moment.truth.translation();
    const auto& estimate = moment.estimate.translation();
    json["truth"].push_back({rounded(truth.x(), kDecimals), rounded(truth.y(), kDecimals),
                             rounded(moment.truth.angle(), kDecimals)});
    json["estimate"].push_back({rounded(estimate.x(), kDecimals), rounded(estimate.y(), kDecimals)});
    json["error"].push_back(rounded(moment.error, kDecimals));
    json["sigma_m"].push_back(rounded(moment.sigma_m, kDecimals));
    json["asking"].push_back(moment.asking ? 1 : 0);
    json["serving"].push_back(moment.serving);
    json["seeing"].push_back(moment.seeing ? 1 : 0);
  }
  return json;
}

Json replay_json(const RendezvousReplay& replay) {
  Json boxes = Json::array(), names = Json::array(), iterations = Json::array();
  for (const ArenaBox& box : replay.arena.boxes())
    boxes.push_back({rounded(box.low_m.x(), kDecimals), rounded(box.low_m.y(), kDecimals),
                     rounded(box.high_m.x(), kDecimals), rounded(box.high_m.y(), kDecimals)});
  for (int k = 1; k <= replay.params.robots; ++k) names.push_back("r" + std::to_string(k));
  for (const auto& moments : replay.run.moments) iterations.push_back(iteration_json(moments));
  return {{"name", replay.name},
          {"side_m", replay.arena.side_m()},
          {"delta", replay.run.delta},
          {"sensing_range_m", replay.params.sensing_range_m},
          {"boxes", std::move(boxes)},
          {"robots", std::move(names)},
          {"iterations", std::move(iterations)}};
}

Json figure_json(const RendezvousFigure& figure) {
  Json json{{"title", figure.title}, {"series", Json::array()}};
  for (const RendezvousSeries& series : figure.series) {
    Json runs = Json::array();
    for (const RendezvousRun& run : series.runs) runs.push_back(rendezvous_run_json(run));
    json["series"].push_back({{"name", series.name}, {"runs", std::move(runs)}});
  }
  return json;
}

}  // namespace

Json rendezvous_page_json(const RendezvousStudy& study) {
  Json charts = Json::array(), replays = Json::array();
  charts.push_back(error_chart(study.team_error));
  charts.push_back(true_error_chart(study.true_error));
  for (std::size_t k = 0; k < study.trial.size(); ++k) {
    charts.push_back(error_chart(study.trial[k]));
    charts.push_back(error_chart(study.trials[k]));
  }
  charts.push_back(outlier_chart(study.outliers));
  charts.push_back(angle_chart(study.angles));
  charts.push_back(growth_chart(study.growth));
  for (const RendezvousReplay& replay : study.replays) replays.push_back(replay_json(replay));
  return {{"charts", std::move(charts)}, {"replays", std::move(replays)}};
}

Json rendezvous_json(const RendezvousStudy& study) {
  Json figures = Json::array(), growth = Json::array();
  for (const RendezvousFigure* figure : {&study.team_error, &study.true_error})
    figures.push_back(figure_json(*figure));
  for (const auto* list : {&study.trial, &study.trials, &study.outliers})
    for (const RendezvousFigure& figure : *list) figures.push_back(figure_json(figure));
  for (const TeamGrowth& each : study.growth)
    growth.push_back({{"robots", each.robots}, {"seconds", each.seconds}});
  return {{"table", "rendezvous"}, {"figures", std::move(figures)}, {"growth", std::move(growth)}};
}

}  // namespace radioslam
