#include "radioslam/io/run/robot_logs.hpp"

#include "radioslam/base/input_error.hpp"
#include "radioslam/io/text/atomic_output.hpp"
#include "radioslam/io/text/text.hpp"

namespace radioslam {

bool is_log_file(const std::filesystem::path& path) { return path.extension() == kLogExtension; }

LogFiles read_logs(const std::vector<std::filesystem::path>& paths) {
  LogFiles logs;
  for (const std::filesystem::path& path : paths) {
    const Acceptance accepted = logs.team.accept(read_bytes(path));
    if (accepted.records + accepted.repeated == 0)
      throw InputError(path, 0,
                       accepted.refusals.empty() ? "is empty" : "is no log: " + accepted.refusals.front());
    for (const std::string& refusal : accepted.refusals)
      logs.notes.push_back(path.filename().string() + ": " + refusal);
    if (accepted.refused > accepted.refusals.size())
      logs.notes.push_back(path.filename().string() + ": " + std::to_string(accepted.refused) +
                           " pieces are left out in all");
  }
  return logs;
}

void write_logs(const std::filesystem::path& folder, const std::vector<RobotLog>& logs) {
  std::filesystem::create_directories(folder);
  for (const RobotLog& log : logs) {
    OutputFile file(folder / (log.robot + kLogExtension));
    file.commit(log.bytes());
  }
}

}  // namespace radioslam
