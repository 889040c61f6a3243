#include "radioslam/io/graph/jrl.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "radioslam/geometry/se3.hpp"
#include "radioslam/io/graph/information.hpp"
#include "radioslam/io/graph/keyed_poses.hpp"
#include "radioslam/io/graph/team_ids.hpp"
#include "radioslam/io/run/run_folder.hpp"
#include "radioslam/io/text/compressed_text.hpp"
#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

std::string quoted(const char* member) { return "'" + std::string(member) + "'"; }

/// Places of [translation, rotation] in a tangent of the file.
template <class Pose>
constexpr auto kPlacesInFile = std::array<int, 3>{0, 1, 2};
template <>
constexpr auto kPlacesInFile<SE3> = std::array<int, 6>{3, 4, 5, 0, 1, 2};

/// Members of the JSON objects of a JRL file; errors name the object.
class JrlObject {
 public:
  using Json = nlohmann::ordered_json;

  /// `name` is for error messages: "measurement 2 of entry 5 of robot a". Refuses other values than objects.
  JrlObject(const Text& text, std::string name, const Json& json);

  bool has(const char* member) const { return json_->contains(member); }
  /// Each of these refuses a missing member, and one of another kind.
  const Json& array(const char* member) const {
    const Json& value = at(member);
    if (!value.is_array()) fail(quoted(member) + " is not a list");
    return value;
  }

  const Json& members(const char* member) const {
    const Json& value = at(member);
    if (!value.is_object()) fail(quoted(member) + " is not an object");
    return value;
  }

  JrlObject object(const char* member) const { return {*text_, name_ + ", " + quoted(member), at(member)}; }

  std::string word(const char* member) const {
    const Json& value = at(member);
    if (!value.is_string()) fail(quoted(member) + " is not a text");
    return value.get<std::string>();
  }

  double number(const char* member) const {
    const Json& value = at(member);
    if (!value.is_number()) fail(quoted(member) + " is not a number");
    return value.get<double>();
  }

  /// Metres, at most kMaxCoordinate_m.
  double coordinate(const char* member) const {
    const double value = number(member);
    if (std::abs(value) > kMaxCoordinate_m) fail(quoted(member) + " is not plausible");
    return value;
  }

  std::uint64_t key(const char* member) const {
    const Json& value = at(member);
    if (!value.is_number_unsigned()) fail(quoted(member) + " is not a key");
    return value.get<std::uint64_t>();
  }

  /// The members of an object of type Pose2 or Pose3.
  template <class Pose>
  Pose pose() const;
  /// Inverse of `covariance`, in the order [translation, rotation]; refuses one that is not positive
  /// definite.
  template <class Pose>
  typename Pose::Jacobian information() const {
    using Matrix = typename Pose::Jacobian;
    const Matrix stated(numbers<Pose::kDof * Pose::kDof>("covariance").data());
    const Matrix covariance = (stated + stated.transpose()) / 2;
    const auto& places = kPlacesInFile<Pose>;
    const auto information = information_of<Pose::kDof>(covariance(places, places));
    if (!information) fail("the covariance is not positive definite");
    return *information;
  }

  /// Root of a `covariance` of one number; refuses one that is not positive.
  double sigma() const {
    const double variance = numbers<1>("covariance")[0];
    if (!(variance > 0)) fail("the covariance is not positive");
    return std::sqrt(variance);
  }

  [[noreturn]] void fail(const std::string& reason) const { text_->fail(0, name_ + ": " + reason); }

 private:
  const Json& at(const char* member) const {
    const auto found = json_->find(member);
    if (found == json_->end()) fail(quoted(member) + " is missing");
    return *found;
  }

  /// The numbers of an array of this length.
  template <int N>
  Eigen::Matrix<double, N, 1> numbers(const char* member) const {
    const Json& list = array(member);
    const auto is_number = [](const Json& entry) { return entry.is_number(); };
    if (list.size() != N || !std::all_of(list.begin(), list.end(), is_number))
      fail(quoted(member) + " is not a list of " + std::to_string(N) + " numbers");
    Eigen::Matrix<double, N, 1> result;
    for (std::size_t k = 0; k < N; ++k) result[static_cast<Eigen::Index>(k)] = list[k].get<double>();
    return result;
  }

  const Text* text_;
  std::string name_;
  const Json* json_;
};

JrlObject::JrlObject(const Text& text, std::string name, const Json& json)
    : text_(&text), name_(std::move(name)), json_(&json) {
  if (!json.is_object()) fail("expected an object");
}

template <>
SE2 JrlObject::pose() const {
  if (word("type") != "Pose2") fail("its type is not Pose2");
  return {{coordinate("x"), coordinate("y")}, number("theta")};
}

