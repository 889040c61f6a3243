#include "radioslam/io/lidar/pcd_header.hpp"

#include <map>
#include <optional>

#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxPointCount = std::size_t{1} << 32U;
constexpr std::size_t kMaxFieldCount = 1 << 16;  ///< largest number of values per point in one field

/// The words of each header line, by its keyword.
using PcdEntries = std::map<std::string, std::vector<std::string>, std::less<>>;

bool is_pcd_keyword(std::string_view word) {
  for (const char* known :
       {"VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA"})
    if (word == known) return true;
  return false;
}

PcdEntries read_entries(TextLines& lines) {
  PcdEntries entries;
  while (!entries.contains("DATA")) {
    if (!lines.next_with_content()) lines.fail("the header ends before DATA: not a PCD file");
    LineFields fields(lines);
    const std::string keyword(fields.next("a keyword"));
    if (!is_pcd_keyword(keyword)) lines.fail("not a line of a PCD header");
    auto [entry, is_new] = entries.try_emplace(keyword);
    if (!is_new) lines.fail(keyword + " appears twice");
    while (!fields.empty()) entry->second.emplace_back(fields.next("a value"));
  }
  return entries;
}

/// The words of a keyword's line; refuses a missing line.
const std::vector<std::string>& words_of(const TextLines& at, const PcdEntries& entries,
                                         const char* keyword) {
  const auto entry = entries.find(keyword);
  if (entry == entries.end()) at.fail(std::string("the header has no ") + keyword);
  return entry->second;
}

std::size_t count_of(const TextLines& at, const std::string& word, const char* keyword, std::size_t limit) {
  const auto count = parse_id(word);
  if (!count || *count > limit) at.fail(keyword + (" '" + word) + "' is not a valid count");
  return *count;
}

NumberType number_type(const TextLines& at, const std::string& type, const std::string& size) {
  static const std::map<std::string, NumberType> types{
      {"I1", NumberType::kInt8},   {"U1", NumberType::kUint8},  {"I2", NumberType::kInt16},
      {"U2", NumberType::kUint16}, {"I4", NumberType::kInt32},  {"U4", NumberType::kUint32},
      {"I8", NumberType::kInt64},  {"U8", NumberType::kUint64}, {"F4", NumberType::kFloat32},
      {"F8", NumberType::kFloat64}};
  const auto found = types.find(type + size);
  if (found == types.end()) at.fail("unsupported field of TYPE " + type + " and SIZE " + size);
  return found->second;
}

std::vector<PcdField> fields_of(const TextLines& at, const PcdEntries& entries) {
  const auto& names = words_of(at, entries, "FIELDS");
  const auto& sizes = words_of(at, entries, "SIZE");
  const auto& types = words_of(at, entries, "TYPE");
  const bool has_counts = entries.contains("COUNT");
  if (sizes.size() != names.size() || types.size() != names.size() ||
      (has_counts && words_of(at, entries, "COUNT").size() != names.size()))
    at.fail("FIELDS, SIZE, TYPE and COUNT have different lengths");
  std::vector<PcdField> fields;
  for (std::size_t k = 0; k < names.size(); ++k)
    fields.push_back({names[k], number_type(at, types[k], sizes[k]),
                      has_counts ? count_of(at, entries.at("COUNT")[k], "COUNT", kMaxFieldCount) : 1});
  return fields;
}

/// The number of a keyword with one value, if the line exists.
std::optional<std::size_t> count_in(const TextLines& at, const PcdEntries& entries, const char* keyword) {
  const auto entry = entries.find(keyword);
  if (entry == entries.end()) return std::nullopt;
  if (entry->second.size() != 1) at.fail(std::string(keyword) + " is not one number");
  return count_of(at, entry->second.front(), keyword, kMaxPointCount);
}

std::size_t points_in(const TextLines& at, const PcdEntries& entries) {
  const auto points = count_in(at, entries, "POINTS");
  const auto width = count_in(at, entries, "WIDTH");
  if (!points && !width) at.fail("the header has neither POINTS nor WIDTH");
  if (!width) return *points;
  const std::size_t height = count_in(at, entries, "HEIGHT").value_or(1);
  if (height > 0 && *width > kMaxPointCount / height) at.fail("WIDTH and HEIGHT are implausible");
  if (points && *points != *width * height) at.fail("POINTS is not WIDTH times HEIGHT");
  return *width * height;
}

}  // namespace

PcdHeader read_pcd_header(const Text& file, TextLines& lines) {
  const PcdEntries entries = read_entries(lines);
  const auto& encoding = entries.at("DATA");
  if (encoding.size() != 1) lines.fail("DATA is not one word");
  PcdHeader header{fields_of(lines, entries), points_in(lines, entries), encoding.front(), 0};
  const auto line_end =
      static_cast<std::size_t>(lines.line().data() - file.content.data()) + lines.line().size();
  const std::size_t end = file.content.find('\n', line_end);
  header.data_begin = end == std::string::npos ? file.content.size() : end + 1;
  return header;
}

}  // namespace radioslam
