#include "radioslam/io/mission/tum.hpp"

#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

StampedPose<SE3> read_row(const TextLines& lines) {
  LineFields fields(lines);
  const Stamp stamp = fields.stamp("t");
  const Eigen::Vector3d position = fields.position();
  const Eigen::Quaterniond orientation = fields.unit_quaternion();
  fields.end();
  return {stamp, SE3(position, orientation)};
}

void refuse_unless_forward(const TextLines& lines, Stamp last, Stamp now) {
  if (now == last) lines.fail("the time " + format_stamp(now) + " appears twice", InputError::Kind::kClock);
  if (now < last)
    lines.fail("time runs backwards, from " + format_stamp(last) + " to " + format_stamp(now),
               InputError::Kind::kClock);
}

}  // namespace

Trajectory<SE3> read_tum(const Text& text) {
  std::vector<StampedPose<SE3>> poses;
  TextLines lines(text);
  while (lines.next_with_content()) {
    const StampedPose<SE3> row = read_row(lines);
    if (!poses.empty()) refuse_unless_forward(lines, poses.back().stamp, row.stamp);
    poses.push_back(row);
  }
  if (poses.empty()) text.fail(1, "the file has no poses", InputError::Kind::kTooLittle);
  return Trajectory<SE3>(std::move(poses));
}

std::string format_tum(const Trajectory<SE3>& trajectory) {
  std::string out;
  for (const auto& [stamp, pose] : trajectory) {
    out += format_stamp(stamp);
    for (int axis = 0; axis < 3; ++axis) append_number(out += ' ', pose.translation()(axis));
    for (int k = 0; k < 4; ++k) append_number(out += ' ', pose.rotation().coeffs()(k));
    out += '\n';
  }
  return out;
}

}  // namespace radioslam
