#include "radioslam/io/graph/g2o_team.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/keyed_poses.hpp"
#include "radioslam/io/graph/repeated_edges.hpp"
#include "radioslam/io/graph/team_ids.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam {
namespace {

constexpr std::uint64_t kMaxLetter = 255;
/// Standard deviations of a start that a VERTEX line states, as by default those of a mission's known starts.
constexpr double kSigmaStart_m = 0.05, kSigmaStart_rad = 0.01;

/// A robot whose file has ids without letters: the name comes from the file, the letter is chosen.
struct NamedRobot {
  std::string name;
  std::uint64_t letter = 0;
};

const std::vector<std::uint64_t>& pose_ids(const AnyG2oGraph& any) {
  return std::visit([](const auto& file) -> const std::vector<std::uint64_t>& { return file.pose_ids; }, any);
}

bool has_letters(const AnyG2oGraph& file) {
  const auto& ids = pose_ids(file);
  return std::any_of(ids.begin(), ids.end(), [](std::uint64_t id) { return id >> kKeyRobotShift != 0; });
}

/// Refuses a team of which some ids have letters and some have none, whatever file they are in.
void refuse_mixed_letters(const std::vector<AnyG2oGraph>& files, std::span<const Text> texts) {
  std::vector<std::uint64_t> all;
  for (const AnyG2oGraph& file : files) all.insert(all.end(), pose_ids(file).begin(), pose_ids(file).end());
  const auto id = id_without_letter(all);
  for (std::size_t k = 0; id && k < files.size(); ++k)
    if (std::find(pose_ids(files[k]).begin(), pose_ids(files[k]).end(), *id) != pose_ids(files[k]).end())
      refuse_missing_letter(texts[k], *id);
}

/// Names of the robots by their files, or nothing where one file or letters make them robots.
std::vector<std::optional<NamedRobot>> robots_of(const std::vector<AnyG2oGraph>& files,
                                                 std::span<const Text> texts) {
  std::vector<std::optional<NamedRobot>> robots(files.size());
  if (files.size() == 1 || std::any_of(files.begin(), files.end(), has_letters)) return robots;
  std::set<std::string> names;
  for (std::size_t k = 0; k < files.size(); ++k) {
    std::filesystem::path path = texts[k].name;
    if (has_zstd_extension(path)) path = path.stem();
    robots[k] = NamedRobot{path.stem().string(), 'a' + k};
    const std::string& name = robots[k]->name;
    if (!is_valid_id(name)) texts[k].fail(0, "its name is not valid as that of a robot");
    if (!names.insert(name).second)
      texts[k].fail(0, "another file is named '" + name + "' too: each is a robot");
    if (robots[k]->letter > kMaxLetter) texts[k].fail(0, "too many files whose ids have no letters");
  }
  return robots;
}

/// Merges the files' graphs into one, with one pose per id.
template <class Pose>
class TeamMerge {
 public:
  /// `robots` names, per file, its only robot where ids have no letters.
  TeamMerge(const std::vector<std::optional<NamedRobot>>& robots, const DividedIds& divided)
      : robots_(robots), divided_(divided) {}

  void add(const G2oGraph<Pose>& file, const Text& text) {
    const PoseGraph<Pose>& graph = file.graph;
    if (file.skipped_lines.count() > 0) notes_.push_back(file.skipped_lines.warning(text.name, "line"));
    if (second_odometry<Pose>(graph, file.pose_ids) == SecondOdometry::kAgrees)
      notes_.push_back(
          text.name +
          ": most edges between successive ids appear twice; if these are poses of two robots, the "
          "robots' letters are missing in the ids");
    if (first_skipped_.count() == 0) first_skipped_ = file.skipped_lines;
    graph_.chart = graph.chart;
    std::vector<PoseId> poses;
    for (std::size_t k = 0; k < file.pose_ids.size(); ++k) {
      const auto& robot = robot_of(file.pose_ids[k]);
      const std::uint64_t key = key_of(file.pose_ids[k]);
      poses.push_back(robot ? poses_.at(key, robot->name) : poses_.at(key));
      if (file.pose_has_value[k]) stated_.try_emplace(key, graph.poses[k]);
    }
    std::vector<PointId> points;
    const auto& of_file = robots_[file_];
    for (const std::uint64_t id : file.point_ids)
      points.push_back(point(of_file ? (of_file->letter << kKeyRobotShift) | id : id));
    const auto renamed = [&](RangeEnd<Pose> end) {
      if (end.pose.valid())
        end.pose = poses[end.pose.index()];
      else
        end.point = points[end.point.index()];
      return end;
    };
    for (auto factor : graph.relative_poses) {
      factor.i = poses[factor.i.index()];
      factor.j = poses[factor.j.index()];
      if (is_new(factor)) graph_.relative_poses.push_back(factor);
    }
    end_of_file();
    for (auto factor : graph.ranges) {
      factor.i = renamed(factor.i);
      factor.j = renamed(factor.j);
      graph_.ranges.push_back(factor);
    }
    for (auto factor : graph.relative_points) {
      factor.i = poses[factor.i.index()];
      factor.j = renamed(factor.j);
      graph_.relative_points.push_back(factor);
    }
    for (auto factor : graph.pose_priors) {
      factor.i = poses[factor.i.index()];
      graph_.pose_priors.push_back(factor);
    }
    ++file_;
  }

