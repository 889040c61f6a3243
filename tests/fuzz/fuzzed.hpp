// What every harness does: hand the bytes to a reader, and let it refuse them in its own way only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text.hpp"

namespace radioslam {

/// Calls read(text) with the bytes as a file; an InputError is a right answer, anything else is not.
template <class Reader>
int fuzz_reader(const std::uint8_t* data, std::size_t size, Reader&& read) {
  try {
    read(make_text("input", std::string(data, data + size)));
  } catch (const InputError&) {
  }
  return 0;
}

}  // namespace radioslam
