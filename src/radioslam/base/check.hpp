// Checks of internal invariants: always enabled, never caught. Bad input is an InputError instead.
#pragma once

#include <string_view>

namespace radioslam {

/// Writes the failed condition with its place to standard error and aborts.
[[noreturn]] void check_failed(std::string_view condition, std::string_view message, const char* file,
                               int line);

}  // namespace radioslam

#define RADIOSLAM_CHECK(condition, message)                                               \
  do {                                                                                    \
    if (!(condition)) ::radioslam::check_failed(#condition, message, __FILE__, __LINE__); \
  } while (false)