  TeamGraphFile<Pose> assemble(StatedStarts starts) {
    if (!measures_anything(graph_)) first_skipped_.throw_first();
    if (starts == StatedStarts::kUsed) add_start_priors();
    TeamGraphFile<Pose> out = poses_.assemble(std::move(graph_), starts).file;
    out.notes.insert(out.notes.begin(), notes_.begin(), notes_.end());
    for (const std::uint64_t id : point_ids_) out.point_names.push_back(std::to_string(id));
    out.point_ids = point_ids_;
    return out;
  }

 private:
  /// The robot of an id in the current file; nothing where its letter says it.
  const std::optional<NamedRobot>& robot_of(std::uint64_t id) const {
    return robots_[divided_.file_of(id).value_or(file_)];
  }

  /// The key of a pose in the current file: with the robot's letter.
  std::uint64_t key_of(std::uint64_t id) const {
    const auto& robot = robot_of(id);
    return robot ? (robot->letter << kKeyRobotShift) | id : id;
  }

  PointId point(std::uint64_t id) {
    const auto [place, is_new_id] = points_.try_emplace(id, PointId(point_ids_.size()));
    if (is_new_id) {
      point_ids_.push_back(id);
      graph_.points.emplace_back(Pose::Point::Zero());
    }
    return place->second;
  }

  /// A prior on the first pose of every robot without one, where it has a VERTEX line.
  void add_start_priors() {
    std::set<std::string> done;
    for (const auto& prior : graph_.pose_priors) done.insert(poses_.places()[prior.i.index()].robot);
    for (const auto& [key, pose] : poses_.by_key()) {  // of a robot, the first pose comes first
      if (!done.insert(poses_.places()[pose.index()].robot).second) continue;
      const auto stated = stated_.find(key);
      if (stated == stated_.end()) continue;
      PosePriorFactor<Pose>& prior = graph_.pose_priors.emplace_back();
      prior.i = pose;
      prior.prior = stated->second;
      typename Pose::Tangent sigmas = Pose::Tangent::Constant(kSigmaStart_m);
      sigmas.template tail<Pose::kDof - Pose::kDim>().setConstant(kSigmaStart_rad);
      prior.information = sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
    }
  }

  using Ends = std::pair<PoseId, PoseId>;

  /// False for an edge that an earlier file contains, up to rounding. Others that repeat one are found where
  /// the team is assembled.
  bool is_new(const RelativePoseFactor<Pose>& factor) {
    const auto [begin, end] = earlier_.equal_range(Ends(factor.i, factor.j));
    for (auto edge = begin; edge != end; ++edge)
      if (are_equal_edges(graph_.relative_poses[edge->second], factor)) return false;
    of_this_file_.emplace_back(Ends(factor.i, factor.j), graph_.relative_poses.size());
    return true;
  }

  void end_of_file() {
    earlier_.insert(of_this_file_.begin(), of_this_file_.end());
    of_this_file_.clear();
  }

  const std::vector<std::optional<NamedRobot>>& robots_;
  const DividedIds& divided_;
  std::size_t file_ = 0;  // the current one
  PoseGraph<Pose> graph_;
  std::vector<std::string> notes_;
  SkippedRecords first_skipped_;  // of the first file with any
  KeyedPoses poses_;
  std::vector<std::uint64_t> point_ids_;
  std::map<std::uint64_t, Pose> stated_;  // VERTEX lines
  std::map<std::uint64_t, PointId> points_;
  std::multimap<Ends, std::size_t> earlier_;  // relative poses of the previous files, by their ends
  std::vector<std::pair<Ends, std::size_t>> of_this_file_;
};

template <class Pose>
TeamGraphFile<Pose> merge(const std::vector<AnyG2oGraph>& files, std::span<const Text> texts,
                          const DividedIds& divided, StatedStarts starts) {
  const auto robots = robots_of(files, texts);
  TeamMerge<Pose> team(robots, divided);
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto* file = std::get_if<G2oGraph<Pose>>(&files[k]);
    if (file == nullptr) texts[k].fail(1, "the team's files mix 2D and 3D");
    team.add(*file, texts[k]);
  }
  return team.assemble(starts);
}

}  // namespace

AnyTeamGraphFile read_g2o_team(std::span<const Text> texts, StatedStarts starts, RepairInformation repair) {
  const DividedIds divided(texts);
  const auto is_elsewhere = [&](std::uint64_t id) { return divided.file_of(id).has_value(); };
  std::vector<AnyG2oGraph> files;
  for (const Text& text : texts) files.push_back(read_g2o(text, repair, BadLines::kSkip, is_elsewhere));
  refuse_mixed_letters(files, texts);
  if (std::holds_alternative<G2oGraph<SE2>>(files.front())) return merge<SE2>(files, texts, divided, starts);
  return merge<SE3>(files, texts, divided, starts);
}

}  // namespace radioslam
