#include "radioslam/report/report.hpp"

#include "radioslam/report/page_data.hpp"
#include "radioslam/report/page_parts.hpp"

namespace radioslam {
namespace {

/// Inside a script element only '<' can end or change anything; in JSON it stands in strings alone.
std::string escape_for_script(const std::string& json) {
  std::string escaped;
  escaped.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      escaped += "\\u003c";
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace

std::string render_report(const RunResult& result, const Truth* truth,
                          const std::optional<TeamMetrics>& metrics, const ReportParams& params) {
  const PageData data = page_data(result, truth, metrics, params);
  const std::string json = data.dump(-1, ' ', false, PageData::error_handler_t::replace);
  return std::string(page_head()) + escape_for_script(json) + std::string(page_tail());
}

}  // namespace radioslam
