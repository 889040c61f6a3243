#include "radioslam/io/datasets/wsr_trial.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "radioslam/base/units.hpp"
#include "radioslam/io/csi/intel5300.hpp"
#include "radioslam/io/mission/tum.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"
#include "radioslam/mission/wifi_channel.hpp"

namespace radioslam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kPositions = "groundtruth_positions.json";
constexpr std::string_view kReceiver = "csi_rx";

struct KnownCard {
  std::string_view name;
  MacAddress address;
};
/// The cards of the data set's robots.
constexpr std::array<KnownCard, 3> kCards{{{"tx2", MacAddress{0x00216A3F175A}},
                                           {"tx3", MacAddress{0x00216A30D23C}},
                                           {"tx4", MacAddress{0x00216AB26EFA}}}};

/// The part of a name between the given beginning and end, without trailing underscores; nothing for other
/// names.
std::optional<std::string> time_in(const fs::path& file, std::string_view begin, std::string_view end) {
  std::string name = file.filename().string();
  if (!name.starts_with(begin) || !name.ends_with(end) || name.size() < begin.size() + end.size())
    return std::nullopt;
  name = name.substr(begin.size(), name.size() - begin.size() - end.size());
  return name.substr(0, name.find_last_not_of('_') + 1);
}

/// The file of one kind and time; of any time if the folder has a single trial.
std::optional<fs::path> file_of(const std::vector<fs::path>& files, std::string_view begin,
                                std::string_view end, const std::optional<std::string>& time) {
  std::optional<fs::path> found;
  for (const fs::path& file : files) {
    const auto own = time_in(file, begin, end);
    if (!own || (time && *own != *time)) continue;
    if (found)
      throw InputError(file.string(), 0,
                       "a second file of the same kind as '" + found->filename().string() + "'");
    found = file;
  }
  return found;
}

WsrSight sight_of(const fs::path& folder) {
  for (fs::path at = fs::weakly_canonical(fs::absolute(folder)); at.has_relative_path();
       at = at.parent_path()) {
    const std::string name = at.filename().string();
    if (name.starts_with("NLOS")) return WsrSight::kNoLineOfSight;
    if (name.starts_with("LOS")) return WsrSight::kLineOfSight;
  }
  throw InputError(folder.string(), 0, "no parent folder of this trial starts with LOS or NLOS");
}

WsrTrialFiles trial_at(const fs::path& folder, const std::vector<fs::path>& files, const fs::path& receiver,
                       bool is_alone) {
  WsrTrialFiles trial;
  const std::string own_time = *time_in(receiver, kReceiver, ".dat");
  const auto time = is_alone ? std::nullopt : std::optional(own_time);
  trial.name = folder.filename().string() + own_time;
  trial.sight = sight_of(folder);
  trial.positions = folder / kPositions;
  trial.receiver = receiver;
  const auto motion_capture = file_of(files, "rx_trajectory", ".csv", time);
  if (!motion_capture) throw InputError(receiver.string(), 0, "has no matching rx_trajectory*.csv");
  trial.motion_capture = *motion_capture;
  trial.tracking_camera = file_of(files, "t265_rx_trajectory", ".csv", time);
  trial.wheel_odometry = file_of(files, "odom_rx_trajectory", ".csv", time);
  for (const KnownCard& card : kCards)
    if (auto file = file_of(files, "csi_" + std::string(card.name), ".dat", time))
      trial.transmitters.emplace_back(card.name, std::move(*file));
  if (trial.transmitters.empty())
    throw InputError(receiver.string(), 0, "has no matching csi_tx2, csi_tx3 or csi_tx4");
  return trial;
}

void add_trials(const fs::path& folder, std::vector<WsrTrialFiles>& trials) {
  if (!fs::exists(folder / kPositions)) return;
  const std::vector<fs::path> files = files_in(folder, Depth::kFolder, [](const fs::path&) { return true; });
  std::vector<fs::path> receivers;
  for (const fs::path& file : files)
    if (time_in(file, kReceiver, ".dat")) receivers.push_back(file);
  for (const fs::path& receiver : receivers)
    trials.push_back(trial_at(folder, files, receiver, receivers.size() == 1));
}

