// Location of recorded test data: $RADIOSLAM_TEST_DATA, or the folder `shared/data` next to the source.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

namespace radioslam {

inline std::filesystem::path recorded_data(const std::filesystem::path& name) {
  const char* given = std::getenv("RADIOSLAM_TEST_DATA");
  const std::filesystem::path root =
      given != nullptr ? std::filesystem::path(given) : std::filesystem::path(RADIOSLAM_DEFAULT_TEST_DATA);
  return root / name;
}

}  // namespace radioslam

/// Defines `variable` as the path of recorded data, or skips the test.
#define RADIOSLAM_RECORDED(variable, name)                         \
  const std::filesystem::path variable = recorded_data(name);      \
  if (!std::filesystem::exists(variable))                          \
  GTEST_SKIP() << "recorded data " << variable << " is not here; " \
               << "set RADIOSLAM_TEST_DATA to the folder that has it"
