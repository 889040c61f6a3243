// Teams from plain and compressed g2o files, and recorded graphs with the sizes that their sources state.
#include "radioslam/io/graph/team_graph_file.hpp"

#include <zstd.h>

#include <algorithm>
#include <fstream>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"
#include "io/temporary_folder.hpp"
#include "radioslam/io/graph/g2o.hpp"
#include "radioslam/io/graph/g2o_team.hpp"
#include "radioslam/io/text/compressed_text.hpp"

namespace radioslam {
namespace {

std::string id(char robot, int place) {
  return std::to_string((std::uint64_t{static_cast<unsigned char>(robot)} << 56) +
                        static_cast<std::uint64_t>(place));
}
std::string edge(const std::string& i, const std::string& j, double x) {
  return "EDGE_SE2 " + i + " " + j + " " + std::to_string(x) + " 0 0 1 0 0 1 0 1\n";
}
std::string vertex(const std::string& name, double x) {
  return "VERTEX_SE2 " + name + " " + std::to_string(x) + " 0 0\n";
}

TeamGraphFile<SE2> read_graph_lines(const std::vector<std::string>& contents,
                                    StatedStarts starts = StatedStarts::kIgnored) {
  std::vector<Text> texts;
  for (const auto& content : contents) texts.push_back(make_text("t.g2o", content));
  return std::get<TeamGraphFile<SE2>>(read_g2o_team(texts, starts));
}

TEST(G2oTeam, LettersAreRobotsAndVerticesAreNoStart) {
  const auto file = read_graph_lines({vertex(id('a', 0), 5) + vertex(id('a', 1), 50) + vertex(id('b', 0), 7) +
                                      vertex(id('b', 1), 70) + edge(id('a', 0), id('b', 1), 9) +
                                      edge(id('a', 0), id('a', 1), 1) + edge(id('b', 0), id('b', 1), 2)});
  ASSERT_EQ(file.team.segments.size(), 2u);
  EXPECT_EQ(file.team.segments[1].robot, "b");
  EXPECT_EQ(file.team.graph.poses[0].translation().x(), 0);
  EXPECT_EQ(file.team.graph.poses[1].translation().x(), 1);
  EXPECT_EQ(file.team.graph.poses[3].translation().x(), 2);
  EXPECT_TRUE(file.true_poses.empty());
  ASSERT_EQ(file.team.graph.relative_poses.size(), 3u);
  EXPECT_EQ(file.team.graph.relative_poses[2].T_i_j.translation().x(), 9);
  EXPECT_EQ(file.team.graph.chart, PoseChart::kG2o);
  EXPECT_EQ(file.team.segments[0].stamps[1], Stamp::from_seconds(1));
}

/// Two robots of two poses each, and edges between them, as they are written.
TeamGraphFile<SE2> read_links(const std::string& in_a, const std::string& in_b) {
  return read_graph_lines({edge(id('a', 0), id('a', 1), 1) + in_a, edge(id('b', 0), id('b', 1), 2) + in_b});
}
std::string link(const std::string& i, const std::string& j, const std::string& measured,
                 const std::string& information = "100 0 0 100 0 400") {
  return "EDGE_SE2 " + i + " " + j + " " + measured + " " + information + "\n";
}
const std::string a0 = id('a', 0), b0 = id('b', 0);

TEST(G2oTeam, ALinkThatTheOtherRobotHasSeenFromItsSideCountsOnce) {
  // The inverse of (3, 1, 0.5): information of the same matrix, and carried over to the other end.
  const std::string there = link(a0, b0, "3 1 0.5"), back = "-3.112173224 0.560694054 -0.5";
  const SE2 inverse = SE2({3, 1}, 0.5).inverse();
  ASSERT_LT((inverse.inverse() * SE2({-3.112173226, 0.560694054}, -0.5)).log().norm(), 1e-8);
  const SE2::Jacobian carried = inverse.adjoint();
  const SE2::Jacobian information =
      carried.transpose() * Eigen::Vector3d(100, 100, 400).asDiagonal() * carried;
  std::string carried_over;
  for (int r = 0; r < 3; ++r)
    for (int c = r; c < 3; ++c) carried_over += std::to_string(information(r, c)) + " ";
  for (const std::string& again : {link(b0, a0, back), link(b0, a0, back, carried_over)}) {
    const auto file = read_links(there, again);
    EXPECT_EQ(file.team.graph.relative_poses.size(), 3u);
    ASSERT_EQ(file.notes.size(), 1u);
    EXPECT_EQ(file.notes[0].find("1 edges between robots repeat another one"), 0u) << file.notes[0];
  }
  EXPECT_EQ(read_links(there, link(b0, a0, back, "1 0 0 1 0 1")).team.graph.relative_poses.size(), 4u);
}

TEST(G2oTeam, ALinkThatIsRoundedToFourDigitsCountsOnce) {
  const std::string there = link(a0, b0, "12.3456789 -0.0123456789 1.23456789");
  for (const char* rounded : {"12.35 -0.01235 1.235", "12.3457 -0.0123 1.2346"})
    EXPECT_EQ(read_links(there, link(a0, b0, rounded)).team.graph.relative_poses.size(), 3u) << rounded;
  EXPECT_EQ(read_links(there, link(a0, b0, "12.33 -0.01235 1.235")).team.graph.relative_poses.size(), 4u);
}

TEST(G2oTeam, ALinkThatStandsTwiceInOneFileIsNoted) {
  const std::string one = link(a0, b0, "3 1 0.5");
  const auto file = read_links(one + one, "");
  EXPECT_EQ(file.team.graph.relative_poses.size(), 4u);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_NE(file.notes[0].find("count twice"), std::string::npos) << file.notes[0];
  EXPECT_EQ(
      read_links(one + link(b0, a0, "-3.112173224 0.560694054 -0.5"), "").team.graph.relative_poses.size(),
      3u);
}

TEST(G2oTeam, TwoMeasurementsBetweenTheSamePosesBothCount) {
  for (const std::string& other :
       {link(a0, b0, "3.01 1.002 0.503"), link(a0, b0, "3.001 1 0.5"), link(b0, a0, "-3.112 0.57 -0.501")}) {
    const auto file = read_links(link(a0, b0, "3 1 0.5"), other);
    EXPECT_EQ(file.team.graph.relative_poses.size(), 4u) << other;
    EXPECT_TRUE(file.notes.empty());
  }
}

TEST(G2oTeam, VerticesOfFirstPosesAreStartsOnRequest) {
  const std::string content = vertex(id('a', 1), 50) + vertex(id('a', 0), 5) + vertex(id('b', 0), 7) +
                              vertex(id('b', 1), 70) + edge(id('a', 0), id('a', 1), 1) +
                              edge(id('b', 0), id('b', 1), 2) + edge(id('c', 0), id('c', 1), 2) +
                              "EDGE_PRIOR_SE2 " + id('b', 1) + " 8 0 0 1 0 0 1 0 1\n";
  const auto file = read_graph_lines({content}, StatedStarts::kUsed);
  ASSERT_EQ(file.team.segments.size(), 3u);
  EXPECT_TRUE(file.team.segments[0].in_common_frame);
  EXPECT_TRUE(file.team.segments[1].in_common_frame);
  EXPECT_FALSE(file.team.segments[2].in_common_frame);  // without VERTEX lines
  EXPECT_EQ(file.team.graph.poses[0].translation().x(), 5);
  EXPECT_EQ(file.team.graph.poses[1].translation().x(), 6);
  EXPECT_EQ(file.team.graph.poses[2].translation().x(), 6);  // by its prior
  EXPECT_EQ(file.team.graph.pose_priors.size(), 2u);
}

TEST(G2oTeam, PlainIdsAreOneRobot) {
  const auto file = read_graph_lines({edge("3", "4", 1) + edge("4", "9", 1) + edge("3", "9", 2)});
  ASSERT_EQ(file.team.segments.size(), 1u);
  EXPECT_EQ(file.team.segments[0].robot, "a");
  EXPECT_EQ(file.team.segments[0].pose_count, 3u);
  EXPECT_EQ(file.pose_names, (std::vector<std::string>{"3", "4", "9"}));
}

TEST(G2oTeam, EdgesBetweenRobotsInBothFilesCountOnce) {
  const std::string link = edge(id('a', 1), id('b', 0), 3);
  const auto file =
      read_graph_lines({edge(id('a', 0), id('a', 1), 1) + link,
                        edge(id('b', 0), id('b', 1), 1) + link + edge(id('a', 1), id('b', 0), 4)});
  EXPECT_EQ(file.team.graph.relative_poses.size(), 4u);
  EXPECT_EQ(file.team.segments.size(), 2u);
  const auto within_a_file =
      read_graph_lines({edge(id('a', 0), id('b', 0), 3) + edge(id('a', 0), id('b', 0), 3)});
  EXPECT_EQ(within_a_file.team.graph.relative_poses.size(), 2u);
}

TeamGraphFile<SE2> read_named(const std::vector<std::pair<std::string, std::string>>& files) {
  std::vector<Text> texts;
  for (const auto& [name, content] : files) texts.push_back(make_text(name, content));
  return std::get<TeamGraphFile<SE2>>(read_g2o_team(texts));
}

TEST(G2oTeam, FilesWithoutLettersAreRobotsByTheirNames) {
  const auto file = read_named(
      {{"x/red.g2o", edge("0", "1", 1) + edge("1", "2", 1)}, {"x/blue.g2o.zst", edge("0", "1", 5)}});
  ASSERT_EQ(file.team.segments.size(), 2u);
  EXPECT_EQ(file.team.segments[0].robot, "red");
  EXPECT_EQ(file.team.segments[1].robot, "blue");
  EXPECT_EQ(file.team.segments[1].pose_count, 2u);
  EXPECT_EQ(file.team.graph.poses[4].translation().x(), 5);
  EXPECT_EQ(file.pose_names.back(), id('b', 1));
  expect_refusal(
      [] {
        read_named({{"x/0.g2o", edge("0", "1", 1)}, {"y/0.g2o", edge("0", "1", 1)}});
      },
      0, "another file is named '0'");
}

TEST(G2oTeam, AVertexWithTwoValuesIsRefusedAndTheLettersAreMissed) {
  const std::string a = vertex("0", 0) + vertex("1", 1) + edge("0", "1", 1);
  expect_refusal(
      [&] { read_graph_lines({a + vertex("0", 0) + vertex("1", 7) + edge("0", "1", 7)}); }, 5,
      "vertex 1 appears twice, with different values; if these are poses of two robots, the robots' "
      "letters are missing");
  expect_refusal([&] { read_g2o(make_text("t.g2o", a + vertex("1", 7))); }, 4, "letters are missing");
  expect_refusal([] { read_graph_lines({"VERTEX_XY 9 1 2\n" + edge("0", "1", 1) + "VERTEX_XY 9 1 3\n"}); }, 3,
                 "vertex 9 appears twice, with different values");
  expect_refusal([&] { read_graph_lines({vertex(id('a', 0), 0) + vertex(id('a', 0), 3) + a}); }, 2,
                 "with different values");
  const auto repeated = read_graph_lines({a + vertex("1", 1.000001)});
  EXPECT_EQ(repeated.team.graph.poses.size(), 2u);
  EXPECT_EQ(repeated.notes.size(), 1u);
}

TEST(G2oTeam, IdsWithAndWithoutLettersContradictEachOther) {
  const std::string lettered =
      vertex(id('a', 0), 0) + vertex(id('a', 1), 1) + edge(id('a', 0), id('a', 1), 1);
  const std::string plain = vertex("0", 0) + vertex("1", 1) + edge("0", "1", 1);
  const char* words = "vertex 0 has no robot's letter";
  expect_refusal([&] { read_graph_lines({lettered, plain}); }, 1, words);
  expect_refusal([&] { read_graph_lines({lettered + plain}); }, 4, words);
  expect_refusal([&] { read_g2o(make_text("t.g2o", lettered + plain)); }, 4, words);
  expect_refusal([&] { read_graph_lines({lettered, edge("0", "1", 1) + edge("1", "2", 1)}); }, 1, words);
  // A single edge whose ids are cut off is a bad line, and landmarks may have letters that poses have not.
  EXPECT_EQ(read_graph_lines({lettered + edge("698956", "698957", 1)}).pose_names.size(), 2u);
  const auto landmark = read_graph_lines(
      {plain + "VERTEX_XY " + id('l', 3) + " 1 2\nEDGE_SE2_XY 1 " + id('l', 3) + " 2 3 4 0 5\n"});
  EXPECT_EQ(landmark.team.graph.relative_points.size(), 1u);
  // Numbers in place of letters may be 0.
  const std::string one = std::to_string((std::uint64_t{1} << 56) + 1);
  EXPECT_EQ(read_graph_lines({edge("0", "1", 1) + edge("1", one, 2)}).team.segments.size(), 2u);
}

TEST(G2oTeam, TwoOdometriesOfIdsWithoutLettersAreOfTwoRobots) {
  std::string first, other, again;
  for (int k = 0; k < 5; ++k) {
    first += edge(std::to_string(k), std::to_string(k + 1), 1);
    other += edge(std::to_string(k), std::to_string(k + 1), 3);
    again += edge(std::to_string(k), std::to_string(k + 1), 1.1);
  }
  expect_refusal([&] { read_graph_lines({first + other}); }, 6, "the robots' letters are missing");
  expect_refusal([&] { read_g2o(make_text("t.g2o", first + other)); }, 6,
                 "appear twice, with different motions");
  const auto twice = read_graph_lines({first + again});
  ASSERT_EQ(twice.notes.size(), 1u);
  EXPECT_NE(twice.notes[0].find("the robots' letters are missing"), std::string::npos);
  EXPECT_TRUE(read_graph_lines({first + edge("0", "1", 3)}).notes.empty());
}

TEST(G2oTeam, IdsThatFilesDivideAmongThemNamePosesOfOthers) {
  const std::string link = edge("1", "21", 5);
  const auto lines = [](int first) {
    std::string out;
    for (int k = first; k < first + 3; ++k) out += vertex(std::to_string(k), k - first);
    for (int k = first; k < first + 2; ++k) out += edge(std::to_string(k), std::to_string(k + 1), 1);
    return out;
  };
  const auto edges_of = [](int first) {
    return edge(std::to_string(first), std::to_string(first + 1), 1) +
           edge(std::to_string(first + 1), std::to_string(first + 2), 1);
  };
  const std::vector<std::vector<std::pair<std::string, std::string>>> teams = {
      {{"0.g2o", lines(0) + link}, {"1.g2o", lines(20) + link}},
      {{"0.g2o", lines(0)}, {"1.g2o", lines(20)}, {"links.g2o", link}},
      {{"0.g2o", edges_of(0) + link}, {"1.g2o", edges_of(20) + link}},
      {{"0.g2o", lines(0) + vertex("21", 9) + link}, {"1.g2o", lines(20) + vertex("1", 9) + link}}};
  for (const auto& files : teams) {
    const auto file = read_named(files);
    ASSERT_EQ(file.team.segments.size(), 2u);
    EXPECT_EQ(file.team.segments[0].robot, "0");
    EXPECT_EQ(file.team.segments[1].robot, "1");
    EXPECT_EQ(file.pose_ids.back(), (std::uint64_t{'b'} << 56) + 22);
    ASSERT_EQ(file.team.graph.relative_poses.size(), 5u);
    EXPECT_EQ(file.team.graph.relative_poses[4].i, PoseId(1));
    EXPECT_EQ(file.team.graph.relative_poses[4].j, PoseId(4));
    EXPECT_TRUE(file.notes.empty());
  }
}

TEST(G2oTeam, AGraphThatMeasuresNothingIsRefused) {
  const std::string poses = vertex("0", 0) + vertex("1", 1) + vertex("2", 2);
  expect_refusal([&] { read_graph_lines({poses + "EDGE_SE2 0 1 1 0 0\nEDGE_SE2 1 2 1 0 0\n"}); }, 4,
                 "t.g2o:4");
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "t.g2o") << poses;
  expect_refusal([&] { read_team_graph(folder.path() / "t.g2o"); }, 0,
                 "nothing is measured between its poses");
  std::ofstream(folder.path() / "t.pyfg") << "VERTEX_SE2 0 A0 0 0 0\nVERTEX_SE2 1 A1 0 0 0\n";
  expect_refusal([&] { read_team_graph(folder.path() / "t.pyfg"); }, 0, "nothing is measured");
  std::ofstream(folder.path() / "one.g2o") << vertex("0", 0);
  EXPECT_NO_THROW(read_team_graph(folder.path() / "one.g2o"));
}

TEST(G2oTeam, BadLinesAreLeftOutWithANote) {
  const std::string good = vertex(id('a', 0), 0) + vertex(id('a', 1), 1) + edge(id('a', 0), id('a', 1), 1) +
                           edge(id('b', 0), id('b', 1), 1) + edge(id('b', 1), id('a', 1), 1);
  const auto whole = read_graph_lines({good});
  for (const char* bad :
       {"0410268 0.7588833", "EDGE_SE2 1 2", "VERTEX_SE2 5 1 x 0", "EDGE_SE2 7 8 1 0 0 1 0 0 1 0 1 9",
        "EDGE_BEARING_SE2_XY 1 2 0.5 1", "EDGE_SE2 7 8 1 0 0 0 0 0 0 0 0", "EDGE_RANGE 7 8 3 0"}) {
    const auto file = read_graph_lines({good + bad + "\n"});
    EXPECT_EQ(file.team.graph.relative_poses.size(), 3u) << bad;
    ASSERT_EQ(file.notes.size(), 1u) << bad;
    EXPECT_NE(file.notes[0].find("t.g2o: 1 line is left out; the first: t.g2o:6: "), std::string::npos)
        << file.notes[0];
  }
  // An edge to a pose that its robot does not have adds no pose.
  const auto unknown = read_graph_lines({good + edge(id('a', 1), id('a', 2), 1)});
  EXPECT_EQ(unknown.pose_names, whole.pose_names);
  EXPECT_EQ(unknown.notes.size(), 1u);
  expect_refusal([] { read_graph_lines({"hello\nworld\n"}); }, 1, "unknown tag 'hello'");
  expect_refusal([] { read_graph_lines({edge("0", "1", 1) + "x\ny\nz\n"}); }, 2, "unknown tag 'x'");
  expect_refusal([&] { read_graph_lines({good + "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n"}); }, 6,
                 "mixes 2D and 3D");
}

TEST(G2oWriter, KeepsGivenIds) {
  auto file = read_graph_lines({edge(id('b', 3), id('b', 4), 1)});
  const auto kept = with_ids(file.team.graph, file.pose_ids, {});
  EXPECT_EQ(std::to_string(kept.pose_ids[1]), id('b', 4));
  EXPECT_EQ(with_ids(file.team.graph, {}, {}).pose_ids[1], 1u);
  file.team.graph.points.emplace_back();
  EXPECT_EQ(std::to_string(with_ids(file.team.graph, file.pose_ids, {}).point_ids[0]), id('b', 5));
}

TEST(G2oTeam, SeesLandmarks) {
  const auto file =
      read_graph_lines({"VERTEX_XY 9 1 2\n" + edge("0", "1", 1) + "EDGE_SE2_XY 1 9 2 3 4 0 5\n"});
  ASSERT_EQ(file.team.graph.relative_points.size(), 1u);
  const auto& sighting = file.team.graph.relative_points[0];
  EXPECT_EQ(sighting.i, PoseId(1));
  EXPECT_EQ(sighting.j.point, PointId(0));
  EXPECT_EQ(sighting.position, Eigen::Vector2d(2, 3));
  EXPECT_EQ(sighting.information(1, 1), 5);
  EXPECT_EQ(file.team.graph.points[0], Eigen::Vector2d::Zero());
}

TEST(G2oTeam, RefusesFilesOfDifferentDimensions) {
  const std::vector<Text> texts{make_text("0.g2o", edge("0", "1", 1)),
                                make_text("1.g2o", "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\n")};
  expect_refusal([&] { read_g2o_team(texts); }, 1, "mix 2D and 3D");
}

TEST(G2oLandmarks, AreWrittenAsTheyAreRead) {
  const std::string plane = "VERTEX_SE2 0 0 0 0\nVERTEX_XY 9 1 2\nEDGE_SE2_XY 0 9 2 3 4 1 5\n";
  const std::string space =
      "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_TRACKXYZ 9 1 2 3\nPARAMS_SE3OFFSET 0 0 0 0 0 0 0 1\n"
      "EDGE_SE3_TRACKXYZ 0 9 0 2 3 4 1 0 0 1 0 1\n";
  for (const std::string& content : {plane, space})
    EXPECT_EQ(std::visit([](const auto& g) { return format_g2o(g); }, read_g2o(make_text("t.g2o", content))),
              content);
  expect_refusal([] { read_g2o(make_text("t", "VERTEX_SE2 0 0 0 0\nEDGE_SE2_XY 0 9 2 3 4 1 5\n")); }, 2,
                 "vertex 9 does not occur");
}

std::string compressed(const std::string& content) {
  std::string out(ZSTD_compressBound(content.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), content.data(), content.size(), 3));
  return out;
}

