// A short drive of two robots, simulated and estimated once a program.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/process.hpp"

namespace radioslam::cli {

/// Has the mission `town`, and `whole`, the run of it.
inline const TemporaryFolder& short_drive() {
  static const TemporaryFolder folder;
  static const bool is_made = [] {
    return run({"simulate", "city", "-o", "town", "--seed", "3", "--set", "path_length_m=200",
                "min_contact_s=4", "links=30"},
               folder.path())
                   .status == 0 &&
           run({"run", "town", "-o", "whole"}, folder.path()).status == 0;
  }();
  EXPECT_TRUE(is_made);
  return folder;
}

/// In metres, RMSE, of a run with the truth.
inline double error_of(const std::filesystem::path& summary) {
  return nlohmann::json::parse(read_file(summary)).at("metrics").at("ate_rmse_m").get<double>();
}

}  // namespace radioslam::cli
