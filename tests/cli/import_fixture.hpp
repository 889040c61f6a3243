// Fixture that runs `radioslam import` in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/process.hpp"

namespace radioslam::cli {

struct ImportFixture : testing::Test {
  Outcome import(const std::vector<std::string>& arguments) const {
    std::vector<std::string> call{"import"};
    call.insert(call.end(), arguments.begin(), arguments.end());
    return run(call, folder.path());
  }
  void expect_refused(const std::vector<std::string>& arguments, const std::string& reason) const {
    const auto before = files_in(folder.path());
    const Outcome outcome = import(arguments);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(reason), std::string::npos) << outcome.err;
    EXPECT_EQ(files_in(folder.path()), before) << "nothing half-written";
  }

  TemporaryFolder folder;
};

}  // namespace radioslam::cli
