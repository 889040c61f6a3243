// The one exception of the project: an input that cannot be used, with its place.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace radioslam {

/// Thrown where files and calls are read (io/, cli/); caught in cli/, which exits with status 2.
class InputError : public std::runtime_error {
 public:
  /// What is wrong, for callers that advise.
  enum class Kind {
    kUnreadable,
    kSpelling,     ///< a name that does not exist
    kClock,        ///< times that do not increase
    kTooLittle,    ///< no data where some are needed
    kColumnOrder,  ///< columns are missing, or hold what another one should
    kUnit,         ///< a number that is out of range, as in another unit
    kDuplicate,    ///< the same twice where it can be there once
  };

  /// `line` counts from 1; 0 when the whole file is meant.
  InputError(std::string file, std::size_t line, std::string reason, Kind kind = Kind::kUnreadable)
      : std::runtime_error(file + (line > 0 ? ":" + std::to_string(line) : std::string{}) + ": " + reason),
        file_(std::move(file)),
        line_(line),
        reason_(std::move(reason)),
        kind_(kind) {}

  const std::string& file() const { return file_; }
  std::size_t line() const { return line_; }
  const std::string& reason() const { return reason_; }
  Kind kind() const { return kind_; }

 private:
  std::string file_;
  std::size_t line_;
  std::string reason_;
  Kind kind_;
};

}  // namespace radioslam
