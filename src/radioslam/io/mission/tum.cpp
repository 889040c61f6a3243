#include "radioslam/io/mission/tum.hpp"

#include "radioslam/io/text/line_fields.hpp"
#include "radioslam/io/text/numbers.hpp"
#include "radioslam/io/text/skipped_records.hpp"

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

Trajectory<SE3> trajectory_of_rows(const Text& text, const std::vector<TrajectoryRow>& rows,
                                   std::vector<std::string>& warnings) {
  constexpr double kMaxOutOfOrder =
      0.1;  // of the rows, repeated ones included; a log with more has no usable clock
  if (rows.empty()) text.fail(1, "the file has no poses", InputError::Kind::kTooLittle);
  std::vector<Stamp> stamps;
  for (const TrajectoryRow& row : rows) stamps.push_back(row.pose.stamp);
  const SortedRows sorted = sort_rows_by_time(stamps);
  SkippedRecords skipped;
  const auto leave_out = [&](std::size_t row) {
    skipped.add(
        InputError(text.name, rows[row].line, "the time does not increase", InputError::Kind::kClock));
  };
  for (const std::size_t row : sorted.outside) leave_out(row);
  std::vector<StampedPose<SE3>> poses;
  for (const std::size_t row : sorted.kept)
    if (poses.empty() || poses.back().stamp < rows[row].pose.stamp)
      poses.push_back(rows[row].pose);
    else
      leave_out(row);
  if (static_cast<double>(skipped.count()) > kMaxOutOfOrder * static_cast<double>(rows.size()))
    skipped.throw_first();
  if (skipped.count() > 0) warnings.push_back(skipped.warning(text.name, "row"));
  if (sorted.moved > 0)
    warnings.push_back(text.name + ": " + std::to_string(sorted.moved) +
                       " rows are earlier than the one before them and were sorted");
  return Trajectory<SE3>(std::move(poses));
}

Trajectory<SE3> read_logged_tum(const Text& text, std::vector<std::string>& warnings) {
  std::vector<TrajectoryRow> rows;
  SkippedRecords skipped;
  TextLines lines(text);
  while (lines.next_with_content())
    skipped.attempt([&] { rows.push_back({read_row(lines), lines.number()}); });
  skipped.conclude(text.name, "row", rows.size(), warnings);
  return trajectory_of_rows(text, rows, warnings);
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
