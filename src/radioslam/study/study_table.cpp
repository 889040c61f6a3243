#include "radioslam/study/study_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "radioslam/eval/metrics.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLineWidth = 110;
constexpr const char* kNothing = "–";
constexpr double kHalf = 0.5;

/// Displayed width in characters: UTF-8 continuation bytes take no space.
std::size_t width_of(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    constexpr unsigned char kKindBits = 0xC0, kContinuation = 0x80;
    return (static_cast<unsigned char>(c) & kKindBits) != kContinuation;
  }));
}

std::string left(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, width_of(text)), ' ');
}
std::string right(const std::string& text, std::size_t width) {
  return std::string(width - std::min(width, width_of(text)), ' ') + text;
}

std::vector<std::size_t> column_widths(const StudyTable& table) {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    widths.push_back(width_of(table.columns[c]));
    for (const StudyRow& row : table.rows) widths.back() = std::max(widths.back(), width_of(row.cells[c]));
  }
  return widths;
}

std::string line(const std::string& label, const std::vector<std::string>& cells, std::size_t label_width,
                 const std::vector<std::size_t>& widths) {
  std::string text = left(label, label_width);
  for (std::size_t c = 0; c < cells.size(); ++c) text += "  " + right(cells[c], widths[c]);
  return text + '\n';
}

/// The text in lines of at most kLineWidth, all but the first indented.
std::string wrapped(const std::string& text, const std::string& indent) {
  std::istringstream words(text);
  std::string word, lines, current;
  while (words >> word) {
    if (!current.empty() && width_of(current) + 1 + width_of(word) > kLineWidth) {
      lines += current + '\n';
      current = indent;
    } else if (!current.empty()) {
      current += ' ';
    }
    current += word;
  }
  return lines + current + '\n';
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("'") : std::string(1, c);
  return result + '"';
}

}  // namespace

std::string table_text(const StudyTable& table) {
  std::size_t label_width = 0;
  for (const StudyRow& row : table.rows) label_width = std::max(label_width, width_of(row.label));
  const auto widths = column_widths(table);
  std::string text = table.title + "\n" + wrapped(table.lead, "") + "\n";
  text += line("", table.columns, label_width, widths);
  for (const StudyRow& row : table.rows) text += line(row.label, row.cells, label_width, widths);
  if (!table.notes.empty()) text += '\n';
  for (const auto& note : table.notes) text += wrapped("- " + note, "  ");
  return text;
}

std::string table_csv(const StudyTable& table) {
  std::string text = quoted("what");
  for (const auto& column : table.columns) text += ',' + quoted(column);
  text += '\n';
  for (const StudyRow& row : table.rows) {
    text += quoted(row.label);
    for (const auto& cell : row.cells) text += ',' + quoted(cell);
    text += '\n';
  }
  return text;
}

std::string number_text(std::optional<double> value, int decimals) {
  if (!value || !std::isfinite(*value)) return kNothing;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.*f", decimals, *value);
  std::string text = buffer;
  constexpr std::size_t kGroup = 3;
  const std::size_t first = text.front() == '-' ? 1 : 0;
  for (std::size_t at = std::min(text.find('.'), text.size()); at > first + kGroup; at -= kGroup)
    text.insert(at - kGroup, ",");
  return text;
}

std::string percent_text(std::optional<double> ratio, int decimals) {
  constexpr double kPercent = 100;
  if (!ratio) return kNothing;
  return number_text(kPercent * *ratio, decimals) + " %";
}

std::optional<double> median_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  return quantile(values, kHalf);
}

std::string seeds_text(std::uint64_t first, std::size_t count) {
  if (count == 1) return "Seed " + std::to_string(first);
  return "Medians of " + std::to_string(count) + " seeds from " + std::to_string(first) + " on";
}

}  // namespace radioslam
