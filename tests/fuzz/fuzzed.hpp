// Common part of all harnesses: passes the bytes to a reader, which may refuse them only with an InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

/// Calls read(text) with the bytes as a file. An InputError is accepted, any other exception is not.
template <class Reader>
int fuzz_reader(const std::uint8_t* data, std::size_t size, Reader&& read) {
  try {
    read(make_text("input", std::string(data, data + size)));
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace radioslam
