#include "radioslam/study/study_page.hpp"

#include "radioslam/geometry/se2.hpp"
#include "radioslam/report/aoa_data.hpp"
#include "radioslam/report/embedded_data.hpp"
#include "radioslam/report/rounding.hpp"
#include "radioslam/study/page_parts.hpp"
#include "radioslam/study/rendezvous/rendezvous_json.hpp"
#include "radioslam/study/study_json.hpp"

namespace radioslam {
namespace {

using Json = nlohmann::ordered_json;

Json table_json(const StudyTable& table) {
  Json rows = Json::array();
  for (const StudyRow& row : table.rows) rows.push_back({{"label", row.label}, {"cells", row.cells}});
  return {{"title", table.title},
          {"lead", table.lead},
          {"columns", table.columns},
          {"rows", std::move(rows)},
          {"notes", table.notes}};
}

std::string page(const Json& data) {
  return embed_data(study_page::page_head(), data, study_page::page_tail());
}

constexpr int kDecimals = 3;
constexpr std::size_t kProfileValues = 180;

Json direction_json(const AoaLink& link) {
  Json peaks = Json::array(), profile = Json::array(), authors = Json::array();
  for (const AoaPeak& peak : link.peaks)
    peaks.push_back({{"azimuth_rad", rounded(peak.azimuth_rad, kDecimals)}});
  for (const float power : thinned_profile(link.profile, kProfileValues))
    profile.push_back(rounded(static_cast<double>(power), kDecimals));
  for (const double error_rad : link.published_rad)  // the truth minus the authors' measurement
    authors.push_back(rounded(wrap_angle(link.true_azimuth_rad - error_rad), kDecimals));
  return {{"trial", link.trial},
          {"transmitter", link.transmitter},
          {"sight", word_for(link.sight)},
          {"motion", word_for(link.motion)},
          {"true_azimuth_rad", rounded(link.true_azimuth_rad, kDecimals)},
          {"authors_azimuth_rad", std::move(authors)},
          {"peaks", std::move(peaks)},
          {"profile", std::move(profile)},
          {"reason", link.reason}};
}

Json points_json(const std::vector<Eigen::Vector2d>& points) {
  constexpr int kCentimetres = 2;
  Json json = Json::array();
  for (const Eigen::Vector2d& p : points)
    json.push_back({rounded(p.x(), kCentimetres), rounded(p.y(), kCentimetres)});
  return json;
}

Json way_json(const std::string& name, const PlaceRun& run) {
  Json robots = Json::array();
  for (const RobotPath& path : run.paths)
    robots.push_back({{"robot", path.robot},
                      {"truth", points_json(path.truth)},
                      {"estimate", points_json(path.estimate)}});
  return {{"name", name},
          {"ate_m", run.ate_m ? Json(rounded(*run.ate_m, kDecimals)) : Json()},
          {"robots", std::move(robots)}};
}

Json tables_json(const StudyTable& table, const std::vector<StudyTable>& further) {
  Json data = table_json(table);
  for (const StudyTable& other : further) data["further"].push_back(table_json(other));
  return data;
}

}  // namespace

std::string render_table_page(const StudyTable& table, const std::vector<StudyTable>& further) {
  return page(tables_json(table, further));
}

std::string render_places_page(const StudyTable& table, const std::vector<StudyTable>& further,
                               const PlaceStudy& drawn) {
  Json data = tables_json(table, further);
  const PlaceRuns& runs = drawn.runs.front();
  data["ways"] = {{"seed", drawn.seed},
                  {"runs",
                   {way_json("no radio", runs.without_radio), way_json("no pruning", runs.unpruned),
                    way_json("pruning", runs.pruned)}}};
  return page(data);
}

std::string render_robustness_page(const RobustnessMap& map) {
  Json data = table_json(robustness_table(map));
  data["map"] = robustness_json(map);
  return page(data);
}

std::string render_aoa_page(const StudyTable& table, const std::vector<AoaLink>& links) {
  Json data = table_json(table);
  data["directions"] = Json::array();
  for (const AoaLink& link : links) data["directions"].push_back(direction_json(link));
  return page(data);
}

std::string render_growth_page(const OverlapGrowth& growth) {
  Json data = table_json(overlap_growth_table(growth));
  data["growth"] = overlap_growth_json(growth);
  return page(data);
}

std::string render_budget_page(const std::vector<BudgetMission>& missions) {
  Json data = table_json(budget_table(missions));
  data["budget"] = verification_budget_json(missions);
  return page(data);
}

std::string render_distributed_page(const std::vector<DistributedTeam>& teams) {
  Json data = table_json(distributed_table(teams));
  data["distributed"] = distributed_optimization_json(teams);
  return page(data);
}

std::string render_team_page(const TeamStudy& study) {
  Json data = table_json(team_table(study));
  data["team"] = team_json(study);
  return page(data);
}

std::string render_rendezvous_page(const RendezvousStudy& study) {
  Json data = table_json(rendezvous_table(study));
  data["rendezvous"] = rendezvous_page_json(study);
  return page(data);
}

}  // namespace radioslam
