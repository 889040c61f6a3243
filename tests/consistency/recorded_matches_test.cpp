// Published simulated teams whose matches are half false, with labels: exactly the true ones are kept.
#include <Eigen/LU>
#include <map>

#include "io/recorded_data.hpp"
#include "radioslam/consistency/consistent_set.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

using Edge = std::pair<std::uint64_t, std::uint64_t>;

constexpr int kLetterShift = 56;  // of a pose's id: its robot's letter above, its number below
std::uint64_t letter_of(std::uint64_t id) { return id >> kLetterShift; }
std::size_t number_of(std::uint64_t id) {
  return static_cast<std::size_t>(id & ((std::uint64_t{1} << kLetterShift) - 1));
}

/// The file without an incomplete line that one of the files contains.
Text without_incomplete_line(Text text) {
  const std::string incomplete_line = "0410268 0.7588833\n";
  if (const auto at = text.content.find(incomplete_line); at != std::string::npos)
    text.content.erase(at, incomplete_line.size());
  return text;
}

/// Covariance of Log from an information of g2o's error, whose rotation is half an angle.
SE3::Jacobian covariance_of(const RelativePoseFactor<SE3>& factor) {
  SE3::Tangent scale;
  scale << 1, 1, 1, 2, 2, 2;
  return scale.asDiagonal() * SE3::Jacobian(factor.information.inverse()) * scale.asDiagonal();
}

/// One robot's file: its odometry and all its matches, with the ids of their ends.
struct RobotFile {
  std::uint64_t letter = 0;
  std::vector<RelativePoseMatch<SE3>> steps;
  std::vector<std::pair<Edge, RelativePoseMatch<SE3>>> matches;

  explicit RobotFile(const std::filesystem::path& path) {
    const auto file = std::get<G2oGraph<SE3>>(read_g2o(without_incomplete_line(read_text(path))));
    letter = letter_of(file.pose_ids.front());
    for (const auto& factor : file.graph.relative_poses) {
      const Edge edge{file.pose_ids[factor.i.index()], file.pose_ids[factor.j.index()]};
      const RelativePoseMatch<SE3> match{number_of(edge.first), number_of(edge.second), factor.T_i_j,
                                         covariance_of(factor)};
      if (letter_of(edge.first) == letter_of(edge.second))
        steps.push_back(match);
      else
        matches.emplace_back(edge, match);
    }
  }

  OdometryChain<SE3> chain() const {
    std::vector<SE3> poses(1);
    std::vector<SE3::Jacobian> covariances;
    for (const auto& step : steps) {
      EXPECT_EQ(step.pose_a + 1, step.pose_b);
      poses.push_back(poses.back() * step.T_a_b);
      covariances.push_back(step.covariance);
    }
    return {poses, covariances};
  }
};

std::map<Edge, bool> read_labels(const std::filesystem::path& path) {
  const Text text = read_text(path);
  CsvReader csv(text, {{"id1", "id2", "gnc_inlier"}});
  std::map<Edge, bool> labels;
  while (csv.next()) labels[{*parse_id(csv.field(0)), *parse_id(csv.field(1))}] = csv.field(2) == "1";
  return labels;
}

/// Expects that true and false matches of robots a and b are separated; each is an edge in either direction.
void expect_separated(const RobotFile& a, const RobotFile& b, const std::map<Edge, bool>& labels) {
  std::vector<RelativePoseMatch<SE3>> matches;
  std::vector<std::size_t> expected;
  for (const auto& [edge, match] : a.matches) {
    if (letter_of(edge.first) != b.letter && letter_of(edge.second) != b.letter) continue;
    ASSERT_EQ(letter_of(edge.first), a.letter);
    if (labels.at(edge)) expected.push_back(matches.size());
    matches.push_back(match);
  }
  ASSERT_GE(matches.size(), 8U);
  const auto set = largest_consistent_set(a.chain(), b.chain(), matches);
  EXPECT_EQ(set.members, expected);
  EXPECT_TRUE(set.proven);
  EXPECT_LT(set.second_largest, expected.size()) << "no tie";
}

class SpoiledTeam : public testing::TestWithParam<std::size_t> {};

TEST_P(SpoiledTeam, KeepsExactlyTheTrueMatches) {
  RADIOSLAM_RECORDED(folder, "multirobot_pcm");
  const std::string name = "example_" + std::to_string(GetParam()) + "robots";
  const auto labels = read_labels(
      folder / "labels" / ("gnc_pairwise_consistency_maximization__spoiled__simulation__" + name + ".csv"));
  std::vector<RobotFile> robots;
  for (std::size_t r = 0; r < GetParam(); ++r)
    robots.emplace_back(folder / "test_data/pairwise_consistency_maximization/spoiled/simulation" / name /
                        (std::to_string(r) + ".g2o"));
  for (std::size_t b = 0; b < robots.size(); ++b)
    for (std::size_t a = 0; a < b; ++a) expect_separated(robots[a], robots[b], labels);
}

INSTANTIATE_TEST_SUITE_P(Consistency, SpoiledTeam, testing::Values(2, 4, 8));

}  // namespace
}  // namespace radioslam
