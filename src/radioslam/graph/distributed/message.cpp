#include "radioslam/graph/distributed/message.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "radioslam/base/wire.hpp"
#include "radioslam/graph/distributed/information_code.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kReal = 8;
/// More poses shared by a subtree are refused: what is left of them may be dense where they meet.
constexpr Eigen::Index kMaxSharedPoses = 1024;

// ---- poses and numbers ----

void write(WireWriter& out, const SE2& pose) {
  out.f64(pose.translation().x());
  out.f64(pose.translation().y());
  out.f64(pose.angle());
}
/// The rotation as the vector part of its quaternion with w >= 0, and w, which that part tells badly near a
/// half turn.
void write(WireWriter& out, const SE3& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  for (const double x :
       {pose.translation().x(), pose.translation().y(), pose.translation().z(), q.x(), q.y(), q.z(), q.w()})
    out.f64(x);
}
void read(WireReader& in, SE2& pose) {
  const double x = in.f64(), y = in.f64(), angle = in.f64();
  pose = SE2({x, y}, angle);
}
void read(WireReader& in, SE3& pose) {
  std::array<double, 7> v{};
  for (double& x : v) x = in.f64();
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1) > 1e-6) return in.refuse();
  pose = SE3({v[0], v[1], v[2]}, q);
}
template <class Pose>
constexpr std::size_t kPoseBytes = kReal*(Pose::kDim == 2 ? 3 : 7);

template <class Derived>
void write(WireWriter& out, const Eigen::MatrixBase<Derived>& matrix) {
  for (Eigen::Index c = 0; c < matrix.cols(); ++c)
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) out.f64(matrix(r, c));
}
template <class Derived>
void read(WireReader& in, Eigen::MatrixBase<Derived>& matrix) {
  for (Eigen::Index c = 0; c < matrix.cols(); ++c)
    for (Eigen::Index r = 0; r < matrix.rows(); ++r) matrix(r, c) = in.f64();
}

Eigen::VectorXd read_vector(WireReader& in) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(in.count(kReal)));
  read(in, v);
  return v;
}
void write_vector(WireWriter& out, const Eigen::VectorXd& v) {
  out.whole(static_cast<std::uint64_t>(v.size()));
  write(out, v);
}

bool holds_blocks(const Eigen::VectorXd& gradient, Eigen::Index block) {
  return gradient.size() % block == 0 && gradient.size() <= kMaxSharedPoses * block;
}

// ---- sections ----

void write_topology(WireWriter& out, const std::vector<RobotLinks>& topology) {
  out.whole(topology.size());
  for (const RobotLinks& links : topology) {
    out.whole(links.robot);
    out.whole(links.version);
    out.whole(links.neighbours.size());
    for (const RobotNumber n : links.neighbours) out.whole(n);
  }
}
RobotNumber read_robot(WireReader& in) {
  const RobotNumber robot = in.whole32();
  if (robot >= kMaxRobots) in.refuse();
  return robot;
}
std::size_t count_robots(WireReader& in, std::size_t bytes_each) {
  const std::size_t count = in.count(bytes_each);
  if (count > kMaxRobots) in.refuse();
  return in.good() ? count : 0;
}
std::vector<RobotLinks> read_topology(WireReader& in) {
  std::vector<RobotLinks> topology(count_robots(in, 3));
  for (RobotLinks& links : topology) {
    links.robot = read_robot(in);
    links.version = in.whole32();
    links.neighbours.resize(count_robots(in, 1));
    for (RobotNumber& n : links.neighbours) n = read_robot(in);
    const auto& n = links.neighbours;
    if (std::adjacent_find(n.begin(), n.end(), std::greater_equal<>()) != n.end()) in.refuse();
  }
  return topology;
}

