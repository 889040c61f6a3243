// Options of the page of an agent while it runs, which `agent` and `team` share.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace radioslam::cli {

/// Where a token is taken from that is not to be read in the list of processes.
inline constexpr const char* kLiveTokenVariable = "RADIOSLAM_LIVE_TOKEN";

inline void add_live_options(CLI::App& command, std::string& live, std::string& token) {
  command
      .add_option("--live", live,
                  "Show what the robot knows on a page while it runs, at this port of this machine or, with "
                  "an address, of the network; 0: any port")
      ->type_name("[ADDRESS:]PORT");
  command
      .add_option("--live-token", token,
                  "Token that the page asks for (default: none on this machine alone, else one is drawn); "
                  "better by the environment")
      ->envname(kLiveTokenVariable)
      ->type_name("TOKEN");
}

}  // namespace radioslam::cli
