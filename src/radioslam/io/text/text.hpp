// A text file in memory and its lines, numbered from 1. The encoding is UTF-8; a byte order mark and CRLF
// line ends are accepted, invalid bytes are refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/input_error.hpp"

namespace radioslam {

/// A file's name (for error messages) and its content without a byte order mark.
struct Text {
  std::string name;
  std::string content;

  [[noreturn]] void fail(std::size_t line, const std::string& reason,
                         InputError::Kind kind = InputError::Kind::kUnreadable) const {
    throw InputError(name, line, reason, kind);
  }
};

/// Checks that `content` is UTF-8 text. Refuses (InputError) empty content and invalid bytes.
Text make_text(std::string name, std::string content);

/// Reads a whole file unchanged. Refuses (InputError) a missing file, a folder, and a file that cannot be
/// read.
std::string read_bytes(const std::filesystem::path& path);

/// Reads a whole file as text. Refuses whatever read_bytes and make_text refuse.
Text read_text(const std::filesystem::path& path);

/// Text written by another program, which may contain names as raw bytes: the encoding is not checked, and
/// UTF-16 with a byte order mark becomes UTF-8. Refuses empty content.
Text make_tool_output(std::string name, std::string content);
Text read_tool_output(const std::filesystem::path& path);

/// Whether bytes are UTF-8 text without control characters other than tabs and line ends.
bool is_plain_text(std::string_view bytes);

/// A note on the lines that have control characters, as names of networks may: "log.txt:7: ..."; nothing if
/// there are none. Importers read such lines like others, because they do not import names.
std::optional<std::string> control_character_note(const Text& text);

enum class Depth { kFolder, kBelow };

/// The files in a folder, or also in those below it, that are wanted; sorted by path.
std::vector<std::filesystem::path> files_in(
    const std::filesystem::path& folder, Depth depth,
    const std::function<bool(const std::filesystem::path&)>& is_wanted);

/// Whether the file's name begins with a point.
bool is_hidden(const std::filesystem::path& file);

/// Iterates over the lines of a text: `while (lines.next()) use(lines.line())`.
class TextLines {
 public:
  explicit TextLines(const Text& text) : text_(&text), rest_(text.content) {}

  /// Advances to the next line; false after the last one.
  bool next();
  /// Like next(), but skips blank lines and lines that start with '#'.
  bool next_with_content();

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }
  /// False for a last line without line end, which may be truncated.
  bool terminated() const { return terminated_; }
  [[noreturn]] void fail(const std::string& reason,
                         InputError::Kind kind = InputError::Kind::kUnreadable) const {
    text_->fail(number_, reason, kind);
  }

 private:
  const Text* text_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  bool terminated_ = true;
};

/// The text without blanks and tabs at both ends.
std::string_view trim(std::string_view s);

/// The text with A to Z converted to lower case.
std::string lower_case(std::string_view s);

// Validity of names of robots and anchors, which are used as file names and in tables.

/// Whether the name is not empty, short enough for a file name, without path separators, commas, quotes or
/// control characters, without a leading '.' or '#', and without leading or trailing blanks.
bool is_valid_id(const std::string& id);

}  // namespace radioslam
