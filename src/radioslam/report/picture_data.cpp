#include "radioslam/report/picture_data.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

#include "radioslam/report/rounding.hpp"

namespace radioslam {
namespace {

constexpr int kMaxDigit = 9;

char hits_digit(int hits) {
  int digit = 1;
  for (int left = hits; left > 1 && digit < kMaxDigit; left /= 2) ++digit;
  return static_cast<char>('0' + digit);
}

}  // namespace

PageData picture_data(const OccupancyImageResult& picture, const SE3& T_page_estimate) {
  PageData rows = PageData::array(), hits = PageData::array();
  for (std::size_t begin = 0, end = 0; begin < picture.cells.size(); begin = end) {
    PageData row{picture.cells[begin].y, picture.cells[begin].x};
    std::string digits;
    for (end = begin; end < picture.cells.size() && picture.cells[end].y == picture.cells[begin].y; ++end) {
      if (end > begin) row.push_back(picture.cells[end].x - picture.cells[end - 1].x);
      digits += hits_digit(picture.cells[end].hits);
    }
    rows.push_back(std::move(row));
    hits.push_back(std::move(digits));
  }
  const Eigen::Vector3d t = T_page_estimate.translation();
  return {{"cell_m", picture.cell_m}, {"scans", picture.scans}, {"cells", picture.cells.size()},
          {"x", rounded(t.x(), 3)},   {"y", rounded(t.y(), 3)}, {"yaw", rounded(T_page_estimate.yaw(), 6)},
          {"rows", std::move(rows)},  {"hits", std::move(hits)}};
}

}  // namespace radioslam
