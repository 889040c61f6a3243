#include "radioslam/io/run/run_tables.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "radioslam/base/check.hpp"
#include "radioslam/base/parallel.hpp"
#include "radioslam/io/mission/team_tables.hpp"
#include "radioslam/io/text/csv.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::array<std::pair<ClosureKind, std::string_view>, 7> kKinds = {
    {{ClosureKind::kRange, "range"},
     {ClosureKind::kAoa, "aoa"},
     {ClosureKind::kFingerprint, "fingerprint"},
     {ClosureKind::kSequence, "sequence"},
     {ClosureKind::kLidar, "lidar"},
     {ClosureKind::kMatch, "match"},
     {ClosureKind::kFile, "file"}}};
constexpr std::array<std::pair<ClosureStatus, std::string_view>, 2> kStatuses = {
    {{ClosureStatus::kAccepted, "accepted"}, {ClosureStatus::kRejected, "rejected"}}};
constexpr std::array<std::pair<AccessPointStatus, std::string_view>, 3> kAccessPointStatus = {
    {{AccessPointStatus::kFound, "found"},
     {AccessPointStatus::kAmbiguous, "ambiguous"},
     {AccessPointStatus::kPoorlyConstrained, "loose"}}};

template <class Words, class Value>
std::string_view word_for(const Words& words, Value value) {
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.first == value; });
  RADIOSLAM_CHECK(found != words.end(), "every value has a name");
  return found->second;
}

template <class Words>
auto value_of(const CsvReader& csv, std::size_t column, const Words& words) {
  const std::string_view word = csv.field(column);
  const auto found =
      std::find_if(words.begin(), words.end(), [&](const auto& w) { return w.second == word; });
  if (found == words.end()) csv.fail("unknown word '" + std::string(word) + "'");
  return found->first;
}

RobotIndex robot_of(const CsvReader& csv, std::size_t column, std::span<const EstimatedTrajectory> robots) {
  const std::string_view id = csv.field(column);
  const auto found = std::find_if(robots.begin(), robots.end(), [&](const auto& r) { return r.id == id; });
  if (found == robots.end()) csv.fail("unknown robot '" + std::string(id) + "'");
  return RobotIndex(static_cast<std::size_t>(found - robots.begin()));
}

Stamp keyframe_of(const CsvReader& csv, std::size_t column, const EstimatedTrajectory& robot) {
  const Stamp stamp = csv.stamp(column);
  const auto found = std::lower_bound(robot.poses.begin(), robot.poses.end(), stamp,
                                      [](const auto& row, Stamp s) { return row.stamp < s; });
  const bool is_keyframe = found != robot.poses.end() && found->stamp == stamp;
  const bool is_untied = std::any_of(robot.untied.begin(), robot.untied.end(), [&](const auto& stretch) {
    return stretch.first <= stamp && stamp <= stretch.second;
  });
  if (!is_keyframe && !is_untied && !robot.poses.empty())
    csv.fail("robot '" + robot.id + "' has no keyframe at " + format_stamp(stamp) + " in " + robot.id +
             ".tum");
  return stamp;
}

/// The first four columns of both tables.
enum : std::size_t { kRobotI, kTimeI, kRobotJ, kTimeJ, kFirstOwn };
const std::vector<std::string_view> kPairColumns = {"robot_i", "t_i_s", "robot_j", "t_j_s"};

CsvReader::Columns pair_columns_and(std::initializer_list<std::string_view> own) {
  CsvReader::Columns columns{kPairColumns};
  columns.required.insert(columns.required.end(), own);
  return columns;
}

template <class Result>
Result read_pair(const CsvReader& csv, std::span<const EstimatedTrajectory> robots) {
  Result result;
  result.robot_i = robot_of(csv, kRobotI, robots);
  result.stamp_i = keyframe_of(csv, kTimeI, robots[result.robot_i.index()]);
  result.robot_j = robot_of(csv, kRobotJ, robots);
  result.stamp_j = keyframe_of(csv, kTimeJ, robots[result.robot_j.index()]);
  return result;
}