TEST(Zstd, DecompressesOneFrameOrSeveral) {
  const std::string content(300000, 'x');
  EXPECT_EQ(decompress_zstd("f", compressed(content)), content);
  EXPECT_EQ(decompress_zstd("f", compressed("one") + compressed("two")), "onetwo");
}

TEST(Zstd, RefusesInvalidTruncatedOrTooLargeData) {
  const std::string content(300000, 'x');
  const std::string bytes = compressed(content);
  expect_refusal([&] { decompress_zstd("f", "plain text, not compressed"); }, 0, "cannot be decompressed");
  expect_refusal([&] { decompress_zstd("f", bytes.substr(0, bytes.size() - 3)); }, 0, "truncated");
  expect_refusal([&] { decompress_zstd("f", ""); }, 0, "truncated");
  expect_refusal([&] { decompress_zstd("f", bytes, 299999); }, 0, "larger than 299999 bytes");
  EXPECT_EQ(decompress_zstd("f", bytes, 300000).size(), 300000u);
}

TEST(TeamGraphFile, IsRecognisedByItsName) {
  EXPECT_TRUE(is_graph_file("a/b.pyfg"));
  EXPECT_TRUE(is_graph_file("b.g2o.zst"));
  EXPECT_TRUE(is_graph_file("b.jrl"));
  EXPECT_FALSE(is_graph_file("b.zst"));
  EXPECT_FALSE(is_graph_file("mission"));
  const TemporaryFolder folder;
  const std::string content = edge("0", "1", 1);
  folder.write("0.g2o", content);
  folder.write("team.g2o.zst", compressed(content));
  folder.write("x.txt", "x");
  EXPECT_EQ(std::get<0>(read_team_graph(folder.path() / "0.g2o")).team.graph.poses.size(), 2u);
  EXPECT_EQ(std::get<0>(read_team_graph(folder.path() / "team.g2o.zst")).team.graph.poses.size(), 2u);
  EXPECT_EQ(std::get<0>(read_team_graph(folder.path())).team.segments.size(), 2u);  // a robot per file
  expect_refusal([&] { read_team_graph(folder.path() / "x.txt"); }, 0, "none of .g2o, .pyfg and .jrl");
  expect_refusal([&] { read_team_graph(folder.path() / "none.pyfg"); }, 0, "no such file");
  const TemporaryFolder empty;
  expect_refusal([&] { read_team_graph(empty.path()); }, 0, "no .g2o files");
}

