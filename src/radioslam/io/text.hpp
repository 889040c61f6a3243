// A text file in memory and its lines, numbered from 1.
// UTF-8; a byte order mark and CRLF line ends are accepted; other bytes are not text and are refused.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "radioslam/base/input_error.hpp"

namespace radioslam {

/// A file's name, for messages, and its characters without a byte order mark.
struct Text {
  std::string name;
  std::string content;

  [[noreturn]] void fail(std::size_t line, const std::string& reason) const {
    throw InputError(name, line, reason);
  }
};

/// Checks that `content` is UTF-8 text. Refuses (InputError) an empty one and one with bytes that are no
/// text.
Text make_text(std::string name, std::string content);

/// A whole file as it is. Refuses a missing file, a folder, and what cannot be read.
std::string read_bytes(const std::filesystem::path& path);

/// Reads a whole file as text. Refuses also a missing file, a folder, and what cannot be read.
Text read_text(const std::filesystem::path& path);

/// Lines that a tool printed, in which names may stand as raw bytes: these are not checked. Refuses what is
/// empty.
Text make_printed_text(std::string name, std::string content);
Text read_printed_text(const std::filesystem::path& path);

/// Walks through the lines of a text: `while (lines.next()) use(lines.line())`.
class TextLines {
 public:
  explicit TextLines(const Text& text) : text_(&text), rest_(text.content) {}

  /// Moves to the next line; false behind the last one.
  bool next();
  /// The same, over blank lines and lines that start with '#'.
  bool next_with_content();

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }
  /// False for a last line that the file's end cut off or that just has no line end.
  bool terminated() const { return terminated_; }
  [[noreturn]] void fail(const std::string& reason) const { text_->fail(number_, reason); }

 private:
  const Text* text_;
  std::string_view rest_;
  std::string_view line_;
  std::size_t number_ = 0;
  bool terminated_ = true;
};

/// Without blanks and tabs at both ends.
std::string_view trim(std::string_view s);

/// With the letters A to Z as a to z.
std::string lower_case(std::string_view s);

}  // namespace radioslam
