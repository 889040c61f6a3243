#include "radioslam/io/quoted_row.hpp"

#include "radioslam/io/text.hpp"

namespace radioslam {
namespace {

std::string_view without_quotes(std::string_view field) {
  field = trim(field);
  if (field.size() >= 2 && field.starts_with('"') && field.ends_with('"')) {
    field.remove_prefix(1);
    field.remove_suffix(1);
  }
  return field;
}

}  // namespace

std::vector<std::string_view> split_quoted_row(std::string_view line) {
  std::vector<std::string_view> fields;
  bool is_quoted = false;
  std::size_t begin = 0;
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line[k] == '"') is_quoted = !is_quoted;
    if (line[k] != ',' || is_quoted) continue;
    fields.push_back(without_quotes(line.substr(begin, k - begin)));
    begin = k + 1;
  }
  fields.push_back(without_quotes(line.substr(begin)));
  return fields;
}

}  // namespace radioslam
