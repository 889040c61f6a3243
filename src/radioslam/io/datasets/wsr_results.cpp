#include "radioslam/io/datasets/wsr_results.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/run/run_folder.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ResultFile {
  WsrSight sight;
  WsrMotion motion;
};

std::optional<ResultFile> told_by_name(const std::string& name) {
  const bool blocked = name.starts_with("NLOS"), seen = name.starts_with("LOS");
  const bool captured = name.ends_with("_using_groundtruth_displacement.json"),
             tracked = name.ends_with("_using_t265_displacement.json");
  if ((!blocked && !seen) || (!captured && !tracked)) return std::nullopt;
  return ResultFile{blocked ? WsrSight::kNoLineOfSight : WsrSight::kLineOfSight,
                    captured ? WsrMotion::kMotionCapture : WsrMotion::kTrackingCamera};
}

/// The JSON object of a link; errors name the trial.
class Link {
 public:
  Link(const Text& text, const std::string& trial, const Json& json)
      : text_(text), trial_(trial), json_(json) {}

  double number(const std::string& pointer) const {
    const Json::json_pointer place(pointer);
    if (!json_.contains(place) || !json_.at(place).is_number()) refuse(pointer);
    return json_.at(place).get<double>();
  }
  std::string word(const std::string& pointer) const {
    const Json::json_pointer place(pointer);
    if (!json_.contains(place) || !json_.at(place).is_string()) refuse(pointer);
    return json_.at(place).get<std::string>();
  }
  bool has(const std::string& pointer) const { return json_.contains(Json::json_pointer(pointer)); }

 private:
  [[noreturn]] void refuse(const std::string& pointer) const {
    text_.fail(1, "a link of trial '" + trial_ + "' has no valid " + pointer);
  }

  const Text& text_;
  const std::string& trial_;
  const Json& json_;
};

WsrResult result_of(const Link& link, const ResultFile& file) {
  const std::string start = "/b_INFO_Receiving_robot/groundtruth_start_position/";
  const std::string peaks = "/d_INFO_AOA_profile/Top_N_peaks/";
  WsrResult result{file.sight, file.motion, link.word("/a_INFO_Transmitting_robot/Name"), {}, {}};
  result.start_m = {link.number(start + "x"), link.number(start + "y"), link.number(start + "z")};
  int peak = 1;
  do {
    const double degrees = link.number(peaks + std::to_string(peak) + "/azimuth_error");
    result.errors_rad.push_back(radians(degrees));
  } while (link.has(peaks + std::to_string(++peak)));
  return result;
}

void read_file(const fs::path& path, const ResultFile& file, std::vector<WsrResult>& results) {
  const Text text = read_text(path);
  const Json json = read_json(text);
  if (!json.is_object()) text.fail(1, "expected an object with trials by number");
  for (const auto& [trial, links] : json.items()) {
    if (!links.is_array()) text.fail(1, "trial '" + trial + "' is not a list of links");
    for (const Json& link : links) results.push_back(result_of(Link(text, trial, link), file));
  }
}

}  // namespace

std::vector<WsrResult> read_wsr_results(const fs::path& folder) {
  const fs::path default_folder = folder / "default_configuration";
  const fs::path place = fs::is_directory(default_folder) ? default_folder : folder;
  if (!fs::is_directory(place)) throw InputError(folder.string(), 0, "no such results folder");
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(place))
    if (told_by_name(entry.path().filename().string())) files.push_back(entry.path());
  if (files.empty())
    throw InputError(place.string(), 0,
                     "contains no file <LOS|NLOS>*_using_<groundtruth|t265>_displacement.json");
  std::sort(files.begin(), files.end());
  std::vector<WsrResult> results;
  for (const fs::path& file : files) read_file(file, *told_by_name(file.filename().string()), results);
  return results;
}

}  // namespace radioslam
