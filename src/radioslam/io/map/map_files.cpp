#include "radioslam/io/map/map_files.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include "radioslam/io/text/byte_view.hpp"
#include "radioslam/io/text/numbers.hpp"

namespace radioslam {
namespace {

constexpr std::size_t kPartBytes = 1 << 16;
constexpr double kMaxFloat_m = 16000;  // beyond it, neighbours in float32 are a millimetre apart

enum class Coordinate { kFloat32, kFloat64 };

/// The precision that the positions of all points need.
Coordinate coordinate_of(const TeamMap& map) {
  double largest = 0;
  map.for_each_point([&](const Eigen::Vector3d& position, const MapPoint&) {
    largest = std::max(largest, position.cwiseAbs().maxCoeff());
  });
  return largest < kMaxFloat_m ? Coordinate::kFloat32 : Coordinate::kFloat64;
}

/// Appends all points as records of x y z, normal, intensity, time and robot.
void append_points(const TeamMap& map, Coordinate coordinate, const AppendToFile& append) {
  const double start_s = map.result().start.seconds();
  std::string part;
  map.for_each_point([&](const Eigen::Vector3d& position, const MapPoint& point) {
    for (const double value : position)
      coordinate == Coordinate::kFloat32 ? append_f32(part, static_cast<float>(value))
                                         : append_f64(part, value);
    for (const float value : point.normal) append_f32(part, value);
    append_f32(part, point.intensity);
    append_f64(part, start_s + static_cast<double>(point.time_s));
    append_little_endian(part, point.robot, sizeof(point.robot));
    if (part.size() < kPartBytes) return;
    append(part);
    part.clear();
  });
  append(part);
}

}  // namespace

void write_ply(const TeamMap& map, const AppendToFile& append) {
  const MapResult& result = map.result();
  const Coordinate coordinate = coordinate_of(map);
  const std::string number = coordinate == Coordinate::kFloat32 ? "float" : "double";
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t r = 0; r < result.robots.size(); ++r)
    header += "comment robot " + std::to_string(r) + ' ' + result.robots[r] + '\n';
  header += "element vertex " + std::to_string(result.all_points) + '\n';
  for (const char* name : {"x", "y", "z"}) header += "property " + number + ' ' + name + '\n';
  for (const char* name : {"nx", "ny", "nz", "intensity"})
    header += std::string("property float ") + name + '\n';
  append(header + "property double time\nproperty ushort robot\nend_header\n");
  append_points(map, coordinate, append);
}

void write_pcd(const TeamMap& map, const AppendToFile& append) {
  const Coordinate coordinate = coordinate_of(map);
  const std::string size = coordinate == Coordinate::kFloat32 ? "4 4 4" : "8 8 8";
  const std::string points = std::to_string(map.result().all_points);
  append(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n"
      "FIELDS x y z normal_x normal_y normal_z intensity time robot\nSIZE " +
      size + " 4 4 4 4 8 2\nTYPE F F F F F F F F U\nCOUNT 1 1 1 1 1 1 1 1 1\nWIDTH " + points +
      "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA binary\n");
  append_points(map, coordinate, append);
}

std::string format_pgm(const OccupancyGrid& grid) {
  constexpr std::array<char, 3> kLevels{static_cast<char>(205), static_cast<char>(254), 0};
  std::string pgm = "P5\n" + std::to_string(grid.width) + ' ' + std::to_string(grid.height) + "\n255\n";
  pgm.reserve(pgm.size() + grid.cells.size());
  for (std::size_t row = grid.height; row-- > 0;)
    for (std::size_t x = 0; x < grid.width; ++x)
      pgm += kLevels[static_cast<std::size_t>(grid.cells[row * grid.width + x])];
  return pgm;
}

std::string format_map_yaml(const OccupancyGrid& grid, const std::string& image) {
  return "image: " + image + "\nmode: trinary\nresolution: " + format_number(grid.cell_m) + "\norigin: [" +
         format_number(grid.origin_m.x()) + ", " + format_number(grid.origin_m.y()) +
         ", 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
}

}  // namespace radioslam