std::vector<std::string_view> comma_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  line = trim(line);
  if (line.ends_with(',')) line.remove_suffix(1);
  for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
    fields.push_back(trim(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(trim(line));
  return fields;
}

StampedPose<SE3> pose_in(const TextLines& lines) {
  enum : std::size_t { kSeconds, kNanoseconds, kX, kY, kZ, kQx, kQy, kQz, kQw, kWidth };
  const auto fields = comma_fields(lines.line());
  if (fields.size() != kQx && fields.size() < kWidth)
    lines.fail("the row has " + std::to_string(fields.size()) +
               " fields; expected 'sec, nsec, x, y, z' and optionally 'qx, qy, qz, qw'");
  Stamp stamp = stamp_in(lines, fields[kSeconds], "sec");
  const double more_ns = number_in(lines, fields[kNanoseconds], "nsec");
  if (!(more_ns >= 0 && more_ns < kNanosecondsPerSecond)) lines.fail("nsec is not within a second");
  stamp.ns += std::llround(more_ns);
  const Eigen::Vector3d position(coordinate_in(lines, fields[kX], "x"), coordinate_in(lines, fields[kY], "y"),
                                 coordinate_in(lines, fields[kZ], "z"));
  if (fields.size() < kWidth) return {stamp, SE3(position, Eigen::Quaterniond::Identity())};
  const Eigen::Vector4d xyzw(number_in(lines, fields[kQx], "qx"), number_in(lines, fields[kQy], "qy"),
                             number_in(lines, fields[kQz], "qz"), number_in(lines, fields[kQw], "qw"));
  return {stamp, SE3(position, quaternion_in(lines, xyzw, kUnitQuaternionTolerance))};
}

Trajectory<SE3> read_pose_table(const fs::path& file, std::vector<std::string>& warnings) {
  const Text text = read_tool_output(file);
  std::vector<TrajectoryRow> rows;
  SkippedRecords skipped;
  TextLines lines(text);
  while (lines.next_with_content())
    skipped.attempt([&] { rows.push_back({pose_in(lines), lines.number()}); });
  skipped.conclude(text.name, "row", rows.size(), warnings);
  return trajectory_of_rows(text, rows, warnings);
}

std::optional<Trajectory<SE3>> poses_if_any(const std::optional<fs::path>& file,
                                            std::vector<std::string>& warnings) {
  return file ? std::optional(read_pose_table(*file, warnings)) : std::nullopt;
}

/// Accessor of groundtruth_positions.json; only the requested entries are checked.
class Positions {
 public:
  explicit Positions(const fs::path& file) : text_(read_text(file)), json_(read_json(text_)) {}

  double carrier_hz() const {
    const Json* channel = at("/channel/value");
    const auto carrier_hz = channel != nullptr && channel->is_number_integer()
                                ? carrier_of_channel_hz(channel->get<std::int64_t>())
                                : std::nullopt;
    if (!carrier_hz) text_.fail(1, "channel.value is not a valid WiFi channel");
    return *carrier_hz;
  }

  Eigen::Vector3d of(const std::string& transmitter) const {
    Eigen::Vector3d position_m;
    const std::string place = "/true_tx_positions/value/" + transmitter + "/position/";
    for (int axis = 0; axis < 3; ++axis) {
      const Json* value = at(place + "xyz"[axis]);
      if (value == nullptr || !value->is_number() || !(std::abs(value->get<double>()) <= kMaxCoordinate_m))
        text_.fail(1, "true_tx_positions has no valid position of '" + transmitter + "'");
      position_m[axis] = value->get<double>();
    }
    return position_m;
  }

 private:
  const Json* at(const std::string& pointer) const {
    const Json::json_pointer place(pointer);
    return json_.contains(place) ? &json_.at(place) : nullptr;
  }

  Text text_;
  Json json_;
};

CsiCapture read_card(const fs::path& file) { return read_intel5300(file.string(), read_bytes(file)); }

MacAddress address_of(std::string_view name) {
  return std::find_if(kCards.begin(), kCards.end(), [&](const KnownCard& card) { return card.name == name; })
      ->address;
}

}  // namespace

std::vector<WsrTrialFiles> find_wsr_trials(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string(), 0, "no such folder with trials");
  std::vector<WsrTrialFiles> trials;
  add_trials(folder, trials);
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_directory()) add_trials(entry.path(), trials);
  if (trials.empty())
    throw InputError(folder.string(), 0,
                     "contains no folder with both " + std::string(kPositions) + " and a csi_rx*.dat");
  std::sort(trials.begin(), trials.end(), [](const WsrTrialFiles& a, const WsrTrialFiles& b) {
    return std::tie(a.name, a.receiver) < std::tie(b.name, b.receiver);
  });
  return trials;
}

WsrTrial read_wsr_trial(const WsrTrialFiles& files) {
  const Positions positions(files.positions);
  WsrTrial trial;
  trial.name = files.name;
  trial.sight = files.sight;
  trial.carrier_hz = positions.carrier_hz();
  trial.receiver = read_card(files.receiver);
  for (const auto& [name, capture] : files.transmitters)
    trial.transmitters.push_back({name, address_of(name), positions.of(name), read_card(capture)});
  trial.motion_capture = read_pose_table(files.motion_capture, trial.warnings);
  trial.tracking_camera = poses_if_any(files.tracking_camera, trial.warnings);
  trial.wheel_odometry = poses_if_any(files.wheel_odometry, trial.warnings);
  return trial;
}

}  // namespace radioslam
