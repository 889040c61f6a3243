#include "radioslam/io/csi/csi_folder.hpp"

#include <algorithm>
#include <string>

#include "radioslam/io/csi/csi_capture.hpp"
#include "radioslam/io/csi/intel5300_write.hpp"
#include "radioslam/io/text/atomic_output.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;

/// "01" of 12: padded with zeros so that names sort as numbers.
std::string numbered(std::size_t number, std::size_t last) {
  const std::string digits = std::to_string(number);
  return std::string(std::to_string(last).size() - digits.size(), '0') + digits;
}

}  // namespace

std::vector<CsiCapture> read_csi_folder(const fs::path& folder) {
  std::vector<fs::path> files;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (entry.is_regular_file() && !entry.path().filename().string().starts_with('.'))
        files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<CsiCapture> captures;
  for (const fs::path& file : files) captures.push_back(read_csi_capture(file.string()));
  return captures;
}

void write_csi_folder(const fs::path& folder, const std::vector<CsiCapture>& captures) {
  std::vector<const CsiCapture*> written;
  for (const CsiCapture& capture : captures)
    if (!capture.packets.empty()) written.push_back(&capture);
  for (std::size_t k = 0; k < written.size(); ++k) {
    const std::string number = written.size() > 1 ? "-" + numbered(k + 1, written.size()) : "";
    write_file(folder / ("capture" + number + ".dat"), write_intel5300(*written[k]));
  }
}

}  // namespace radioslam
