// The page of a sample run, and its data.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "radioslam/report/report.hpp"
#include "report/sample_run.hpp"

namespace radioslam::sample {

using Json = nlohmann::json;

inline const std::string kDataBegins = "<script type=\"application/json\" id=\"data\">";

inline std::string data_text(const std::string& page) {
  const auto begin = page.find(kDataBegins);
  EXPECT_NE(begin, std::string::npos);
  const auto from = begin + kDataBegins.size();
  return page.substr(from, page.find("</script", from) - from);
}

inline Json data_of(const std::string& page) { return Json::parse(data_text(page)); }

inline std::string evaluated_page(const Sample& sample, const ReportParams& params = {}) {
  return render_report(sample.result, &sample.truth, sample.metrics, {}, params);
}

}  // namespace radioslam::sample
