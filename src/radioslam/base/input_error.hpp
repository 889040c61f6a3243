// The one exception of the project: an input that cannot be used, with its place.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace radioslam {

/// Thrown where files and calls are read (io/, cli/); caught in cli/, which exits with status 2.
class InputError : public std::runtime_error {
 public:
  /// `line` counts from 1; 0 when the whole file is meant.
  InputError(std::string file, std::size_t line, std::string reason)
      : std::runtime_error(file + (line > 0 ? ":" + std::to_string(line) : std::string{}) + ": " + reason),
        file_(std::move(file)),
        line_(line),
        reason_(std::move(reason)) {}

  const std::string& file() const { return file_; }
  std::size_t line() const { return line_; }
  const std::string& reason() const { return reason_; }

 private:
  std::string file_;
  std::size_t line_;
  std::string reason_;
};

}  // namespace radioslam
