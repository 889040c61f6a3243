#include "radioslam/io/lidar/pcd.hpp"

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "radioslam/base/check.hpp"
#include "radioslam/io/lidar/point_table.hpp"
#include "radioslam/io/lidar/point_times.hpp"
#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kLiteralLimit = 32;
constexpr std::size_t kLongCopy = 7;  ///< value of the three length bits that is extended by another byte
constexpr std::size_t kMinCopy = 2;   ///< added to the coded length
constexpr std::size_t kMaxExpansion = 100;  ///< 3 bytes encode 264 at most

std::size_t lzf_byte(std::string_view bytes, std::size_t at) { return static_cast<std::uint8_t>(bytes[at]); }

/// Appends `length` bytes beginning `distance` before the end of `out`; the ranges may overlap.
bool copy_back(std::string& out, std::size_t distance, std::size_t length) {
  if (distance > out.size()) return false;
  for (std::size_t k = 0; k < length; ++k) out += out[out.size() - distance];
  return true;
}

/// Decodes one literal run or copy at `at` and advances `at`.
bool decompress_run(std::string_view bytes, std::size_t& at, std::string& out) {
  const std::size_t code = lzf_byte(bytes, at++);
  if (code < kLiteralLimit) {
    if (bytes.size() - at < code + 1) return false;
    out.append(bytes.substr(at, code + 1));
    at += code + 1;
    return true;
  }
  std::size_t length = code >> 5U;
  if (bytes.size() - at < (length == kLongCopy ? 2U : 1U)) return false;
  if (length == kLongCopy) length += lzf_byte(bytes, at++);
  const std::size_t distance = ((code & 0x1fU) << 8U) + lzf_byte(bytes, at++) + 1;
  return copy_back(out, distance, length + kMinCopy);
}

// Parses the header of a PCD file (pcd.hpp): the fields, number and encoding of the points.

/// One field of a point.
struct PcdField {
  std::string name;
  NumberType type = NumberType::kFloat32;
  std::size_t count = 1;
};

struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t points = 0;
  std::string encoding;
  std::size_t data_begin = 0;  ///< byte offset in the file

  std::size_t record_bytes() const {
    std::size_t bytes = 0;
    for (const PcdField& field : fields) bytes += field.count * bytes_of(field.type);
    return bytes;
  }
};

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
    if (!is_new) lines.fail(keyword + " appears twice", InputError::Kind::kDuplicate);
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
  if (height > 0 && *width > kMaxPointCount / height)
    at.fail("WIDTH and HEIGHT are implausible", InputError::Kind::kUnit);
  if (points && *points != *width * height) at.fail("POINTS is not WIDTH times HEIGHT");
  return *width * height;
}

/// Reads up to the end of the line DATA. Refuses (InputError, with the line) an invalid or inconsistent
/// header. COUNT, VERSION, VIEWPOINT and one of POINTS and WIDTH may be missing.
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

/// Points stored as records.
PointTable table_of_records(const PcdHeader& header, std::string_view bytes) {
  PointTable table{bytes, ByteOrder::kLittle, header.points, {}};
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    if (field.count == 1) table.columns.push_back({field.name, field.type, offset, header.record_bytes()});
    offset += field.count * bytes_of(field.type);
  }
  return table;
}

/// Points stored as columns.
PointTable table_of_columns(const PcdHeader& header, std::string_view bytes) {
  PointTable table{bytes, ByteOrder::kLittle, header.points, {}};
  std::size_t offset = 0;
  for (const PcdField& field : header.fields) {
    const std::size_t field_bytes = field.count * bytes_of(field.type);
    if (field.count == 1) table.columns.push_back({field.name, field.type, offset, field_bytes});
    offset += field_bytes * header.points;
  }
  return table;
}

LidarScan checked_points_of(const TextLines& at, const PointTable& table, Stamp stamp) {
  if (const auto refusal = problem_with(table)) at.fail(*refusal);
  return {points_of(table), times_of(table, stamp).since_stamp_s, intensities_of(table)};
}

