#include "radioslam/study/study_page.hpp"

#include "radioslam/report/embedded_data.hpp"
#include "radioslam/study/page_parts.hpp"
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

}  // namespace

std::string render_table_page(const StudyTable& table) { return page(table_json(table)); }

std::string render_robustness_page(const RobustnessMap& map) {
  Json data = table_json(robustness_table(map));
  data["map"] = robustness_json(map);
  return page(data);
}

std::string render_growth_page(const OverlapGrowth& growth) {
  Json data = table_json(overlap_growth_table(growth));
  data["growth"] = overlap_growth_json(growth);
  return page(data);
}

}  // namespace radioslam