template <class Result>
std::string format_pair(const Result& pair, std::span<const std::string> ids) {
  return ids[pair.robot_i.index()] + "," + format_stamp(pair.stamp_i) + "," + ids[pair.robot_j.index()] +
         "," + format_stamp(pair.stamp_j);
}

/// A reason as a single field of a row.
std::string as_field(std::string text) {
  for (char& c : text)
    if (c == ',' || c == '\n' || c == '\r') c = ';';
  return text;
}

/// Weights as a single field, separated by spaces.
std::string weights_field(const std::vector<double>& weights) {
  std::string field;
  for (const double weight : weights) {
    if (!field.empty()) field += ' ';
    append_number(field, weight);
  }
  return field;
}

/// Seven fields, empty without a pose.
std::optional<SE3> pose_in(const CsvReader& csv, std::size_t column) {
  for (std::size_t k = 0; k < 7; ++k)
    if (!csv.given(column + k)) return std::nullopt;
  std::array<double, 7> n{};
  for (std::size_t k = 0; k < n.size(); ++k) n[k] = csv.number(column + k);
  const Eigen::Quaterniond q(n[6], n[3], n[4], n[5]);
  if (q.norm() < 0.5) csv.fail("qx, qy, qz, qw are not a rotation");
  return SE3(Eigen::Vector3d(n[0], n[1], n[2]), q.normalized());
}

std::vector<double> weights_in(const CsvReader& csv, std::size_t column) {
  std::vector<double> weights;
  std::string_view rest = csv.given(column) ? csv.field(column) : std::string_view();
  while (!rest.empty()) {
    const std::string_view word = rest.substr(0, rest.find(' '));
    const auto weight = parse_number(word);
    if (!weight || *weight < 0) csv.fail("path weight '" + std::string(word) + "' is not a weight");
    weights.push_back(*weight);
    rest.remove_prefix(std::min(rest.size(), word.size() + 1));
  }
  return weights;
}

/// Rows formatted by one thread, and how many such pieces wait to be written.
constexpr std::size_t kRowsPerPiece = 8192, kPiecesAtOnce = 8;

void append_candidate(std::string& out, const std::vector<std::string>& ends_i,
                      const std::vector<std::string>& ends_j, const CandidateList::Row& row) {
  out += ends_i[row.keyframe_i];
  (out += ',') += ends_j[row.keyframe_j];
  append_number(out += ',', row.distance_m);
  append_number(out += ',', row.mahalanobis);
  out += '\n';
}

}  // namespace

CandidateWriter::CandidateWriter(const std::filesystem::path& path, std::vector<std::string> ids)
    : file_(path), ids_(std::move(ids)), pieces_(kPiecesAtOnce) {
  file_.write(kCandidateHeader);
}

void CandidateWriter::name_ends(const CandidateList& keyframes) {
  for (std::size_t r = 0; r < ids_.size(); ++r) {
    std::vector<std::string>& own = ends_.emplace_back();
    for (const Stamp stamp : keyframes.stamps(RobotIndex(r)))
      own.push_back(ids_[r] + "," + format_stamp(stamp));
  }
}

void CandidateWriter::write(const CandidateList::Group& group, const CandidateList& keyframes) {
  if (ends_.empty()) name_ends(keyframes);
  const auto& of_i = ends_[group.robot_i.index()];
  const auto& of_j = ends_[group.robot_j.index()];
  for (std::size_t start = 0; start < group.rows.size(); start += kPiecesAtOnce * kRowsPerPiece) {
    parallel_for(kPiecesAtOnce, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t piece = begin; piece < end; ++piece) {
        const std::size_t first = std::min(group.rows.size(), start + piece * kRowsPerPiece);
        const std::size_t last = std::min(group.rows.size(), first + kRowsPerPiece);
        pieces_[piece].clear();
        for (std::size_t k = first; k < last; ++k)
          append_candidate(pieces_[piece], of_i, of_j, group.rows[k]);
      }
    });
    for (const std::string& piece : pieces_) file_.write(piece);
  }
}

