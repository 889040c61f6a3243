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

bool has_letters(const AnyG2oGraph& any) {
  return std::visit(
      [](const auto& file) {
        const auto has_letter = [](std::uint64_t id) { return id >> kKeyRobotShift != 0; };
        return std::any_of(file.pose_ids.begin(), file.pose_ids.end(), has_letter);
      },
      any);
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
  /// `robot` names the file's only robot where ids have no letters.
  void add(const G2oGraph<Pose>& file, const Text& text, const std::optional<NamedRobot>& robot) {
    const PoseGraph<Pose>& graph = file.graph;
    robot_ = robot;
    if (file.skipped_lines.count() > 0) notes_.push_back(file.skipped_lines.warning(text.name, "line"));
    graph_.chart = graph.chart;
    std::vector<PoseId> poses;
    for (std::size_t k = 0; k < file.pose_ids.size(); ++k) {
      const std::uint64_t key = key_of(file.pose_ids[k]);
      poses.push_back(robot ? poses_.at(key, robot->name) : poses_.at(key));
      if (file.pose_has_value[k]) stated_.try_emplace(key, graph.poses[k]);
    }
    std::vector<PointId> points;
    for (const std::uint64_t id : file.point_ids) points.push_back(point(key_of(id)));
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
  }

  TeamGraphFile<Pose> assemble(StatedStarts starts) {
    if (starts == StatedStarts::kUsed) add_start_priors();
    TeamGraphFile<Pose> out = poses_.assemble(std::move(graph_), starts).file;
    out.notes.insert(out.notes.begin(), notes_.begin(), notes_.end());
    for (const std::uint64_t id : point_ids_) out.point_names.push_back(std::to_string(id));
    out.point_ids = point_ids_;
    return out;
  }

 private:
  /// The key of a pose or point of the current file: with the robot's letter.
  std::uint64_t key_of(std::uint64_t id) const {
    return robot_ ? (robot_->letter << kKeyRobotShift) | id : id;
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

  PoseGraph<Pose> graph_;
  std::optional<NamedRobot> robot_;
  std::vector<std::string> notes_;
  KeyedPoses poses_;
  std::vector<std::uint64_t> point_ids_;
  std::map<std::uint64_t, Pose> stated_;  // VERTEX lines
  std::map<std::uint64_t, PointId> points_;
  std::multimap<Ends, std::size_t> earlier_;  // relative poses of the previous files, by their ends
  std::vector<std::pair<Ends, std::size_t>> of_this_file_;
};

template <class Pose>
TeamGraphFile<Pose> merge(const std::vector<AnyG2oGraph>& files, std::span<const Text> texts,
                          StatedStarts starts) {
  TeamMerge<Pose> team;
  const auto robots = robots_of(files, texts);
  for (std::size_t k = 0; k < files.size(); ++k) {
    const auto* file = std::get_if<G2oGraph<Pose>>(&files[k]);
    if (file == nullptr) texts[k].fail(1, "the team's files mix 2D and 3D");
    team.add(*file, texts[k], robots[k]);
  }
  return team.assemble(starts);
}

}  // namespace

AnyTeamGraphFile read_g2o_team(std::span<const Text> texts, StatedStarts starts) {
  std::vector<AnyG2oGraph> files;
  for (const Text& text : texts) files.push_back(read_g2o(text, RepairInformation::kNo, BadLines::kSkip));
  if (std::holds_alternative<G2oGraph<SE2>>(files.front())) return merge<SE2>(files, texts, starts);
  return merge<SE3>(files, texts, starts);
}

}  // namespace radioslam