/// A number, NaN or infinity.
double floating_in(const TextLines& at, const PcdField& field, std::string_view word) {
  std::string name = lower_case(word);
  const bool is_negative = name.starts_with('-');
  if (is_negative || name.starts_with('+')) name.erase(0, 1);
  if (name == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (name != "inf") return number_in(at, word, field.name);
  return is_negative ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
}

/// Converts one number of a line to the bytes of a record; fields that are not read may have any content.
void append_ascii_number(const TextLines& at, std::string& out, const PcdField& field,
                         std::string_view word) {
  const bool is_read = is_time_name(field.name) || is_intensity_name(field.name);
  if (!is_read && field.name != "x" && field.name != "y" && field.name != "z") {
    out.append(bytes_of(field.type), '\0');
  } else if (field.type == NumberType::kFloat32 || field.type == NumberType::kFloat64) {
    const double value = floating_in(at, field, word);
    if (field.type == NumberType::kFloat32)
      append_f32(out, static_cast<float>(value));
    else
      append_f64(out, value);
  } else {
    const auto value = parse_integer(word);
    if (!value) at.fail(field.name + " '" + std::string(word) + "' is not a whole number");
    append_little_endian(out, static_cast<std::uint64_t>(*value), bytes_of(field.type));
  }
}

LidarScan read_ascii(TextLines& lines, const PcdHeader& header, Stamp stamp) {
  std::string records;
  for (std::size_t row = 0; row < header.points; ++row) {
    if (!lines.next_with_content())
      lines.fail("the points end after " + std::to_string(row) + " of " + std::to_string(header.points));
    LineFields fields(lines);
    for (const PcdField& field : header.fields)
      for (std::size_t k = 0; k < field.count; ++k)
        append_ascii_number(lines, records, field, fields.next(field.name));
    fields.end();
  }
  return checked_points_of(lines, table_of_records(header, records), stamp);
}

[[noreturn]] void fail_cut_off(const Text& file, std::size_t needed) {
  file.fail(0, "is truncated: it ends before the " + std::to_string(needed) +
                   " bytes of points that the header " + "announces");
}

LidarScan read_binary(const Text& file, const TextLines& lines, const PcdHeader& header, Stamp stamp) {
  const std::string_view data = std::string_view(file.content).substr(header.data_begin);
  const std::size_t record = header.record_bytes();
  if (record > 0 && header.points > data.size() / record) fail_cut_off(file, header.points * record);
  return checked_points_of(lines, table_of_records(header, data), stamp);
}

LidarScan read_compressed(const Text& file, const TextLines& lines, const PcdHeader& header, Stamp stamp) {
  constexpr std::size_t kSizesBytes = 8;
  const std::string_view data = std::string_view(file.content).substr(header.data_begin);
  if (data.size() < kSizesBytes) fail_cut_off(file, kSizesBytes);
  const ByteView sizes(data, ByteOrder::kLittle);
  const std::size_t compressed = sizes.u32(0);
  const std::size_t size = sizes.u32(4);
  if (data.size() - kSizesBytes < compressed) fail_cut_off(file, kSizesBytes + compressed);
  const std::size_t record = header.record_bytes();
  if (record == 0 || size % record != 0 || size / record != header.points)
    file.fail(0, "the size of the compressed points contradicts the header");
  const auto columns = decompress_lzf(data.substr(kSizesBytes, compressed), size);
  if (!columns) file.fail(0, "the points cannot be decompressed");
  return checked_points_of(lines, table_of_columns(header, *columns), stamp);
}

std::string pcd_header(const LidarScan& scan) {
  const std::string points = std::to_string(scan.points.size());
  const bool has_times = !scan.times_s.empty();
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z intensity" +
         std::string(has_times ? " t" : "") + "\nSIZE 4 4 4 4" + (has_times ? " 4" : "") + "\nTYPE F F F F" +
         (has_times ? " F" : "") + "\nCOUNT 1 1 1 1" + (has_times ? " 1" : "") + "\nWIDTH " + points +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n";
}

}  // namespace

std::optional<std::string> decompress_lzf(std::string_view bytes, std::size_t size) {
  if (size / kMaxExpansion > bytes.size()) return std::nullopt;
  std::string out;
  out.reserve(size);
  for (std::size_t at = 0; at < bytes.size();)
    if (!decompress_run(bytes, at, out) || out.size() > size) return std::nullopt;
  if (out.size() != size) return std::nullopt;
  return out;
}

LidarScan read_pcd(const Text& file, Stamp stamp) {
  TextLines lines(file);
  const PcdHeader header = read_pcd_header(file, lines);
  if (header.encoding == "ascii") return read_ascii(lines, header, stamp);
  if (header.encoding == "binary") return read_binary(file, lines, header, stamp);
  if (header.encoding == "binary_compressed") return read_compressed(file, lines, header, stamp);
  lines.fail("DATA '" + header.encoding + "' is neither ascii, binary nor binary_compressed");
}

std::string format_pcd(const LidarScan& scan) {
  RADIOSLAM_CHECK(scan.times_s.empty() || scan.times_s.size() == scan.points.size(), "each point has a time");
  std::string out = pcd_header(scan);
  for (std::size_t k = 0; k < scan.points.size(); ++k) {
    for (const float coordinate : scan.points[k]) append_f32(out, coordinate);
    append_f32(out, scan.intensities.empty() ? 0 : scan.intensities[k]);
    if (!scan.times_s.empty()) append_f32(out, scan.times_s[k]);
  }
  return out;
}

}  // namespace radioslam
