#include "radioslam/io/text/text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <optional>

namespace radioslam {
namespace {

constexpr std::size_t kReadBytes = 1 << 20;

bool is_control(unsigned char c) { return (c < 0x20 && c != '\t' && c != '\n' && c != '\r') || c == 0x7f; }

unsigned char byte_at(std::string_view s, std::size_t i) { return static_cast<unsigned char>(s[i]); }

/// Number of bytes of the UTF-8 character at `i`, 0 if it is invalid (RFC 3629, table 3-7 of the Unicode
/// standard).
std::size_t utf8_length(std::string_view s, std::size_t i) {
  const unsigned char lead = byte_at(s, i);
  if (lead < 0x80) return is_control(lead) ? 0 : 1;
  const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : 2;
  if (lead < 0xc2 || lead > 0xf4 || i + length > s.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((byte_at(s, i + k) & 0xc0) != 0x80) return 0;
  const unsigned char second = byte_at(s, i + 1);
  const bool overlong = (lead == 0xe0 && second < 0xa0) || (lead == 0xf0 && second < 0x90);
  const bool surrogate_or_beyond = (lead == 0xed && second > 0x9f) || (lead == 0xf4 && second > 0x8f);
  return overlong || surrogate_or_beyond ? 0 : length;
}

/// Offset of the first invalid byte.
std::optional<std::size_t> first_foreign_byte(std::string_view s) {
  for (std::size_t i = 0; i < s.size();) {
    const unsigned char c = byte_at(s, i);
    const std::size_t length = c >= 0x20 && c < 0x7f ? 1 : utf8_length(s, i);
    if (length == 0) return i;
    i += length;
  }
  return std::nullopt;
}

void append_utf8(std::string& out, std::uint32_t code) {
  const auto continuation = [&](unsigned shift) {
    out += static_cast<char>(0x80U | (code >> shift & 0x3fU));
  };
  if (code < 0x80) {
    out += static_cast<char>(code);
  } else if (code < 0x800) {
    out += static_cast<char>(0xc0U | code >> 6U);
    continuation(0);
  } else if (code < 0x10000) {
    out += static_cast<char>(0xe0U | code >> 12U);
    continuation(6), continuation(0);
  } else {
    out += static_cast<char>(0xf0U | code >> 18U);
    continuation(12), continuation(6), continuation(0);
  }
}

/// UTF-16 with its byte order mark, as programs of Windows write it; an unpaired surrogate becomes U+FFFD.
std::string utf8_of_utf16(std::string_view bytes) {
  constexpr std::uint32_t kReplacement = 0xfffd, kHigh = 0xd800, kLow = 0xdc00, kBehind = 0xe000;
  const std::size_t high = bytes[0] == '\xfe' ? 0 : 1;  // place of the high byte in a unit
  const auto unit = [&](std::size_t at) -> std::uint32_t {
    return static_cast<std::uint32_t>(byte_at(bytes, at + high)) << 8U | byte_at(bytes, at + 1 - high);
  };
  std::string out;
  for (std::size_t at = 2; at + 1 < bytes.size(); at += 2) {
    std::uint32_t code = unit(at);
    const bool is_pair = code >= kHigh && code < kLow && at + 3 < bytes.size() && unit(at + 2) >= kLow &&
                         unit(at + 2) < kBehind;
    if (is_pair) {
      code = 0x10000U + ((code - kHigh) << 10U) + (unit(at + 2) - kLow);
      at += 2;
    }
    append_utf8(out, code >= kHigh && code < kBehind ? kReplacement : code);
  }
  return out;
}

Text without_byte_order_mark(std::string name, std::string content) {
  if (content.starts_with("\xef\xbb\xbf")) content.erase(0, 3);
  Text text{std::move(name), std::move(content)};
  if (text.content.empty()) text.fail(1, "the file is empty");
  return text;
}

constexpr std::size_t kMaxId = 200;  // file names have at most 255 bytes

bool is_control_character(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

Text make_tool_output(std::string name, std::string content) {
  if (content.starts_with("\xff\xfe") || content.starts_with("\xfe\xff")) content = utf8_of_utf16(content);
  return without_byte_order_mark(std::move(name), std::move(content));
}

Text make_text(std::string name, std::string content) {
  Text text = without_byte_order_mark(std::move(name), std::move(content));
  if (const auto place = first_foreign_byte(text.content)) {
    const auto end = text.content.begin() + static_cast<std::ptrdiff_t>(*place);
    const auto byte = static_cast<unsigned char>(*end);
    text.fail(
        1 + static_cast<std::size_t>(std::count(text.content.begin(), end, '\n')),
        (byte < 0x80 ? "a control character, code " + std::to_string(byte) : std::string("not UTF-8 text")) +
            " (byte " + std::to_string(*place + 1) + " of the file)");
  }
  return text;
}

bool is_plain_text(std::string_view bytes) { return !first_foreign_byte(bytes); }

std::optional<std::string> control_character_note(const Text& text) {
  std::size_t lines = 0, first = 0;
  TextLines at(text);
  while (at.next()) {
    const std::string_view line = at.line();
    const bool has_one = std::any_of(line.begin(), line.end(),
                                     [](char c) { return is_control(static_cast<unsigned char>(c)); });
    if (has_one && ++lines == 1) first = at.number();
  }
  if (lines == 0) return std::nullopt;
  return text.name + ":" + std::to_string(first) + ": " +
         (lines == 1 ? "has control characters"
                     : "the first of " + std::to_string(lines) + " lines with control characters") +
         ", as names of networks may have; names are not imported";
}

std::string read_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw InputError(path.string(), 0, "no such file");
  if (std::filesystem::is_directory(status)) throw InputError(path.string(), 0, "is a folder, not a file");
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw InputError(path.string(), 0, std::string("cannot be opened: ") + std::strerror(errno));
  std::string content;
  std::size_t got = kReadBytes;
  while (got == kReadBytes) {
    const std::size_t size = content.size();
    content.resize(size + kReadBytes);
    got = std::fread(content.data() + size, 1, kReadBytes, file.get());
    content.resize(size + got);
  }
  if (std::ferror(file.get()) != 0)
    throw InputError(path.string(), 0, std::string("cannot be read: ") + std::strerror(errno));
  return content;
}

Text read_text(const std::filesystem::path& path) { return make_text(path.string(), read_bytes(path)); }

Text read_tool_output(const std::filesystem::path& path) {
  return make_tool_output(path.string(), read_bytes(path));
}

std::vector<std::filesystem::path> files_in(
    const std::filesystem::path& folder, Depth depth,
    const std::function<bool(const std::filesystem::path&)>& is_wanted) {
  std::vector<std::filesystem::path> files;
  for (auto entry = std::filesystem::recursive_directory_iterator(folder);
       entry != std::filesystem::recursive_directory_iterator(); ++entry) {
    if (depth == Depth::kFolder) entry.disable_recursion_pending();
    if (entry->is_regular_file() && is_wanted(entry->path())) files.push_back(entry->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

bool is_hidden(const std::filesystem::path& file) { return file.filename().string().starts_with('.'); }

bool TextLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  terminated_ = end != std::string_view::npos;
  line_ = rest_.substr(0, end);
  rest_.remove_prefix(terminated_ ? end + 1 : rest_.size());
  if (line_.ends_with('\r')) line_.remove_suffix(1);
  ++number_;
  return true;
}

bool TextLines::next_with_content() {
  while (next()) {
    const std::size_t first = line_.find_first_not_of(" \t");
    if (first != std::string_view::npos && line_[first] != '#') return true;
  }
  return false;
}

std::string lower_case(std::string_view s) {
  std::string result(s);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string_view trim(std::string_view s) {
  const std::size_t first = s.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t") - first + 1);
}

bool is_valid_id(const std::string& id) {
  if (id.empty() || id.size() > kMaxId || id.front() == '.' || id.front() == '#') return false;
  if (id.find("..") != std::string::npos || trim(id) != id) return false;
  return id.find_first_of("/\\,\"") == std::string::npos &&
         std::none_of(id.begin(), id.end(), is_control_character);
}

}  // namespace radioslam
