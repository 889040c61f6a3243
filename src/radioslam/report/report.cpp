#include "radioslam/report/report.hpp"

#include "radioslam/report/embedded_data.hpp"
#include "radioslam/report/page_data.hpp"
#include "radioslam/report/page_parts.hpp"

namespace radioslam {

std::string render_report(const RunResult& result, const Truth* truth,
                          const std::optional<TeamMetrics>& metrics, const ClosuresByKind& judged_closures,
                          const ReportParams& params) {
  return embed_data(page_head(), page_data(result, truth, metrics, judged_closures, params), page_tail());
}

}  // namespace radioslam
