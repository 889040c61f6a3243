// A team's graph in JRL: conventions of its numbers, labels and truth, and all errors.
#include "radioslam/io/graph/jrl.hpp"

#include <numbers>

#include "io/recorded_data.hpp"
#include "io/refusal.hpp"

namespace radioslam {
namespace {

std::string symbol(char robot, int place) {
  return std::to_string((std::uint64_t{static_cast<unsigned char>(robot)} << 56) +
                        static_cast<std::uint64_t>(place));
}

/// A covariance with this diagonal, in the order of the file.
std::string diagonal(const std::vector<double>& variances) {
  std::string list;
  for (std::size_t row = 0; row < variances.size(); ++row)
    for (std::size_t column = 0; column < variances.size(); ++column)
      list += (list.empty() ? "[" : ",") + std::to_string(row == column ? variances[row] : 0.0);
  return list + "]";
}

const std::string kCovariance = diagonal({0.01, 0.01, 0.04, 1, 1, 4});

std::string pose3(double x, const std::string& wxyz = "1,0,0,0") {
  return R"({"type":"Pose3","translation":[)" + std::to_string(x) + R"(,0,0],"rotation":[)" + wxyz + "]}";
}
std::string between_factor(const std::string& i, const std::string& j, const std::string& pose,
                           const std::string& covariance = kCovariance) {
  return R"({"type":"BetweenFactorPose3","key1":)" + i + R"(,"key2":)" + j + R"(,"measurement":)" + pose +
         R"(,"covariance":)" + covariance + "}";
}
std::string prior_factor(const std::string& at, const std::string& pose) {
  return R"({"type":"PriorFactorPose3","key":)" + at + R"(,"prior":)" + pose + R"(,"covariance":)" +
         kCovariance + "}";
}
std::string log_entry(const std::vector<std::string>& measurements) {
  std::string list;
  for (const std::string& measurement : measurements) list += (list.empty() ? "" : ",") + measurement;
  return R"({"stamp":1670403892357527704,"measurements":[)" + list + "]}";
}
/// Robot a's entries, and other members of the log.
std::string log_of(const std::vector<std::string>& entries, const std::string& others = "") {
  std::string list;
  for (const std::string& one : entries) list += (list.empty() ? "" : ",") + one;
  return R"({"name":"n","robots":[97,98],"measurements":{"a":[)" + list + "]}" + others + "}";
}

TeamGraphFile<SE3> read_space(const std::string& content) {
  return std::get<TeamGraphFile<SE3>>(read_jrl(make_text("t.jrl", content)));
}

/// Two poses of a, one of b, a loop before the odometry.
std::vector<std::string> small_team() {
  return {log_entry({between_factor(symbol('a', 1), symbol('b', 0), pose3(5))}), log_entry({}),
          log_entry({between_factor(symbol('a', 0), symbol('a', 1), pose3(1)),
                     between_factor(symbol('b', 0), symbol('a', 0), pose3(9))})};
}

TEST(Jrl, KeysAreRobotsAndPlaces) {
  const auto file = read_space(log_of(small_team()));
  ASSERT_EQ(file.team.segments.size(), 2u);
  EXPECT_EQ(file.team.segments[0].robot, "a");
  EXPECT_EQ(file.team.segments[0].pose_count, 2u);
  EXPECT_EQ(file.team.segments[0].stamps[1], Stamp::from_seconds(1));
  EXPECT_FALSE(file.team.segments[0].in_common_frame);
  EXPECT_EQ(file.pose_names, (std::vector<std::string>{symbol('a', 0), symbol('a', 1), symbol('b', 0)}));
  EXPECT_EQ(file.team.graph.poses[1].translation().x(), 1);
  EXPECT_EQ(file.team.graph.relative_poses[1].T_i_j.translation().x(), 5);
  EXPECT_TRUE(file.true_poses.empty());
  EXPECT_TRUE(file.labels.empty());
  EXPECT_TRUE(file.notes.empty());
}

TEST(Jrl, KeysWithoutLettersAreOfASingleRobot) {
  const std::string own = log_entry({between_factor("0", "1", pose3(1))});
  EXPECT_EQ(read_space(log_of({own})).team.segments.size(), 1u);
  const std::string two = R"({"measurements":{"a":[)" + own + R"(],"b":[)" + own + "]}}";
  expect_refusal([&] { read_space(two); }, 0, "the robots' letters are missing");
  const std::string mixed = log_entry(
      {between_factor("0", "1", pose3(1)), between_factor(symbol('b', 0), symbol('b', 1), pose3(1))});
  expect_refusal([&] { read_space(log_of({mixed})); }, 0, "key 0 has no robot's letter");
}

TEST(Jrl, QuaternionsBeginWithWAndCovariancesWithRotation) {
  std::string covariance = "[";
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) {
      const bool correlated = row + column == 5 && std::abs(row - column) == 5;  // rx with tz
      covariance +=
          (covariance == "[" ? "" : ",") + std::to_string(row == column ? row + 1.0 : 0.5 * correlated);
    }
  const auto file = read_space(log_of({log_entry(
      {between_factor(symbol('a', 0), symbol('a', 1), pose3(2, "0.6,0,0,0.8"), covariance + "]")})}));
  const RelativePoseFactor<SE3>& factor = file.team.graph.relative_poses[0];
  EXPECT_NEAR(factor.T_i_j.yaw(), 2 * std::atan2(0.8, 0.6), 1e-12);
  const SE3::Jacobian stated = factor.information.inverse();
  const SE3::Tangent variances = (SE3::Tangent() << 4, 5, 6, 1, 2, 3).finished();
  EXPECT_LT((stated.diagonal() - variances).norm(), 1e-9);
  EXPECT_NEAR(stated(2, 3), 0.5, 1e-9);
}

TEST(Jrl, LabelsFollowTheirFactorsIntoTheTeamsOrder) {
  const auto file = read_space(log_of(small_team(), R"(,"outlier_factors":{"a":[[0,0]]})"));
  EXPECT_EQ(file.labels, (std::vector<std::optional<bool>>{true, false, true}));
  EXPECT_EQ(file.team.graph.relative_poses[1].T_i_j.translation().x(), 5);
  const auto without = read_space(log_of(small_team(), R"(,"outlier_factors":{})"));
  EXPECT_EQ(without.labels, (std::vector<std::optional<bool>>{true, true, true}));
}

TEST(Jrl, GroundtruthIsByKeyAndMayLackPoses) {
  const std::string truth = R"(,"groundtruth":{"a":[{"key":)" + symbol('b', 0) + "," + pose3(7).substr(1) +
                            R"(,{"key":3,"type":"Point3"},{"key":)" + symbol('a', 1) + "," +
                            pose3(6).substr(1) + "]}";
  const auto file = read_space(log_of(small_team(), truth));
  ASSERT_EQ(file.true_poses.size(), 3u);
  EXPECT_FALSE(file.true_poses[0]);
  EXPECT_EQ(file.true_poses[1]->translation().x(), 6);
  EXPECT_EQ(file.true_poses[2]->translation().x(), 7);
}

TEST(Jrl, PriorsAreStartsOnRequest) {
  auto entries = small_team();
  entries.push_back(
      log_entry({prior_factor(symbol('a', 0), pose3(2)), prior_factor(symbol('b', 0), pose3(8))}));
  const auto unknown = read_space(log_of(entries));
  EXPECT_FALSE(unknown.team.segments[0].in_common_frame || unknown.team.segments[1].in_common_frame);
  EXPECT_EQ(unknown.notes.size(), 1u);
  const auto known =
      std::get<TeamGraphFile<SE3>>(read_jrl(make_text("t.jrl", log_of(entries)), StatedStarts::kUsed));
  EXPECT_TRUE(known.team.segments[0].in_common_frame && known.team.segments[1].in_common_frame);
  EXPECT_EQ(known.team.graph.poses[1].translation().x(), 3);
  EXPECT_EQ(known.team.graph.poses[2].translation().x(), 8);
}

TEST(Jrl, OtherTypesAreSkippedWithANote) {
  const auto file = read_space(log_of({log_entry({R"({"type":"StereoFactorPose3Point3"})",
                                                  between_factor(symbol('a', 0), symbol('a', 1), pose3(1)),
                                                  R"({"type":"StereoFactorPose3Point3"})"})},
                                      R"(,"outlier_factors":{"a":[[0,1],[0,2]]})"));
  EXPECT_EQ(file.notes,
            std::vector<std::string>{"t.jrl: 2 measurements of type StereoFactorPose3Point3 are not used"});
  EXPECT_EQ(file.labels, std::vector<std::optional<bool>>{false});
}

TEST(Jrl, RangesAreBetweenPoses) {
  const auto file =
      read_space(log_of({log_entry({between_factor(symbol('a', 0), symbol('a', 1), pose3(1)),
                                    R"({"type":"RangeFactorPose3","key1":)" + symbol('a', 1) + R"(,"key2":)" +
                                        symbol('b', 4) + R"(,"measurement":3.5,"covariance":[0.25]})"})}));
  ASSERT_EQ(file.team.graph.ranges.size(), 1u);
  EXPECT_EQ(file.team.graph.ranges[0].j.pose, PoseId(2));
  EXPECT_EQ(file.team.graph.ranges[0].range_m, 3.5);
  EXPECT_EQ(file.team.graph.ranges[0].sigma_m, 0.5);
}

TEST(Jrl, ReadsThePlaneInItsOwnOrder) {
  const std::string measurement = R"({"type":"BetweenFactorPose2","key1":0,"key2":1,"measurement":)"
                                  R"({"type":"Pose2","x":1,"y":2,"theta":0.5},"covariance":)" +
                                  diagonal({1, 2, 4}) + "}";
  const auto file =
      std::get<TeamGraphFile<SE2>>(read_jrl(make_text("t.jrl", log_of({log_entry({measurement})}))));
  const RelativePoseFactor<SE2>& factor = file.team.graph.relative_poses[0];
  EXPECT_EQ(factor.T_i_j.translation(), Eigen::Vector2d(1, 2));
  EXPECT_NEAR(factor.T_i_j.angle(), 0.5, 1e-12);
  EXPECT_LT((factor.information.diagonal() - Eigen::Vector3d(1, 0.5, 0.25)).norm(), 1e-12);
}

struct MalformedLog {
  const char* name;
  std::string content;
  std::size_t line;
  std::string words;
};
void PrintTo(const MalformedLog& malformed, std::ostream* out) { *out << malformed.name; }

class MalformedJrl : public testing::TestWithParam<MalformedLog> {};

TEST_P(MalformedJrl, IsRefusedWithItsPlace) {
  const MalformedLog& malformed = GetParam();
  expect_refusal([&] { read_jrl(make_text("t.jrl", malformed.content)); }, malformed.line, malformed.words);
}

const std::string kFirst = symbol('a', 0), kSecond = symbol('a', 1);
std::string with_measurement(const std::string& measurement) {
  return log_of({log_entry({}), log_entry({measurement})});
}

INSTANTIATE_TEST_SUITE_P(
    Io, MalformedJrl,
    testing::Values(
        MalformedLog{"NotJson", "{\n\"measurements\": {\"a\": [}\n", 2, "not valid JSON"},
        MalformedLog{"HugeNumber", with_measurement(between_factor(kFirst, kSecond, pose3(1), "[1e999]")), 0,
                     "too large"},
        MalformedLog{"NotALog", "[1, 2]", 0, "expected an object"},
        MalformedLog{"NoMeasurements", R"({"name":"x"})", 0, "'measurements' is missing"},
        MalformedLog{"MeasurementsList", R"({"measurements":[]})", 0, "'measurements' is not an object"},
        MalformedLog{"EntriesObject", R"({"measurements":{"a":{}}})", 0, "of robot a are not a list"},
        MalformedLog{"Empty", log_of({log_entry({})}), 0, "no measurements of poses"},
        MalformedLog{"NoType", with_measurement("{}"), 0,
                     "measurement 0 of entry 1 of robot a: 'type' is missing"},
        MalformedLog{"NegativeKey", with_measurement(between_factor("-1", kSecond, pose3(1))), 0,
                     "'key1' is not a key"},
        MalformedLog{"FractionalKey", with_measurement(between_factor(kFirst, "1.5", pose3(1))), 0,
                     "'key2' is not a key"},
        MalformedLog{"Itself", with_measurement(between_factor(kFirst, kFirst, pose3(1))), 0,
                     "an edge from a pose to itself"},
        MalformedLog{"NoPose", with_measurement(between_factor(kFirst, kSecond, "3")), 0,
                     "'measurement': expected an object"},
        MalformedLog{
            "PlanePose",
            with_measurement(between_factor(kFirst, kSecond, R"({"type":"Pose2","x":1,"y":2,"theta":0})")), 0,
            "its type is not Pose3"},
        MalformedLog{"ShortQuaternion", with_measurement(between_factor(kFirst, kSecond, pose3(1, "1,0,0"))),
                     0, "'rotation' is not a list of 4 numbers"},
        MalformedLog{"LongQuaternion", with_measurement(between_factor(kFirst, kSecond, pose3(1, "1,1,0,0"))),
                     0, "norm is 1.41"},
        MalformedLog{"FarAway", with_measurement(between_factor(kFirst, kSecond, pose3(1e9))), 0,
                     "'translation' is not plausible"},
        MalformedLog{"SmallCovariance",
                     with_measurement(between_factor(kFirst, kSecond, pose3(1), "[1,0,0,1]")), 0,
                     "not a list of 36 numbers"},
        MalformedLog{
            "Indefinite",
            with_measurement(between_factor(kFirst, kSecond, pose3(1), diagonal({1, 1, 1, 1, 1, -1}))), 0,
            "not positive definite"},
        MalformedLog{"MixedDimensions",
                     log_of({log_entry({between_factor(kFirst, kSecond, pose3(1)),
                                        R"({"type":"PriorFactorPose2"})"})}),
                     0, "mixes 2D and 3D"},
        MalformedLog{"UnknownOutlier", log_of(small_team(), R"(,"outlier_factors":{"a":[[1,0]]})"), 0,
                     "measurement 0 of entry 1 of robot a, which does not exist"},
        MalformedLog{"OutlierShape", log_of(small_team(), R"(,"outlier_factors":{"a":[3]})"), 0,
                     "is not [entry, measurement]"},
        MalformedLog{"TruthShape", log_of(small_team(), R"(,"groundtruth":{"a":[3]})"), 0,
                     "the groundtruth of robot a: expected an object"}),
    [](const auto& instance) { return std::string(instance.param.name); });

/// Loops within robots, between them, and how many of either are wrong: as the source states but for one
/// loop.
struct CosmoSet {
  const char* name;
  std::size_t poses, within, wrong_within, between, wrong_between;
};

class Cosmo : public testing::TestWithParam<CosmoSet> {};

TEST_P(Cosmo, HasTheLoopsAndLabelsOfItsSource) {
  const CosmoSet& known = GetParam();
  RADIOSLAM_RECORDED(path, "cosmo/" + std::string(known.name) + ".jrl.zst");
  const auto file = std::get<TeamGraphFile<SE3>>(read_team_graph(path));
  EXPECT_EQ(file.team.graph.poses.size(), known.poses);
  EXPECT_EQ(file.team.segments.size(), 3u);
  EXPECT_EQ(file.true_poses.size(), known.poses);
  ASSERT_EQ(file.labels.size(), file.team.graph.relative_poses.size());
  const auto segment = [&](PoseId pose) {
    std::size_t s = 0;
    while (pose.index() >= file.team.segments[s].first_pose + file.team.segments[s].pose_count) ++s;
    return s;
  };
  std::size_t within = 0, wrong_within = 0, between_robots = 0, wrong_between = 0;
  for (std::size_t f = known.poses - 3; f < file.labels.size(); ++f) {
    const auto& factor = file.team.graph.relative_poses[f];
    const bool same = segment(factor.i) == segment(factor.j), wrong = !*file.labels[f];
    ++(same ? within : between_robots);
    (same ? wrong_within : wrong_between) += wrong ? 1u : 0u;
  }
  EXPECT_EQ(within, known.within);
  EXPECT_EQ(wrong_within, known.wrong_within);
  EXPECT_EQ(between_robots, known.between);
  EXPECT_EQ(wrong_between, known.wrong_between);
}

/// True loops agree with the truth to 1 m (the source), wrong ones of 20 m and more tell a turned convention.
TEST_P(Cosmo, TrueLoopsAgreeWithTheTruth) {
  RADIOSLAM_RECORDED(path, "cosmo/" + std::string(GetParam().name) + ".jrl.zst");
  const auto file = std::get<TeamGraphFile<SE3>>(read_team_graph(path));
  for (std::size_t f = 0; f < file.labels.size(); ++f) {
    const auto& factor = file.team.graph.relative_poses[f];
    const SE3 T_i_j = file.true_poses[factor.i.index()]->inverse() * *file.true_poses[factor.j.index()];
    const double error_m = (factor.T_i_j.inverse() * T_i_j).translation().norm();
    EXPECT_TRUE(error_m < 2 || !*file.labels[f]) << f << ": " << error_m << " m";
  }
}

INSTANTIATE_TEST_SUITE_P(Io, Cosmo,
                         testing::Values(CosmoSet{"kth_r3_00_d06_d09_d10_wifi", 1604, 432, 52, 231, 20},
                                         CosmoSet{"kth_r3_00_d06_d09_d10_proradio", 1604, 432, 52, 845, 67},
                                         CosmoSet{"ntu_r3_02_d02_n04_n13_wifi", 1417, 714, 30, 26, 0},
                                         CosmoSet{"ntu_r3_02_d02_n04_n13_proradio", 1417, 714, 30, 194, 5}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace radioslam