template <class Pose>
void write_frames(WireWriter& out, const SeenPoses<Pose>& seen) {
  out.whole(seen.tree);
  out.whole(seen.frames.size());
  for (const Frame& frame : seen.frames) {
    out.whole(frame.origin);
    out.whole(frame.part);
    out.whole(frame.hops);
  }
  out.whole(seen.part_of.size());
  for (const std::uint32_t part : seen.part_of) out.whole(part);
}
template <class Pose>
void read_frames(WireReader& in, SeenPoses<Pose>& seen) {
  seen.tree = in.whole();
  seen.frames.resize(in.count(3));
  for (Frame& frame : seen.frames) frame = {in.whole32(), in.whole32(), in.whole32()};
  seen.part_of.resize(in.count(1));
  for (std::uint32_t& part : seen.part_of) {
    part = in.whole32();
    if (part >= seen.frames.size()) in.refuse();
  }
}

template <class Item>
void write_items(WireWriter& out, const std::vector<Item>& items) {
  out.whole(items.size());
  for (const Item& item : items) write(out, item);
}
template <class Item>
void read_items(WireReader& in, std::vector<Item>& items, std::size_t bytes_each) {
  items.resize(in.count(bytes_each));
  for (Item& item : items) read(in, item);
}

void write_up(WireWriter& out, const Elimination& up) {
  out.whole(up.tree);
  out.whole(up.sweep);
  out.f64(up.cost);
  out.f64(up.predicted_decrease);
  write_vector(out, up.gradient);
  out.byte(up.information ? 1 : 0);
  if (!up.information) return;
  for (const SharedPose& pose : up.shared) {
    out.whole(pose.key.robot);
    out.whole(pose.key.pose);
    out.whole(pose.solved_by);
  }
  write_information(out, *up.information);
}
Elimination read_up(WireReader& in, Eigen::Index block) {
  Elimination up;
  up.tree = in.whole();
  up.sweep = in.whole32();
  up.cost = in.f64();
  up.predicted_decrease = in.f64();
  up.gradient = read_vector(in);
  if (!holds_blocks(up.gradient, block)) in.refuse();
  if (in.byte() == 0 || !in.good()) return up;
  up.shared.resize(static_cast<std::size_t>(up.gradient.size() / block));
  for (SharedPose& pose : up.shared) pose = {{in.whole32(), in.whole32()}, in.whole32()};
  up.information = read_information(in, up.gradient.size() / block, block);
  return up;
}

void write_down(WireWriter& out, const Solution& down) {
  out.whole(down.tree);
  out.whole(down.sweep);
  out.byte(static_cast<std::uint8_t>(down.end));
  out.byte(down.relinearise ? 1 : 0);
  out.f64(down.damping);
  out.f64(down.mu);
  write_vector(out, down.steps);
}
Solution read_down(WireReader& in) {
  Solution down;
  down.tree = in.whole();
  down.sweep = in.whole32();
  const std::uint8_t end = in.byte();
  if (end > static_cast<std::uint8_t>(SweepEnd::kFinish)) in.refuse();
  down.end = static_cast<SweepEnd>(end);
  down.relinearise = in.byte() != 0;
  down.damping = in.f64();
  down.mu = in.f64();
  down.steps = read_vector(in);
  return down;
}

void write_stage(WireWriter& out, const StageNews& news) {
  out.whole(news.stage);
  out.whole(news.quiet);
  out.byte(static_cast<std::uint8_t>((news.moved ? 1 : 0) + (news.finished ? 2 : 0)));
}
StageNews read_stage(WireReader& in) {
  StageNews news{in.whole32(), in.whole32(), false, false};
  const std::uint8_t flags = in.byte();
  if (flags > 3) in.refuse();
  news.moved = (flags & 1U) != 0;
  news.finished = (flags & 2U) != 0;
  return news;
}

