// Files with the logs of robots (records/team_log.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "radioslam/records/team_log.hpp"

namespace radioslam {

inline constexpr const char* kLogExtension = ".rslog";

bool is_log_file(const std::filesystem::path& path);

struct LogFiles {
  TeamLog team;
  std::vector<std::string> notes;  ///< what of the files was left out
};

/// Reads files of any robots, in any order. Throws InputError if a file cannot be read or contains nothing of
/// a log.
LogFiles read_logs(const std::vector<std::filesystem::path>& paths);

/// Writes `<robot>.rslog` for each robot, into an existing folder or a new one.
void write_logs(const std::filesystem::path& folder, const std::vector<RobotLog>& logs);

}  // namespace radioslam
