#include "radioslam/team/messages.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include "radioslam/base/wire.hpp"
#include "radioslam/records/record_codec.hpp"

namespace radioslam {
namespace {

constexpr std::string_view kMagic = "RST1";
constexpr std::size_t kMaxClouds = 256;
constexpr std::uint64_t kMaxRecords = std::uint64_t{1} << 40U;  // of a robot

void put_name(WireWriter& out, const std::string& name) {
  out.whole(name.size());
  out.append(name);
}

std::string name_of(WireReader& in) {
  std::string name(in.take(in.count(1)));
  if (!is_record_name(name)) in.refuse();
  return name;
}

void put_stamp(WireWriter& out, Stamp stamp) { out.whole(static_cast<std::uint64_t>(stamp.ns)); }
Stamp stamp_of(WireReader& in) { return {static_cast<std::int64_t>(in.whole())}; }

void put(WireWriter& out, const Digest& digest) {
  out.byte(digest.solves ? 1 : 0);
  out.whole(digest.knows.size());
  for (const auto& [robot, extent] : digest.knows) {
    put_name(out, robot);
    out.u32(extent.life);
    out.whole(extent.records);
    out.u32(extent.checksum);
  }
}
Digest digest_of(WireReader& in) {
  Digest digest;
  digest.solves = in.byte() == 1;
  const std::size_t count = in.count(10);
  if (count > kMaxTeam) in.refuse();
  for (std::size_t k = 0; k < count && in.good(); ++k) {
    LogExtent& extent = digest.knows[name_of(in)];
    extent.life = in.u32();
    extent.records = in.whole();
    if (extent.records > kMaxRecords) in.refuse();
    extent.checksum = in.u32();
  }
  return digest;
}

void put(WireWriter& out, const RecordsMessage& records) { out.append(records.chunks); }
RecordsMessage records_of(WireReader& in) { return {std::string(in.take(in.left()))}; }

void put(WireWriter& out, const Want& want) {
  out.whole(want.stretches.size());
  for (const WantedStretch& stretch : want.stretches) {
    put_name(out, stretch.robot);
    out.u32(stretch.life);
    out.whole(stretch.first);
    out.whole(stretch.end - stretch.first);
  }
}
Want want_of(WireReader& in) {
  Want want;
  const std::size_t count = in.count(8);
  if (count > kMaxStretches) in.refuse();
  for (std::size_t k = 0; k < count && in.good(); ++k) {
    WantedStretch stretch;
    stretch.robot = name_of(in);
    stretch.life = in.u32();
    stretch.first = in.whole();
    const std::uint64_t length = in.whole();
    if (length == 0 || length > kMaxRecords) in.refuse();
    stretch.end = stretch.first + length;
    want.stretches.push_back(std::move(stretch));
  }
  return want;
}

void put(WireWriter& out, const CloudWant& want) {
  out.whole(want.keyframes.size());
  for (const Stamp stamp : want.keyframes) put_stamp(out, stamp);
}
CloudWant cloud_want_of(WireReader& in) {
  CloudWant want;
  const std::size_t count = in.count(1);
  if (count > kMaxClouds) in.refuse();
  for (std::size_t k = 0; k < count && in.good(); ++k) want.keyframes.push_back(stamp_of(in));
  return want;
}

void put(WireWriter& out, const CloudMessage& cloud) {
  put_stamp(out, cloud.keyframe);
  out.byte(cloud.scanner.kind == ScannerKind::kPlanar ? 1 : 0);
  out.f64(cloud.scanner.nominal_inlier_ratio);
  out.f64(cloud.scanner.spacing_m);
  out.append(cloud.packed);
}
CloudMessage cloud_of(WireReader& in) {
  CloudMessage cloud;
  cloud.keyframe = stamp_of(in);
  cloud.scanner.kind = in.byte() == 1 ? ScannerKind::kPlanar : ScannerKind::kSpatial;
  cloud.scanner.nominal_inlier_ratio = in.f64();
  cloud.scanner.spacing_m = in.f64();
  if (!(cloud.scanner.nominal_inlier_ratio > 0 && cloud.scanner.nominal_inlier_ratio <= 1) ||
      !(cloud.scanner.spacing_m > 0 && cloud.scanner.spacing_m < 100))
    in.refuse();
  cloud.packed = std::string(in.take(in.left()));
  return cloud;
}

void put(WireWriter& out, const SolutionMessage& solution) {
  out.whole(solution.records);
  out.whole(solution.frames.size());
  for (const auto& [robot, frame] : solution.frames) {
    put_name(out, robot);
    put_name(out, frame.frame);
    const Eigen::Quaterniond& q = frame.T_frame_start.rotation();
    for (const double x : {q.w(), q.x(), q.y(), q.z()}) out.f32(static_cast<float>(x));
    for (const double x : frame.T_frame_start.translation()) out.f64(x);
  }
}
SolutionMessage solution_of(WireReader& in) {
  SolutionMessage solution;
  solution.records = in.whole();
  const std::size_t count = in.count(44);
  if (count > kMaxTeam) in.refuse();
  for (std::size_t k = 0; k < count && in.good(); ++k) {
    const std::string robot = name_of(in);
    PublishedFrame frame{name_of(in), {}};
    Eigen::Quaterniond q;
    q.w() = static_cast<double>(in.f32());
    q.x() = static_cast<double>(in.f32());
    q.y() = static_cast<double>(in.f32());
    q.z() = static_cast<double>(in.f32());
    const double x = in.f64(), y = in.f64(), z = in.f64();
    if (!(std::abs(q.norm() - 1) < 1e-3)) {
      in.refuse();
      break;
    }
    frame.T_frame_start = SE3({x, y, z}, q.normalized());
    solution.frames[robot] = std::move(frame);
  }
  return solution;
}

std::optional<AgentMessage> message_of(std::uint8_t kind, WireReader& in) {
  switch (kind) {
    case 0:
      return digest_of(in);
    case 1:
      return records_of(in);
    case 2:
      return want_of(in);
    case 3:
      return cloud_want_of(in);
    case 4:
      return cloud_of(in);
    case 5:
      return solution_of(in);
    default:
      return std::nullopt;
  }
}

}  // namespace

std::string encode(const std::string& sender, const AgentMessage& message) {
  WireWriter out;
  out.append(kMagic);
  out.byte(static_cast<std::uint8_t>(message.index()));
  put_name(out, sender);
  std::visit([&](const auto& of) { put(out, of); }, message);
  return out.take();
}

std::variant<ReceivedMessage, std::string> decode_message(std::string_view bytes) {
  if (bytes.size() > kMaxAgentMessageBytes) return "messages of more than 60,000 bytes";
  WireReader in(bytes);
  const std::string_view magic = in.take(kMagic.size());
  if (!in.good() || magic.substr(0, 3) != kMagic.substr(0, 3)) return "bytes that are no message";
  if (magic != kMagic) return "messages of another version of this program; a team needs one";
  const std::uint8_t kind = in.byte();
  std::string sender = name_of(in);
  if (!in.good()) return "messages without a sender";
  auto message = message_of(kind, in);
  if (!message) return "messages of a kind that is not known";
  if (!in.good() || !in.empty())
    return std::string("damaged messages of the kind ") + kAgentMessageKinds[kind];
  return ReceivedMessage{std::move(sender), *std::move(message)};
}

}  // namespace radioslam