template <class Pose>
void read_section(WireReader& in, SectionKind kind, Message<Pose>& message) {
  const auto seen = [&]() -> SeenPoses<Pose>& {
    return message.seen ? *message.seen : message.seen.emplace();
  };
  switch (kind) {
    case SectionKind::kTopology:
      message.topology = read_topology(in);
      return;
    case SectionKind::kFrames:
      return read_frames(in, seen());
    case SectionKind::kPoses:
      return read_items(in, seen().poses, kPoseBytes<Pose>);
    case SectionKind::kMatrices:
      return read_items(in, message.matrices, kReal * Pose::kDim * Pose::kDim);
    case SectionKind::kSteps:
      return read_items(in, message.steps, kReal * Pose::kDof);
    case SectionKind::kUp:
      message.up = read_up(in, Pose::kDof);
      return;
    case SectionKind::kDown:
      message.down = read_down(in);
      return;
    case SectionKind::kStage:
      message.stage = read_stage(in);
      return;
  }
}

}  // namespace

std::string_view to_string(SectionKind kind) {
  constexpr std::array<std::string_view, kSectionKinds> kNames{
      "topology", "frames", "poses", "rotations", "steps", "eliminations", "solutions", "stages"};
  return kNames[static_cast<std::size_t>(kind)];
}

template <class Pose>
std::string encode(const Message<Pose>& message, MessageBytes* bytes) {
  WireWriter out;
  out.append("RS");
  out.byte(kWireVersion);
  out.byte(Pose::kDim);
  out.whole(message.from);
  out.whole(message.to);
  out.whole(message.round);
  MessageBytes counted;
  counted.header = out.size();
  const auto section = [&](SectionKind kind, bool there, const auto& write_content) {
    if (!there) return;
    WireWriter content;
    write_content(content);
    const std::size_t before = out.size();
    out.byte(static_cast<std::uint8_t>(kind));
    out.whole(content.size());
    out.append(content.bytes());
    counted.sections[static_cast<std::size_t>(kind)] += out.size() - before;
  };
  section(SectionKind::kTopology, !message.topology.empty(),
          [&](WireWriter& o) { write_topology(o, message.topology); });
  section(SectionKind::kFrames, message.seen.has_value(),
          [&](WireWriter& o) { write_frames(o, *message.seen); });
  section(SectionKind::kPoses, message.seen.has_value(),
          [&](WireWriter& o) { write_items(o, message.seen->poses); });
  section(SectionKind::kMatrices, !message.matrices.empty(),
          [&](WireWriter& o) { write_items(o, message.matrices); });
  section(SectionKind::kSteps, !message.steps.empty(), [&](WireWriter& o) { write_items(o, message.steps); });
  section(SectionKind::kUp, message.up.has_value(), [&](WireWriter& o) { write_up(o, *message.up); });
  section(SectionKind::kDown, message.down.has_value(), [&](WireWriter& o) { write_down(o, *message.down); });
  section(SectionKind::kStage, message.stage.has_value(),
          [&](WireWriter& o) { write_stage(o, *message.stage); });
  if (bytes != nullptr) *bytes = counted;
  return out.take();
}

template <class Pose>
std::optional<Message<Pose>> decode(std::string_view bytes) {
  if (bytes.size() > kMaxMessageBytes || bytes.substr(0, 2) != "RS") return std::nullopt;
  WireReader in(bytes.substr(2));
  if (in.byte() != kWireVersion || in.byte() != Pose::kDim) return std::nullopt;
  Message<Pose> message;
  message.from = in.whole32();
  message.to = in.whole32();
  message.round = in.whole32();
  int last_kind = -1;
  while (in.good() && !in.empty()) {
    const int kind = in.byte();
    WireReader content(in.take(in.count(1)));
    if (!in.good() || kind <= last_kind || kind >= static_cast<int>(kSectionKinds)) return std::nullopt;
    last_kind = kind;
    read_section(content, static_cast<SectionKind>(kind), message);
    if (!content.good() || !content.empty()) return std::nullopt;
  }
  if (!in.good()) return std::nullopt;
  return message;
}

#define RADIOSLAM_MESSAGE(Pose)                                     \
  template std::string encode(const Message<Pose>&, MessageBytes*); \
  template std::optional<Message<Pose>> decode(std::string_view);
RADIOSLAM_MESSAGE(SE2)
RADIOSLAM_MESSAGE(SE3)
#undef RADIOSLAM_MESSAGE

}  // namespace radioslam
