#include "radioslam/graph/distributed/message.hpp"

#include <functional>

#include "graph/small_teams.hpp"
#include "radioslam/base/wire.hpp"
#include "radioslam/graph/distributed/alternating.hpp"
#include "radioslam/graph/distributed/block_coordinate.hpp"
#include "radioslam/graph/distributed/separators.hpp"
#include "radioslam/graph/distributed/two_stage.hpp"

namespace radioslam {
namespace {

/// A message with every section.
template <class Pose>
Message<Pose> draw_message(std::uint64_t seed) {
  test::Drawing<Pose> draw(seed);
  constexpr std::size_t kSeen = 3;
  constexpr Eigen::Index kRows = 2 * Pose::kDof;
  Message<Pose> message;
  message.from = 3;
  message.to = 200;
  message.round = 70'000;
  message.topology = {{0, 2, {1, 300}}, {1, 0, {}}};
  message.seen.emplace();
  message.seen->tree = 1234567890123;
  message.seen->frames = {{3, 0, 0}, {0, 1, 5}};
  message.seen->part_of = {0, 1, 0};
  for (std::size_t k = 0; k < kSeen; ++k) {
    message.seen->poses.push_back(draw.pose(100, 2));
    message.matrices.push_back(draw.template information<Pose::kDim>());
    message.steps.push_back(draw.tangent(1, 1));
  }
  message.up.emplace();
  message.up->tree = ~std::uint64_t{0} >> 2U;
  message.up->sweep = 9;
  message.up->cost = 1.25;
  message.up->predicted_decrease = -0.5;
  message.up->gradient = Eigen::VectorXd::LinSpaced(kRows, -1, 1);
  message.up->shared = {{{3, 1}, kUnknownRobot}, {{7, 500}, 2}};
  message.up->information.emplace(draw.template information<kRows>(), Pose::kDof);
  message.down.emplace();
  message.down->tree = 77;
  message.down->sweep = 9;
  message.down->end = SweepEnd::kRestore;
  message.down->relinearise = false;
  message.down->damping = 1e-3;
  message.down->mu = 0.01;
  message.down->steps = Eigen::VectorXd::LinSpaced(5, 0, 2);
  message.stage = StageNews{4, 3, true, false};
  return message;
}

template <class Pose>
void expect_same(const Message<Pose>& a, const Message<Pose>& b) {
  EXPECT_EQ(std::tuple(a.from, a.to, a.round), std::tuple(b.from, b.to, b.round));
  EXPECT_EQ(a.topology, b.topology);
  EXPECT_EQ(a.stage, b.stage);
  EXPECT_EQ(a.matrices, b.matrices);
  EXPECT_EQ(a.steps, b.steps);
  ASSERT_EQ(a.seen.has_value(), b.seen.has_value());
  if (a.seen) {
    EXPECT_EQ(a.seen->tree, b.seen->tree);
    EXPECT_EQ(a.seen->part_of, b.seen->part_of);
    ASSERT_EQ(a.seen->frames.size(), b.seen->frames.size());
    for (std::size_t k = 0; k < a.seen->frames.size(); ++k) {
      EXPECT_TRUE(a.seen->frames[k].same(b.seen->frames[k]));
      EXPECT_EQ(a.seen->frames[k].hops, b.seen->frames[k].hops);
    }
    ASSERT_EQ(a.seen->poses.size(), b.seen->poses.size());
    for (std::size_t k = 0; k < a.seen->poses.size(); ++k)
      EXPECT_LT((a.seen->poses[k].inverse() * b.seen->poses[k]).log().norm(), 1e-12);
  }
  ASSERT_EQ(a.up.has_value(), b.up.has_value());
  if (a.up) {
    EXPECT_EQ(std::tuple(a.up->tree, a.up->sweep, a.up->cost, a.up->predicted_decrease),
              std::tuple(b.up->tree, b.up->sweep, b.up->cost, b.up->predicted_decrease));
    EXPECT_EQ(a.up->gradient, b.up->gradient);
    EXPECT_EQ(a.up->shared, b.up->shared);
    ASSERT_EQ(a.up->information.has_value(), b.up->information.has_value());
    if (a.up->information) {
      const Eigen::MatrixXd there = a.up->information->dense();
      EXPECT_LT((there - b.up->information->dense()).norm(), 1e-5 * there.norm());
    }
  }
  ASSERT_EQ(a.down.has_value(), b.down.has_value());
  if (a.down) {
    EXPECT_EQ(std::tuple(a.down->tree, a.down->sweep, a.down->end, a.down->relinearise, a.down->damping,
                         a.down->mu),
              std::tuple(b.down->tree, b.down->sweep, b.down->end, b.down->relinearise, b.down->damping,
                         b.down->mu));
    EXPECT_EQ(a.down->steps, b.down->steps);
  }
}

/// Block-coordinate descent tells where its momentum leads, so only their number is compared.
template <class Pose>
std::vector<Pose> solver_values(const RobotGraph<Pose>& robot, const Message<Pose>& message,
                                const DistributedSolver<Pose>& solver) {
  const auto& seen = robot.neighbours[neighbour_index(robot, message.to)].seen;
  EXPECT_EQ(message.seen->poses.size(), seen.size());
  std::vector<Pose> values;
  for (const std::uint32_t pose : seen) values.push_back(solver.poses()[pose]);
  return values;
}

template <class Pose>
class Messages : public testing::Test {};
TYPED_TEST_SUITE(Messages, test::PoseTypes);

// ---- bytes ----

TYPED_TEST(Messages, SurviveARoundTrip) {
  const auto whole = draw_message<TypeParam>(1);
  MessageBytes bytes;
  const std::string encoded = encode(whole, &bytes);
  std::size_t counted = bytes.header;
  for (const std::size_t section : bytes.sections) {
    EXPECT_GT(section, 0u);
    counted += section;
  }
  EXPECT_EQ(counted, encoded.size());
  const auto decoded = decode<TypeParam>(encoded);
  ASSERT_TRUE(decoded);
  expect_same(whole, *decoded);
}

TYPED_TEST(Messages, SurviveARoundTripSectionBySection) {
  const auto whole = draw_message<TypeParam>(2);
  for (int section = -1; section < 8; ++section) {
    Message<TypeParam> message;
    message.from = 1;
    if (section == 0) message.topology = whole.topology;
    if (section == 1) message.seen = whole.seen;
    if (section == 2) message.matrices = whole.matrices;
    if (section == 3) message.steps = whole.steps;
    if (section == 4) message.up = whole.up;
    if (section == 5) message.down = whole.down;
    if (section == 6) message.stage = whole.stage;
    if (section == 7) {
      message.up = whole.up;
      message.up->information.reset();
      message.up->shared.clear();
    }
    const auto decoded = decode<TypeParam>(encode(message));
    ASSERT_TRUE(decoded) << section;
    expect_same(message, *decoded);
  }
}

TYPED_TEST(Messages, RotationsNearAHalfTurnSurvive) {
  Message<TypeParam> message;
  message.seen.emplace().frames.resize(1);
  for (const double angle : {M_PI, -M_PI, M_PI - 1e-9, 1e-9}) {
    typename TypeParam::Tangent xi = TypeParam::Tangent::Zero();
    xi[TypeParam::kDof - 1] = angle;
    message.seen->poses.push_back(TypeParam::exp(xi));
  }
  const auto decoded = decode<TypeParam>(encode(message));
  ASSERT_TRUE(decoded);
  expect_same(message, *decoded);
}

TYPED_TEST(Messages, AreRefusedWhereTheyEndEarlyOrLate) {
  const std::string bytes = encode(draw_message<TypeParam>(3));
  std::set<std::size_t> ends;  // of sections, where a shorter message is one as well
  for (std::size_t size = 0; size < bytes.size(); ++size)
    if (const auto decoded = decode<TypeParam>(std::string_view(bytes).substr(0, size))) ends.insert(size);
  EXPECT_LE(ends.size(), kSectionKinds);
  EXPECT_FALSE(decode<TypeParam>(bytes + '\0'));
  EXPECT_FALSE(decode<TypeParam>(bytes + bytes));
}

TYPED_TEST(Messages, OfAnotherVersionOrDimensionAreRefused) {
  std::string bytes = encode(draw_message<TypeParam>(4));
  using Other = std::conditional_t<TypeParam::kDim == 2, SE3, SE2>;
  EXPECT_FALSE(decode<Other>(bytes));
  bytes[2] = kWireVersion + 1;
  EXPECT_FALSE(decode<TypeParam>(bytes));
  bytes[2] = kWireVersion;
  bytes[0] = 'X';
  EXPECT_FALSE(decode<TypeParam>(bytes));
}

TYPED_TEST(Messages, WithNumbersThatAreNoneAreRefused) {
  for (const double none : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    auto message = draw_message<TypeParam>(5);
    message.up->cost = none;
    EXPECT_FALSE(decode<TypeParam>(encode(message)));
    message = draw_message<TypeParam>(5);
    message.down->steps[1] = none;
    EXPECT_FALSE(decode<TypeParam>(encode(message)));
    message = draw_message<TypeParam>(5);
    message.steps[0][0] = none;
    EXPECT_FALSE(decode<TypeParam>(encode(message)));
  }
}

/// Whatever is claimed, nothing is allocated for more than the bytes can hold: 2^40 items would not fit.
TYPED_TEST(Messages, ClaimsBeyondTheirBytesAreRefused) {
  for (int kind = 0; kind < 256; ++kind)
    for (const std::uint64_t claim : {std::uint64_t{1} << 40U, std::uint64_t{1} << 62U, std::uint64_t{30}}) {
      WireWriter content;
      if (kind == static_cast<int>(SectionKind::kUp)) {
        content.append(std::string(2, '\0'));   // tree, sweep
        content.append(std::string(16, '\0'));  // cost, decrease
      }
      if (kind == static_cast<int>(SectionKind::kFrames)) content.whole(0);
      if (kind == static_cast<int>(SectionKind::kDown)) content.append(std::string(4 + 16, '\0'));
      content.whole(claim);
      WireWriter out;
      out.append("RS");
      out.byte(kWireVersion);
      out.byte(TypeParam::kDim);
      for (int k = 0; k < 3; ++k) out.whole(1);
      out.byte(static_cast<std::uint8_t>(kind));
      out.whole(content.size());
      out.append(content.bytes());
      EXPECT_FALSE(decode<TypeParam>(out.bytes())) << kind;
      WireWriter section;
      section.append("RS");
      section.byte(kWireVersion);
      section.byte(TypeParam::kDim);
      for (int k = 0; k < 3; ++k) section.whole(1);
      section.byte(static_cast<std::uint8_t>(kind));
      section.whole(claim);
      EXPECT_FALSE(decode<TypeParam>(section.bytes())) << kind;
    }
}

TYPED_TEST(Messages, ThatShareMorePosesThanATeamMayAreRefused) {
  Message<TypeParam> message;
  message.up.emplace().gradient = Eigen::VectorXd::Zero(1024 * TypeParam::kDof);
  EXPECT_TRUE(decode<TypeParam>(encode(message)));
  message.up->gradient = Eigen::VectorXd::Zero(1025 * TypeParam::kDof);
  EXPECT_FALSE(decode<TypeParam>(encode(message)));
  message.up->gradient = Eigen::VectorXd::Zero(TypeParam::kDof + 1);
  EXPECT_FALSE(decode<TypeParam>(encode(message)));
}

/// 211 kB once made their receiver hold 600 MB.
TYPED_TEST(Messages, CostTheirReceiverWhatTheyHold) {
  Message<TypeParam> message;
  message.up.emplace().gradient = Eigen::VectorXd::Zero(1024 * TypeParam::kDof);
  message.up->shared.resize(1024);
  message.up->information.emplace(BlockInformation::Form::kMatrix, 1024, TypeParam::kDof);
  const auto decoded = decode<TypeParam>(encode(message));
  ASSERT_TRUE(decoded && decoded->up->information);
  EXPECT_TRUE(decoded->up->information->places().empty());
}

TYPED_TEST(Messages, AboutMoreRobotsThanATeamHasAreRefused) {
  Message<TypeParam> message;
  message.topology = {{kMaxRobots - 1, 0, {0, kMaxRobots - 2}}};
  EXPECT_TRUE(decode<TypeParam>(encode(message)));
  for (const RobotLinks& links : {RobotLinks{kMaxRobots, 0, {0}}, RobotLinks{0, 0, {kMaxRobots}},
                                  RobotLinks{0, 0, {2, 1}}, RobotLinks{0, 0, {1, 1}}}) {
    message.topology = {links};
    EXPECT_FALSE(decode<TypeParam>(encode(message)));
  }
  message.topology.assign(kMaxRobots + 1, {0, 0, {}});
  EXPECT_FALSE(decode<TypeParam>(encode(message)));
}

// ---- garbage ----

/// A message's bytes with some of them changed, the addresses left alone so that the solvers look further.
std::string spoil(Rng& rng, std::string bytes) {
  const std::size_t begin = 7;
  if (bytes.size() <= begin) return bytes;
  for (std::size_t k = 1 + rng.below(4); k > 0; --k) {
    const std::size_t at = begin + rng.below(bytes.size() - begin);
    bytes[at] = rng.uniform() < 0.5 ? static_cast<char>(bytes[at] ^ (1 << rng.below(8)))
                                    : static_cast<char>(rng.below(256));
  }
  return bytes;
}

TYPED_TEST(Messages, RandomBytesAreRefusedOrHarmless) {
  Rng rng(6);
  const std::string whole = encode(draw_message<TypeParam>(6));
  std::size_t refused = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    std::string random(rng.below(200), '\0');
    for (char& c : random) c = static_cast<char>(rng.below(256));
    if (trial % 2 == 0) random = whole.substr(0, 7) + random;
    refused += !decode<TypeParam>(random);
    if (const auto spoilt = decode<TypeParam>(spoil(rng, whole))) {
      const auto again = decode<TypeParam>(encode(*spoilt));
      ASSERT_TRUE(again) << "what was read can be written";
    }
  }
  EXPECT_GT(refused, 3900u);
}

template <class Pose>
using MakeSolver = std::function<std::unique_ptr<DistributedSolver<Pose>>(const RobotGraph<Pose>&)>;

template <class Pose>
std::vector<std::pair<std::string, MakeSolver<Pose>>> all_solvers() {
  SeparatorsParams repeating;
  repeating.repeat_after = 2;
  repeating.lost_after = 9;
  repeating.outliers.gate = 28;
  return {
      {"separators",
       [](const auto& r) { return std::make_unique<SeparatorsSolver<Pose>>(r, SeparatorsParams{}); }},
      {"asynchronous", [=](const auto& r) { return std::make_unique<SeparatorsSolver<Pose>>(r, repeating); }},
      {"block",
       [](const auto& r) {
         return std::make_unique<BlockCoordinateSolver<Pose>>(r, BlockCoordinateParams{});
       }},
      {"stages", [](const auto& r) { return std::make_unique<TwoStageSolver<Pose>>(r, TwoStageParams{}); }},
      {"alternating",
       [](const auto& r) { return std::make_unique<AlternatingSolver<Pose>>(r, AlternatingParams{}); }}};
}

/// Beside every message of a run, some with other bytes, as a robot might send that lies or is broken.
TYPED_TEST(Messages, SpoiltOnesDoNotHarmASolver) {
  const auto team = test::cut(test::draw_team<TypeParam>(7, 3, 4, 1), 2, 1);
  for (const auto& [name, make] : all_solvers<TypeParam>()) {
    SCOPED_TRACE(name);
    std::size_t spoilt = 0;
    for (const std::uint64_t seed : {0u, 1u, 2u, 3u, 4u, 5u}) {
      Rng rng(seed);
      std::vector<std::unique_ptr<DistributedSolver<TypeParam>>> solvers;
      for (const auto& robot : split_by_robot(team.graph, team.poses)) solvers.push_back(make(robot));
      std::vector<std::vector<Message<TypeParam>>> inbox(solvers.size());
      for (int round = 0; round < 20; ++round) {
        std::vector<std::vector<Message<TypeParam>>> next(solvers.size());
        for (std::size_t r = 0; r < solvers.size(); ++r)
          for (const auto& message : solvers[r]->round(inbox[r])) {
            const std::string bytes = encode(message);
            const auto send = [&](std::string_view sent) {
              auto decoded = decode<TypeParam>(sent);
              if (decoded && decoded->to < solvers.size()) next[decoded->to].push_back(std::move(*decoded));
              return decoded.has_value();
            };
            // Without lies in the first rounds the solvers get further.
            const bool lies = round >= static_cast<int>(seed) * 2;
            for (int k = 0; lies && k < 6; ++k) spoilt += send(spoil(rng, bytes));
            send(bytes);
            for (int k = 0; lies && k < 6; ++k) spoilt += send(spoil(rng, bytes));
          }
        inbox = std::move(next);
      }
    }
    EXPECT_GT(spoilt, 100u);
  }
}

TYPED_TEST(Messages, FromStrangersAreRefusedAndCounted) {
  const auto team = test::draw_team<TypeParam>(8, 3, 4, 1);
  const auto robots = split_by_robot(team.graph, team.poses);
  for (const auto& [name, make] : all_solvers<TypeParam>()) {
    const auto solver = make(robots[0]);
    auto message = draw_message<TypeParam>(8);
    for (const RobotNumber from : {0u, 2u, 3u, kUnknownRobot}) {
      message.from = from;
      const std::size_t before = solver->refused();
      solver->round({message});
      EXPECT_EQ(solver->refused(), before + 1) << name;
    }
    message.from = 1;  // a neighbour, with poses that do not fit
    const std::size_t before = solver->refused();
    if (name == "asynchronous") continue;  // poses for another team are late, not wrong
    solver->round({message});
    EXPECT_EQ(solver->refused(), before + 1) << name;
  }
}

/// A child that lies about what it shares: everything else is as it should be.
TYPED_TEST(Messages, EliminationsThatDoNotFitDoNotHarmTheSweeps) {
  const auto team = test::draw_team<TypeParam>(9, 2, 4, 1);
  using Lie = std::function<void(Elimination&)>;
  const std::vector<Lie> lies{
      [](Elimination& up) {
        up.shared.clear();
        up.gradient.resize(0);
        up.information.emplace(Eigen::MatrixXd(0, 0), TypeParam::kDof);
      },
      [](Elimination& up) {
        for (auto& pose : up.shared) pose = {{1, 99}, 1};
      },
      [](Elimination& up) {
        up.shared.push_back({{1, 50}, 1});
        up.gradient = Eigen::VectorXd::Ones(up.gradient.size() + TypeParam::kDof);
        const auto n = up.gradient.size();
        up.information.emplace(Eigen::MatrixXd::Identity(n, n), TypeParam::kDof);
      },
      [](Elimination& up) { up.information.emplace(-up.information->dense(), TypeParam::kDof); },
      [](Elimination& up) { up.gradient *= 1e200; },
      [](Elimination& up) { std::swap(up.shared.front(), up.shared.back()); }};
  for (const Lie& lie : lies)
    for (const int from_sweep : {0, 1, 2, 3}) {
      std::vector<std::unique_ptr<DistributedSolver<TypeParam>>> solvers;
      for (const auto& robot : split_by_robot(team.graph, team.poses))
        solvers.push_back(std::make_unique<SeparatorsSolver<TypeParam>>(robot, SeparatorsParams{}));
      std::vector<std::vector<Message<TypeParam>>> inbox(2);
      Elimination last;
      for (int round = 0; round < 20; ++round) {
        std::vector<std::vector<Message<TypeParam>>> next(2);
        for (std::size_t r = 0; r < 2; ++r)
          for (auto& message : solvers[r]->round(inbox[r])) {
            if (message.up && message.up->information) last = *message.up;
            if (message.up && message.up->sweep >= static_cast<std::uint32_t>(from_sweep)) {
              message.up->shared = last.shared;
              message.up->information = last.information;
              lie(*message.up);
            }
            next[message.to].push_back(std::move(message));
          }
        inbox = std::move(next);
      }
      for (const auto& solver : solvers) EXPECT_EQ(solver->poses().size(), 4u);
    }
}

// ---- what a message is about ----

/// Poses in factors between robots of a set and robots outside it.
template <class Pose>
std::set<PoseKey> between(const test::SmallTeam<Pose>& team, const std::set<RobotNumber>& inside) {
  std::set<PoseKey> keys;
  const auto key = [&](PoseId p) {
    const RobotNumber robot = team.poses.robot_of[p.index()];
    const auto& own = team.poses.poses[robot];
    return PoseKey{robot,
                   static_cast<std::uint32_t>(std::find(own.begin(), own.end(), p.index()) - own.begin())};
  };
  for (const auto& f : team.graph.relative_poses)
    if (inside.contains(key(f.i).robot) != inside.contains(key(f.j).robot)) keys.insert({key(f.i), key(f.j)});
  return keys;
}

TYPED_TEST(Messages, HoldWhatConcernsThePosesBetweenTheirRobots) {
  for (const auto& meetings : {test::chain_of(5), test::ring_of(5), test::all_of(5)}) {
    const auto team = test::draw_team<TypeParam>(10, 5, 7, 1, meetings);
    std::map<RobotNumber, RobotLinks> links;
    for (const auto& robot : split_by_robot(team.graph, team.poses)) {
      links[robot.robot].robot = robot.robot;
      for (const NeighbourRobot& n : robot.neighbours) links[robot.robot].neighbours.push_back(n.robot);
    }
    const TeamTree tree(links);
    for (const auto& [solver_name, make] : all_solvers<TypeParam>()) {
      const std::string name = solver_name;
      SCOPED_TRACE(name);
      std::map<RobotNumber, Eigen::Index> shared;  // rows, as the robot's last elimination has them
      std::size_t ups = 0, downs = 0;
      const auto check = [&](const RobotGraph<TypeParam>& robot, const auto& solver,
                             const Message<TypeParam>& sent) {
        const auto decoded = decode<TypeParam>(encode(sent));
        ASSERT_TRUE(decoded);
        Message<TypeParam> message = *decoded;
        ASSERT_TRUE(links[message.from].links_to(message.to));
        for (const RobotLinks& l : message.topology) EXPECT_EQ(l.neighbours, links[l.robot].neighbours);
        if (message.up) {
          ++ups;
          EXPECT_EQ(tree.parent(message.from), message.to);
          std::set<RobotNumber> subtree;
          for (RobotNumber r = 0; r < 5; ++r)
            if (tree.common_ancestor(r, message.from) == message.from) subtree.insert(r);
          const auto separators = between(team, subtree);
          std::set<PoseKey> keys;
          for (const SharedPose& pose : message.up->shared) {
            EXPECT_TRUE(separators.contains(pose.key)) << pose.key.robot << ":" << pose.key.pose;
            EXPECT_TRUE(keys.insert(pose.key).second) << "twice";
          }
          if (message.up->information) shared[message.from] = message.up->gradient.size();
          EXPECT_EQ(message.up->gradient.size(), shared[message.from]);
          EXPECT_LE(message.up->gradient.size(),
                    static_cast<Eigen::Index>(separators.size()) * TypeParam::kDof);
        }
        if (message.down) {
          ++downs;
          EXPECT_EQ(tree.parent(message.to), message.from);
          EXPECT_EQ(message.down->steps.size(), shared[message.to]);
        }
        message.up.reset();
        message.down.reset();
        if (name == "block") message.seen->poses = solver_values(robot, message, solver);
        test::expect_about_poses_seen(robot, solver, message);
      };
      test::for_each_message(team, 30, make, check);
      EXPECT_EQ(ups > 0, name == "separators" || name == "asynchronous");
      EXPECT_EQ(downs > 0, ups > 0);
    }
  }
}

}  // namespace
}  // namespace radioslam