void write_candidates(const std::filesystem::path& path, const CandidateList& candidates,
                      std::span<const std::string> ids) {
  CandidateWriter writer(path, {ids.begin(), ids.end()});
  for (const CandidateList::Group& group : candidates.groups()) writer.write(group, candidates);
  writer.close();
}

std::string_view closure_kind_name(ClosureKind kind) { return word_for(kKinds, kind); }

std::string format_closures(const std::vector<ClosureResult>& closures, std::span<const std::string> ids) {
  std::string out =
      "robot_i,t_i_s,robot_j,t_j_s,kind,status,statistic,reason,path_weights,x,y,z,qx,qy,qz,qw,doubt\n";
  for (const ClosureResult& closure : closures) {
    out += format_pair(closure, ids);
    (out += ',') += word_for(kKinds, closure.kind);
    (out += ',') += word_for(kStatuses, closure.status);
    append_number(out += ',', closure.statistic);
    (out += ',') += as_field(closure.reason);
    (out += ',') += weights_field(closure.path_weights);
    append_pose_fields(out, closure.T_i_j);
    out += ',';
    if (closure.doubt) append_number(out, *closure.doubt);
    out += '\n';
  }
  return out;
}

void append_pose_fields(std::string& out, const std::optional<SE3>& pose) {
  if (!pose) {
    out.append(7, ',');
    return;
  }
  const Eigen::Vector3d& p = pose->translation();
  const Eigen::Quaterniond& q = pose->rotation();
  for (const double number : {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()})
    append_number(out += ',', number);
}

std::string format_uncertainty(const std::vector<RobotResult>& robots) {
  std::string out = "robot,t_s,sigma_m,sigma_team_m,sigma_rad\n";
  for (const RobotResult& robot : robots)
    for (std::size_t k = 0; k < robot.sigma_position_m.size(); ++k) {
      out += robot.id + "," + format_stamp(robot.estimate[k].stamp);
      append_number(out += ',', robot.sigma_position_m[k]);
      append_number(out += ',', robot.sigma_team_m[k]);
      out += ',';
      if (!robot.sigma_rad.empty()) append_number(out, robot.sigma_rad[k]);
      out += '\n';
    }
  return out;
}

std::string format_measured_aoa(const std::vector<MeasuredAoaResult>& aoa_measurements) {
  std::string out(kAoaHeader);
  for (const MeasuredAoaResult& aoa : aoa_measurements)
    append_aoa_rows(out, aoa.stamp, aoa.receiver, aoa.transmitter, aoa.paths);
  return out;
}

std::string format_access_points(const std::vector<AccessPointResult>& access_points) {
  std::string out =
      "bssid,x_m,y_m,sigma_x_m,sigma_y_m,cov_xy,p0_dbm,exponent,sigma_db,readings,status,sigma_p0_db,"
      "sigma_exponent,frequency_mhz,rival_x_m,rival_y_m\n";
  for (const AccessPointResult& point : access_points) {
    const Eigen::Vector4d sigma = point.covariance.diagonal().cwiseMax(0).cwiseSqrt();
    out += as_field(point.bssid);
    for (const double number :
         {point.position_m.x(), point.position_m.y(), sigma[0], sigma[1], point.covariance(0, 1),
          point.power_at_1m_dbm, point.exponent, point.sigma_db})
      append_number(out += ',', number);
    (out += ',') += std::to_string(point.readings);
    (out += ',') += word_for(kAccessPointStatus, point.status);
    for (const double number : {sigma[2], sigma[3], point.frequency_mhz}) append_number(out += ',', number);
    out += ',';
    if (point.alternative_m) append_number(out, point.alternative_m->x());
    out += ',';
    if (point.alternative_m) append_number(out, point.alternative_m->y());
    out += '\n';
  }
  return out;
}

std::vector<LocatedAccessPoint> read_access_points(const Text& text) {
  enum : std::size_t { kBssid, kX, kY, kStatus };
  CsvReader csv(text, {{"bssid", "x_m", "y_m", "status"}});
  std::vector<LocatedAccessPoint> located;
  while (csv.next())
    located.push_back({std::string(csv.field(kBssid)),
                       {csv.coordinate(kX), csv.coordinate(kY)},
                       csv.field(kStatus) == word_for(kAccessPointStatus, AccessPointStatus::kFound)});
  return located;
}