template <>
SE3 JrlObject::pose() const {
  if (word("type") != "Pose3") fail("its type is not Pose3");
  const Eigen::Vector3d position = numbers<3>("translation");
  if (position.cwiseAbs().maxCoeff() > kMaxCoordinate_m) fail("'translation' is not plausible");
  const Eigen::Vector4d wxyz = numbers<4>("rotation");
  const double norm = wxyz.stableNorm();
  if (std::abs(norm - 1) > kUnitQuaternionTolerance) fail(not_a_unit_quaternion(norm));
  return {position, Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3])};
}

using Json = JrlObject::Json;

template <class Pose>
struct JrlTypes;
template <>
struct JrlTypes<SE2> {
  static constexpr const char *kRelativePose = "BetweenFactorPose2", *kPrior = "PriorFactorPose2",
                              *kRange = "RangeFactorPose2", *kPose = "Pose2";
};
template <>
struct JrlTypes<SE3> {
  static constexpr const char *kRelativePose = "BetweenFactorPose3", *kPrior = "PriorFactorPose3",
                              *kRange = "RangeFactorPose3", *kPose = "Pose3";
};

/// A measurement's place in the file: its robot, entry and number.
using FactorName = std::tuple<std::string, std::size_t, std::size_t>;

std::string text_of(const FactorName& name) {
  const auto& [robot, entry, number] = name;
  return "measurement " + std::to_string(number) + " of entry " + std::to_string(entry) + " of robot " +
         robot.substr(0, 40);
}

/// Calls `visit` with the name and the object of every measurement, in the order of the file.
template <class Visitor>
void visit_measurements(const Text& text, const JrlObject& file, const Visitor& visit) {
  for (const auto& [robot, entries] : file.members("measurements").items()) {
    if (!entries.is_array()) text.fail(0, "the measurements of robot " + robot + " are not a list");
    for (std::size_t e = 0; e < entries.size(); ++e) {
      const JrlObject entry(text, "entry " + std::to_string(e) + " of robot " + robot, entries[e]);
      if (!entry.has("measurements")) continue;
      const Json& measurements = entry.array("measurements");
      for (std::size_t m = 0; m < measurements.size(); ++m) {
        const FactorName name(robot, e, m);
        visit(name, JrlObject(text, text_of(name), measurements[m]));
      }
    }
  }
}

template <class Pose>
class JrlReader {
 public:
  JrlReader(const Text& text, const JrlObject& file, StatedStarts starts)
      : text_(text), file_(file), starts_(starts) {}

  TeamGraphFile<Pose> read() {
    visit_measurements(text_, file_, [this](const FactorName& name, const JrlObject& measurement) {
      read_measurement(name, measurement);
    });
    if (poses_.keys().empty()) text_.fail(0, "the graph has no poses");
    refuse_missing_letters();
    AssembledTeam<Pose> assembled = poses_.assemble(std::move(graph_), starts_);
    TeamGraphFile<Pose> out = std::move(assembled.file);
    read_labels(assembled.relative_pose_index, out);
    read_truth(out);
    for (const auto& [type, count] : skipped_)
      out.notes.push_back(text_.name + ": " + std::to_string(count) + " measurements of type " + type +
                          " are not used");
    return out;
  }

 private:
  using Types = JrlTypes<Pose>;

  /// Keys without letters are those of a single robot.
  void refuse_missing_letters() const {
    const auto has_none = [](std::uint64_t key) { return key <= kKeyPlaceMask; };
    const auto& keys = poses_.keys();
    std::size_t robots = 0;
    for (const auto& [robot, entries] : file_.members("measurements").items())
      robots += entries.empty() ? 0U : 1U;
    const bool all = std::all_of(keys.begin(), keys.end(), has_none) && robots > 1;
    if (!all && !id_without_letter(keys)) return;
    text_.fail(0,
               "key " + std::to_string(*std::find_if(keys.begin(), keys.end(), has_none)) +
                   " has no robot's letter (top eight bits), but the log is of several robots: the robots' "
                   "letters are missing");
  }

  void read_measurement(const FactorName& name, const JrlObject& measurement) {
    const std::string type = measurement.word("type");
    if (type == Types::kRelativePose) return read_relative_pose(name, measurement);
    if (type == Types::kPrior) return read_prior(measurement);
    if (type == Types::kRange) return read_range(measurement);
    using Other = JrlTypes<std::conditional_t<Pose::kDim == 2, SE3, SE2>>;
    if (type == Other::kRelativePose || type == Other::kPrior || type == Other::kRange)
      measurement.fail(type + ": the graph mixes 2D and 3D");
    ++skipped_[type.substr(0, 40)];
  }

