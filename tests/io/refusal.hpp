// Runs something that must refuse its input and says where it did.
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

/// The same; the test fails unless the refusal names `line`, and its text holds `words`.
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
