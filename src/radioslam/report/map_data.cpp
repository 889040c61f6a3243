#include "radioslam/report/map_data.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/base64.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kMaxCells = 1000000;

/// The grid with cells twice as wide, of which one is occupied if any of four is, and free if any is
/// otherwise.
OccupancyGrid coarser(const OccupancyGrid& fine) {
  OccupancyGrid grid{2 * fine.cell_m, fine.origin_m, (fine.width + 1) / 2, (fine.height + 1) / 2, {}};
  grid.cells.assign(grid.width * grid.height, CellState::kUnknown);
  for (std::size_t y = 0; y < fine.height; ++y)
    for (std::size_t x = 0; x < fine.width; ++x) {
      CellState& of = grid.cells[y / 2 * grid.width + x / 2];
      of = std::max(of, fine.cells[y * fine.width + x]);
    }
  return grid;
}

/// Lengths of runs; the state of a run follows from its number: unknown, free, occupied, unknown, ...
PageData runs_of(const std::vector<CellState>& cells) {
  PageData runs = PageData::array();
  auto state = CellState::kUnknown;
  std::size_t length = 0;
  for (const CellState cell : cells) {
    while (cell != state) {
      runs.push_back(length);
      length = 0;
      state = static_cast<CellState>((static_cast<int>(state) + 1) % 3);
    }
    ++length;
  }
  runs.push_back(length);
  return runs;
}

PageData grid_data(OccupancyGrid grid, const SE3& T_page_estimate) {
  while (grid.cells.size() > kMaxCells) grid = coarser(grid);
  const Eigen::Vector3d t = T_page_estimate.translation();
  return {{"cell_m", grid.cell_m},
          {"width", grid.width},
          {"height", grid.height},
          {"x0", rounded(grid.origin_m.x(), 4)},
          {"y0", rounded(grid.origin_m.y(), 4)},
          {"x", rounded(t.x(), 4)},
          {"y", rounded(t.y(), 4)},
          {"yaw", rounded(T_page_estimate.yaw(), 6)},
          {"runs", runs_of(grid.cells)}};
}

/// Coordinates and time of a point.
using Row = Eigen::Vector4d;

PageData point_data(const MapResult& map, const SE3& T_page_estimate, Stamp page_start) {
  constexpr double kSteps = 65535;
  const double start_s = seconds_between(page_start, map.start);
  std::vector<Row> rows;
  for (const MapPoint& point : map.points) {
    const Eigen::Vector3d at = T_page_estimate * point.position.cast<double>();
    rows.emplace_back(at.x(), at.y(), at.z(), start_s + static_cast<double>(point.time_s));
  }
  Row low = rows.front(), high = rows.front();
  for (const Row& row : rows) low = low.cwiseMin(row), high = high.cwiseMax(row);
  std::string bytes;
  for (int axis = 0; axis < 4; ++axis)
    for (const Row& row : rows) {
      const double span = std::max(1e-9, high[axis] - low[axis]);
      const auto step = static_cast<std::uint16_t>(std::lround(kSteps * (row[axis] - low[axis]) / span));
      bytes += static_cast<char>(step & 0xffU);
      bytes += static_cast<char>(step >> 8U);
    }
  for (const MapPoint& point : map.points) bytes += static_cast<char>(std::min<int>(point.robot, 255));
  PageData lows = PageData::array(), highs = PageData::array();
  for (int axis = 0; axis < 4; ++axis) {
    lows.push_back(rounded(low[axis], 4));
    highs.push_back(rounded(high[axis], 4));
  }
  return {
      {"count", rows.size()}, {"low", std::move(lows)}, {"high", std::move(highs)}, {"data", base64(bytes)}};
}

}  // namespace

PageData map_data(const RunResult& result, const SE3& T_page_estimate, Stamp page_start) {
  PageData list = PageData::array();
  for (const MapResult& map : result.maps) {
    PageData robots = PageData::array();
    for (const std::string& id : map.robots)
      for (std::size_t r = 0; r < result.robots.size(); ++r)
        if (result.robots[r].id == id) robots.push_back(r);
    PageData data{{"robots", std::move(robots)},
                  {"voxel_m", map.voxel_m},
                  {"all_points", map.all_points},
                  {"seen_through", map.seen_through},
                  {"scans", map.scans}};
    if (!map.grid.empty()) data["grid"] = grid_data(map.grid, T_page_estimate);
    if (!map.points.empty()) data["points"] = point_data(map, T_page_estimate, page_start);
    list.push_back(std::move(data));
  }
  return list;
}

}  // namespace radioslam
