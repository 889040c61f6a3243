#include "radioslam/report/live/live_page.hpp"

#include <string_view>

#include "radioslam/report/embedded_data.hpp"
#include "radioslam/report/live/live_page_parts.hpp"
#include "radioslam/report/rounding.hpp"

namespace radioslam {
namespace {

/// A report without robots, which the report's own scripts start from.
PageData empty_report(const std::string& robot, int dimension) {
  const PageData list = PageData::array();
  PageData data{{"mission", "Robot " + robot}, {"self", robot}, {"dimension", dimension}, {"start_s", 0}};
  for (const char* key : {"robots", "alternatives", "components", "unplaced", "timings", "maps", "notes"})
    data[key] = list;
  data["closures"] = {{"groups", list}, {"reasons", list}, {"drawn", PageData::object()}};
  for (const char* key : {"group", "robot_i", "keyframe_i", "robot_j", "keyframe_j"})
    data["closures"]["drawn"][key] = list;
  data["candidates"] = PageData::object();
  return data;
}

}  // namespace

std::string live_page_of(const std::string& robot, int dimension, const std::string& nonce) {
  constexpr std::string_view kPlace = "@nonce@";
  std::string head(live_page::page_head()), tail(live_page::page_tail());
  for (std::string* part : {&head, &tail})
    for (std::size_t at = 0; (at = part->find(kPlace, at)) != std::string::npos; at += nonce.size())
      part->replace(at, kPlace.size(), nonce);
  return embed_data(head, empty_report(robot, dimension), tail);
}

}  // namespace radioslam