struct KnownTeam {
  const char* name;
  const char* path;
  std::size_t poses, points, relative_poses, ranges, sightings, segments;
};

class PublishedTeam : public testing::TestWithParam<KnownTeam> {};

TEST_P(PublishedTeam, IsReadWhole) {
  const KnownTeam& known = GetParam();
  RADIOSLAM_RECORDED(path, known.path);
  const AnyTeamGraphFile any = read_team_graph(path);
  std::visit(
      [&](const auto& file) {
        const auto& graph = file.team.graph;
        EXPECT_EQ(graph.poses.size(), known.poses);
        EXPECT_EQ(graph.points.size(), known.points);
        EXPECT_EQ(graph.relative_poses.size(), known.relative_poses);
        EXPECT_EQ(graph.ranges.size(), known.ranges);
        EXPECT_EQ(graph.relative_points.size(), known.sightings);
        EXPECT_EQ(file.team.segments.size(), known.segments);
        for (const TrajectorySegment& segment : file.team.segments)
          EXPECT_TRUE(std::is_sorted(segment.stamps.begin(), segment.stamps.end()));
      },
      any);
}

INSTANTIATE_TEST_SUITE_P(
    Io, PublishedTeam,
    testing::Values(
        KnownTeam{"Tiers", "range_aided/tiers.pyfg.zst", 9768, 1, 9764, 7789, 0, 4},
        KnownTeam{"Mrclam6", "range_aided/mrclam6.pyfg.zst", 11274, 15, 11269, 3537, 13121, 5},
        KnownTeam{"Plaza1", "range_aided/plaza1.pyfg.zst", 9658, 4, 9657, 3326, 0, 1},
        KnownTeam{
            "Pcm4",
            "multirobot_pcm/test_data/pairwise_consistency_maximization/spoiled/simulation/example_4robots",
            84, 0, 128, 0, 0, 4},
        KnownTeam{
            "Pcm8",
            "multirobot_pcm/test_data/pairwise_consistency_maximization/spoiled/simulation/example_8robots",
            168, 0, 384, 0, 0, 8},
        KnownTeam{"Argos10", "multirobot_pcm/test_data/argos_simulation/clean/example_10robots", 1070, 0,
                  1370, 0, 0, 10}),
    [](const auto& instance) { return instance.param.name; });

