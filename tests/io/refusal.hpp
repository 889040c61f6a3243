// Helpers for tests of input that must be refused.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "radioslam/base/input_error.hpp"

namespace radioslam {

/// "file:line: reason" of the InputError that `read` throws; a test failure and "" if it throws none.
template <class Function>
std::string refusal(Function&& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "the input was accepted";
  return {};
}

/// Expects an InputError that names `line` and contains `words`.
template <class Function>
void expect_refusal(Function&& read, std::size_t line, const std::string& words) {
  try {
    read();
    ADD_FAILURE() << "the input was accepted; expected: " << words;
  } catch (const InputError& error) {
    EXPECT_EQ(error.line(), line) << error.what();
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    EXPECT_FALSE(error.file().empty());
  }
}

}  // namespace radioslam