CandidateList read_candidates(const Text& text, std::span<const EstimatedTrajectory> robots) {
  CsvReader csv(text, pair_columns_and({"distance_m", "mahalanobis"}));
  std::vector<std::vector<Stamp>> stamps;
  for (const EstimatedTrajectory& robot : robots) stamps.push_back(robot.poses.stamps());
  CandidateList candidates(std::move(stamps));
  while (csv.next()) {
    auto candidate = read_pair<CandidateResult>(csv, robots);
    candidate.distance_m = static_cast<float>(csv.number(kFirstOwn));
    candidate.mahalanobis = static_cast<float>(csv.number(kFirstOwn + 1));
    candidates.push_back(candidate);
  }
  return candidates;
}

std::vector<ClosureResult> read_closures(const Text& text, std::span<const EstimatedTrajectory> robots) {
  CsvReader::Columns columns = pair_columns_and({"kind", "status", "statistic", "reason"});
  columns.optional = {"path_weights", "x", "y", "z", "qx", "qy", "qz", "qw", "doubt"};
  CsvReader csv(text, columns);
  std::vector<ClosureResult> closures;
  while (csv.next()) {
    ClosureResult& closure = closures.emplace_back(read_pair<ClosureResult>(csv, robots));
    closure.kind = value_of(csv, kFirstOwn, kKinds);
    closure.status = value_of(csv, kFirstOwn + 1, kStatuses);
    closure.statistic = csv.number(kFirstOwn + 2);
    closure.reason = std::string(csv.field(kFirstOwn + 3));
    closure.path_weights = weights_in(csv, kFirstOwn + 4);
    closure.T_i_j = pose_in(csv, kFirstOwn + 5);
    if (csv.given(kFirstOwn + 12)) closure.doubt = csv.number(kFirstOwn + 12);
  }
  return closures;
}

std::vector<MeasuredAoaResult> read_measured_aoa(const Text& text,
                                                 std::span<const EstimatedTrajectory> robots) {
  TeamNames names;
  for (std::size_t r = 0; r < robots.size(); ++r) names.robots.emplace(robots[r].id, RobotIndex(r));
  std::vector<MeasuredAoaResult> results;
  for (AoaMeasurement& measured : read_aoa(text, names)) {
    MeasuredAoaResult& result = results.emplace_back();
    result.receiver = robots[measured.receiver.index()].id;
    result.transmitter = robots[measured.transmitter.robot.index()].id;
    result.stamp = measured.stamp;
    result.paths = std::move(measured.paths);
  }
  return results;
}

void read_uncertainty(const Text& text, std::span<EstimatedTrajectory> robots) {
  CsvReader csv(text, CsvReader::Columns{{"robot", "t_s", "sigma_m"}, {"sigma_team_m", "sigma_rad"}});
  while (csv.next()) {
    EstimatedTrajectory& robot = robots[robot_of(csv, 0, robots).index()];
    const std::size_t k = robot.sigma_position_m.size();
    if (k >= robot.poses.size() || robot.poses[k].stamp != csv.stamp(1))
      csv.fail("the stamps of robot '" + robot.id + "' are not those of " + robot.id + ".tum");
    robot.sigma_position_m.push_back(csv.number(2));
    if (robot.sigma_position_m.back() < 0) csv.fail("sigma_m must not be negative");
    for (auto [column, sigmas] : {std::pair(std::size_t{3}, &robot.sigma_team_m), {4, &robot.sigma_rad}}) {
      if (!csv.given(column)) continue;
      sigmas->push_back(csv.number(column));
      if (sigmas->back() < 0) csv.fail("standard deviations must not be negative");
    }
  }
  for (const EstimatedTrajectory& robot : robots)
    if (!robot.sigma_position_m.empty() && robot.sigma_position_m.size() != robot.poses.size())
      text.fail(0, "has fewer rows of robot '" + robot.id + "' than " + robot.id + ".tum");
}

}  // namespace radioslam
