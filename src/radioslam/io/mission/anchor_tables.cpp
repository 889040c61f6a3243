#include "radioslam/io/mission/anchor_tables.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "radioslam/io/text/csv.hpp"

namespace radioslam {
namespace {

double positive(const CsvReader& csv, std::size_t column, const char* what) {
  const double value = csv.coordinate(column);
  if (value <= 0) csv.fail(std::string(what) + " is not positive");
  return value;
}

std::string id_at(const CsvReader& csv, std::size_t column) {
  std::string id(csv.field(column));
  if (!is_valid_id(id)) csv.fail("the id '" + id + "' is not a valid file name");
  return id;
}

/// Numbers names in the order of first mention.
class Numbering {
 public:
  std::size_t operator()(const std::string& name) {
    return numbers_.try_emplace(name, numbers_.size()).first->second;
  }
  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = numbers_.find(name);
    return found == numbers_.end() ? std::nullopt : std::optional(found->second);
  }

 private:
  std::map<std::string, std::size_t> numbers_;
};

std::string antenna_name(const CsvReader& csv, const std::string& id, std::size_t column) {
  return csv.given(column) ? id + "/" + std::string(csv.field(column)) : id;
}

enum RangeColumn : std::size_t { kTime, kI, kJ, kRange, kSigma, kAntennaI, kAntennaJ };

/// Assigns rows to their receivers.
class RangeSorter {
 public:
  explicit RangeSorter(const std::vector<std::string>& anchors) {
    for (const auto& anchor : anchors) anchors_(anchor);
  }

  void add(const CsvReader& csv) {
    const std::string i = id_at(csv, kI), j = id_at(csv, kJ);
    if (i == j) csv.fail("a range from '" + i + "' to itself");
    const auto anchor_i = anchors_.find(i), anchor_j = anchors_.find(j);
    const AnchorRange range{
        csv.stamp(kTime), 0, {0, positive(csv, kRange, "a range"), positive(csv, kSigma, "a sigma")}};
    const std::string antenna_i = antenna_name(csv, i, kAntennaI),
                      antenna_j = antenna_name(csv, j, kAntennaJ);
    if (anchor_i && anchor_j) ++table_.between_anchors;
    if (!anchor_i && !anchor_j) ++table_.between_receivers;
    if (anchor_i && !anchor_j) add(range, j, antenna_j, *anchor_i, antenna_i);
    if (!anchor_i && anchor_j) add(range, i, antenna_i, *anchor_j, antenna_j);
  }

  RangeTable take() {
    for (auto& receiver : table_.receivers)
      std::stable_sort(receiver.ranges.begin(), receiver.ranges.end(),
                       [](const AnchorRange& a, const AnchorRange& b) { return a.stamp < b.stamp; });
    return std::move(table_);
  }

 private:
  void add(AnchorRange range, const std::string& robot, const std::string& antenna, std::size_t anchor,
           const std::string& anchor_antenna) {
    const std::size_t r = receivers_(robot);
    if (r == table_.receivers.size()) table_.receivers.push_back({robot, {}, {}});
    auto& receiver = table_.receivers[r];
    const auto [place, is_new] = pairs_.try_emplace({antenna, anchor_antenna}, receiver.pairs.size());
    if (is_new) receiver.pairs.push_back({antenna, anchor_antenna});
    range.sight.anchor = anchor;
    range.pair = place->second;
    receiver.ranges.push_back(range);
  }

  Numbering anchors_, receivers_;
  std::map<std::pair<std::string, std::string>, std::size_t> pairs_;
  RangeTable table_;
};

}  // namespace

DistanceTable read_distances(const Text& text, double default_sigma_m) {
  enum : std::size_t { kIdI, kIdJ, kDistance, kDistanceSigma };
  CsvReader csv(text, {{"id_i", "id_j", "distance_m"}, {"sigma_m"}});
  DistanceTable table;
  Numbering anchors;
  const auto number_of = [&](const std::string& id) {
    const std::size_t number = anchors(id);
    if (number == table.anchors.size()) table.anchors.push_back(id);
    return number;
  };
  while (csv.next()) {
    const std::string i = id_at(csv, kIdI), j = id_at(csv, kIdJ);
    if (i == j) csv.fail("a distance from '" + i + "' to itself");
    const double sigma_m =
        csv.given(kDistanceSigma) ? positive(csv, kDistanceSigma, "a sigma") : default_sigma_m;
    const std::size_t number_i = number_of(i), number_j = number_of(j);
    table.distances.push_back({number_i, number_j, positive(csv, kDistance, "a distance"), sigma_m});
  }
  return table;
}

RangeTable read_anchor_ranges(const Text& text, const std::vector<std::string>& anchors) {
  CsvReader csv(text, {{"t_s", "robot_i", "robot_j", "range_m", "sigma_m"}, {"antenna_i", "antenna_j"}});
  RangeSorter sorter(anchors);
  while (csv.next()) sorter.add(csv);
  RangeTable table = sorter.take();
  if (table.receivers.empty()) text.fail(0, "no range is between a robot and one of the anchors");
  return table;
}

}  // namespace radioslam