/// Residuals of the ranges at the ground truth, 0.000 +- 0.040 m according to the source.
TEST(PublishedTeams, TiersRangesAgreeWithItsTruth) {
  RADIOSLAM_RECORDED(path, "range_aided/tiers.pyfg.zst");
  const auto file = std::get<TeamGraphFile<SE2>>(read_team_graph(path));
  const auto at = [&](const RangeEnd<SE2>& end) -> Eigen::Vector2d {
    return end.pose.valid() ? file.true_poses[end.pose.index()]->translation()
                            : file.true_points[end.point.index()];
  };
  double sum = 0, squares = 0;
  for (const auto& range : file.team.graph.ranges) {
    const double residual = range.range_m - (at(range.j) - at(range.i)).norm();
    sum += residual;
    squares += residual * residual;
  }
  const auto n = static_cast<double>(file.team.graph.ranges.size());
  EXPECT_NEAR(sum / n, 0, 0.001);
  EXPECT_NEAR(std::sqrt(squares / n), 0.040, 0.001);
}

TEST(PublishedTeams, ACorruptLineIsLeftOut) {
  RADIOSLAM_RECORDED(folder,
                     "multirobot_pcm/test_data/pairwise_consistency_maximization/spoiled/simulation/"
                     "example_2robots");
  const auto file = std::get<TeamGraphFile<SE3>>(read_team_graph(folder));
  EXPECT_EQ(file.team.graph.poses.size(), 42u);
  EXPECT_EQ(file.team.graph.relative_poses.size(), 60u);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_NE(file.notes[0].find("1 line is left out"), std::string::npos) << file.notes[0];
  EXPECT_NE(file.notes[0].find(":16: unknown tag '0410268'"), std::string::npos) << file.notes[0];
}

}  // namespace
}  // namespace radioslam