  void read_relative_pose(const FactorName& name, const JrlObject& measurement) {
    RelativePoseFactor<Pose> factor;
    factor.i = poses_.at(measurement.key("key1"));
    factor.j = poses_.at(measurement.key("key2"));
    if (factor.i == factor.j) measurement.fail("an edge from a pose to itself");
    factor.T_i_j = measurement.object("measurement").template pose<Pose>();
    factor.information = measurement.information<Pose>();
    graph_.relative_poses.push_back(factor);
    names_.push_back(name);
  }

  void read_prior(const JrlObject& measurement) {
    PosePriorFactor<Pose>& factor = graph_.pose_priors.emplace_back();
    factor.i = poses_.at(measurement.key("key"));
    factor.prior = measurement.object("prior").template pose<Pose>();
    factor.information = measurement.information<Pose>();
  }

  void read_range(const JrlObject& measurement) {
    RangeFactor<Pose>& factor = graph_.ranges.emplace_back();
    factor.i.pose = poses_.at(measurement.key("key1"));
    factor.j.pose = poses_.at(measurement.key("key2"));
    if (factor.i.pose == factor.j.pose) measurement.fail("a range from a pose to itself");
    factor.range_m = measurement.coordinate("measurement");
    if (factor.range_m < 0) measurement.fail("the range is negative");
    factor.sigma_m = measurement.sigma();
  }

  void read_labels(const std::vector<std::size_t>& file_index, TeamGraphFile<Pose>& out) const {
    if (!file_.has("outlier_factors")) return;
    const std::set<FactorName> wrong = outliers();
    for (const std::size_t f : file_index) out.labels.emplace_back(!wrong.contains(names_[f]));
  }

  std::set<FactorName> outliers() const {
    std::set<FactorName> wrong;
    for (const auto& [robot, list] : file_.members("outlier_factors").items())
      for (const Json& entry : list) {
        const auto is_index = [](const Json& index) { return index.is_number_unsigned(); };
        if (!entry.is_array() || entry.size() != 2 || !is_index(entry[0]) || !is_index(entry[1]))
          text_.fail(0, "an outlier factor of robot " + robot + " is not [entry, measurement]");
        wrong.emplace(robot, entry[0].get<std::size_t>(), entry[1].get<std::size_t>());
      }
    refuse_unknown(wrong);
    return wrong;
  }

  void refuse_unknown(std::set<FactorName> wrong) const {
    visit_measurements(text_, file_, [&](const FactorName& name, const JrlObject&) { wrong.erase(name); });
    if (!wrong.empty())
      text_.fail(0, "an outlier factor is " + text_of(*wrong.begin()) + ", which does not exist");
  }

  void read_truth(TeamGraphFile<Pose>& out) const {
    if (!file_.has("groundtruth")) return;
    std::unordered_map<std::uint64_t, Pose> truth;  // used for look-up only, never iterated
    for (const auto& [robot, values] : file_.members("groundtruth").items())
      for (const Json& json : values) {
        const JrlObject value(text_, "the groundtruth of robot " + robot, json);
        if (value.word("type") == Types::kPose) truth.try_emplace(value.key("key"), value.pose<Pose>());
      }
    for (const std::uint64_t key : out.pose_ids) {
      const auto found = truth.find(key);
      out.true_poses.push_back(found == truth.end() ? std::nullopt : std::optional<Pose>(found->second));
    }
  }

  const Text& text_;
  const JrlObject& file_;
  StatedStarts starts_;
  PoseGraph<Pose> graph_;
  std::vector<FactorName> names_;  // per relative pose
  KeyedPoses poses_;
  std::map<std::string, std::size_t> skipped_;  // measurements by type
};

/// By the first measurement of a type that is read.
int dimension_of(const Text& text, const JrlObject& file) {
  int dimension = 0;
  visit_measurements(text, file, [&](const FactorName&, const JrlObject& measurement) {
    if (dimension != 0) return;
    const std::string type = measurement.word("type");
    if (type.ends_with("Pose2")) dimension = 2;
    if (type.ends_with("Pose3")) dimension = 3;
  });
  if (dimension == 0) text.fail(0, "the graph has no measurements of poses");
  return dimension;
}

}  // namespace

bool is_jrl_file(const std::filesystem::path& path) {
  return (has_zstd_extension(path) ? path.stem() : path).extension() == ".jrl";
}

AnyTeamGraphFile read_jrl(const Text& text, StatedStarts starts) {
  const Json json = read_json(text);
  const JrlObject file(text, "the log", json);
  if (dimension_of(text, file) == 2) return JrlReader<SE2>(text, file, starts).read();
  return JrlReader<SE3>(text, file, starts).read();
}

}  // namespace radioslam
