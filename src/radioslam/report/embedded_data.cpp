#include "radioslam/report/embedded_data.hpp"

namespace radioslam {
namespace {

/// Escapes '<', the only character that can end or change anything in a script element; in JSON it occurs in
/// strings only.
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

std::string embed_data(std::string_view head, const nlohmann::ordered_json& data, std::string_view tail) {
  const std::string json = data.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  return std::string(head) + escape_for_script(json) + std::string(tail);
}

}  // namespace radioslam
