#include "radioslam/closure/overlap/skeleton_message.hpp"

#include <algorithm>
#include <utility>

#include "radioslam/closure/overlap/overlap_fields.hpp"

namespace radioslam {
namespace {

std::uint32_t number(std::size_t value) { return static_cast<std::uint32_t>(value); }

/// Per block, the robot that sends its rows.
template <class Pose>
std::vector<std::size_t> owners(const SkeletonInformation<Pose>& information) {
  std::vector<std::size_t> owner(information.matrix.pattern().blocks(), 0);
  for (std::size_t r = 0; r < information.robots.size(); ++r)
    for (const auto& variable : information.robots[r].variables)
      if (variable.block >= 0) owner[static_cast<std::size_t>(variable.block)] = r;
  return owner;
}

template <class Pose>
void write_segments(const SkeletonSegments<Pose>& segments, OverlapFieldWriter& out) {
  out(number(segments.variables.size()));
  for (const auto& variable : segments.variables) {
    out(static_cast<std::uint32_t>(variable.block + 1));
    out(std::uint32_t{variable.is_pose});
    if (!variable.is_pose) continue;
    const Eigen::Matrix<double, Pose::kDim, Pose::kDof> upper =
        variable.to_left.template topRows<Pose::kDim>();
    out(upper);
  }
  out(number(segments.places.size()));
  for (const SegmentPlaces& s : segments.places) {
    out(number(s.first));
    out(number(s.last));
    out(number(s.drift + 1));
  }
}

/// Rows of a matrix as they come in from one robot after the other.
template <class Pose>
class RowReader {
 public:
  /// All rows of one robot.
  bool read(std::string_view bytes) {
    OverlapFieldReader in(bytes);
    const std::uint32_t blocks = in.number();
    if (robots_.empty()) blocks_ = blocks;
    in.refuse_unless(blocks == blocks_);
    read_blocks(in);
    read_lower(in);
    robots_.emplace_back();
    read_segments(in, robots_.back());
    return in.is_complete();
  }

  std::optional<SkeletonInformation<Pose>> information() {
    if (diagonals_.size() != blocks_) return std::nullopt;
    std::sort(diagonals_.begin(), diagonals_.end(), [](const auto& x, const auto& y) { return x.at < y.at; });
    std::sort(lower_.begin(), lower_.end(), [](const auto& x, const auto& y) {
      return std::pair(x.at.column, x.at.row) < std::pair(y.at.column, y.at.row);
    });
    BlockPattern pattern;
    std::vector<std::int32_t> last;
    for (std::size_t b = 0; b < diagonals_.size(); ++b) {
      if (diagonals_[b].at.row != static_cast<std::int32_t>(b)) return std::nullopt;
      pattern.sizes.push_back(static_cast<std::int32_t>(diagonals_[b].values.rows()));
      if (diagonals_[b].is_last) last.push_back(static_cast<std::int32_t>(b));
    }
    for (const Block& block : lower_) {
      const bool is_repeated = !pattern.lower.empty() && pattern.lower.back() == block.at;
      if (is_repeated || block.values.rows() != pattern.sizes[static_cast<std::size_t>(block.at.row)] ||
          block.values.cols() != pattern.sizes[static_cast<std::size_t>(block.at.column)])
        return std::nullopt;
      pattern.lower.push_back(block.at);
    }
    if (!fit(pattern)) return std::nullopt;
    SymmetricBlockMatrix matrix(std::move(pattern));
    for (std::size_t b = 0; b < diagonals_.size(); ++b) matrix.diagonal(b) = diagonals_[b].values;
    for (std::size_t k = 0; k < lower_.size(); ++k) matrix.lower(k) = lower_[k].values;
    return SkeletonInformation<Pose>{std::move(matrix), std::move(last), std::move(robots_)};
  }

 private:
  struct Block {
    BlockPlace at;
    Eigen::MatrixXd values;
    bool is_last = false;
  };

  bool is_block(std::uint32_t index) const { return index < blocks_; }
  static bool is_size(std::uint32_t size) { return size >= 1 && size <= Pose::kDof; }

  void read_blocks(OverlapFieldReader& in) {
    own_.clear();
    for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
      const std::uint32_t index = in.number(), size = in.number(), is_last = in.number();
      in.refuse_unless(is_block(index) && is_size(size) && is_last <= 1);
      if (!in.good()) return;
      const auto at = static_cast<std::int32_t>(index);
      Block& block = diagonals_.emplace_back(Block{{at, at}, Eigen::MatrixXd(size, size), is_last == 1});
      in.symmetric(block.values);
      own_.emplace_back(index, size);
    }
    std::sort(own_.begin(), own_.end());
  }

  void read_lower(OverlapFieldReader& in) {
    for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
      const std::uint32_t row = in.number(), column = in.number(), columns = in.number();
      const auto own = std::lower_bound(own_.begin(), own_.end(), std::pair(row, 0U));
      in.refuse_unless(own != own_.end() && own->first == row && column < row && is_size(columns));
      if (!in.good()) return;
      Block& block =
          lower_.emplace_back(Block{{static_cast<std::int32_t>(row), static_cast<std::int32_t>(column)},
                                    Eigen::MatrixXd(own->second, columns)});
      in.dense(block.values);
    }
  }

  void read_segments(OverlapFieldReader& in, SkeletonSegments<Pose>& segments) {
    for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
      auto& variable = segments.variables.emplace_back();
      const std::uint32_t block = in.number(), is_pose = in.number();
      in.refuse_unless(block <= blocks_ && is_pose <= 1);
      if (!in.good()) return;
      variable.block = static_cast<std::int32_t>(block) - 1;
      variable.is_pose = is_pose == 1;
      if (variable.is_pose) read_adjoint(in, variable.to_left);
    }
    const auto is_of_kind = [&](std::size_t v, bool is_pose) {
      return v < segments.variables.size() && segments.variables[v].is_pose == is_pose;
    };
    for (std::uint32_t n = in.number(); n > 0 && in.good(); --n) {
      SegmentPlaces s{in.number(), in.number(), 0};
      s.drift = std::size_t{in.number()} - 1;
      in.refuse_unless(is_of_kind(s.first, true) && is_of_kind(s.last, true) &&
                       (s.drift == kNoDrift || is_of_kind(s.drift, false)));
      segments.places.push_back(s);
    }
  }

  static void read_adjoint(OverlapFieldReader& in, typename Pose::Jacobian& adjoint) {
    constexpr int kDim = Pose::kDim, kRotation = Pose::kDof - kDim;
    Eigen::Matrix<double, kDim, Pose::kDof> upper;
    in(upper);
    adjoint.template topRows<kDim>() = upper;
    if constexpr (kRotation == kDim)
      adjoint.template bottomRightCorner<kDim, kDim>() = upper.template leftCols<kDim>();
  }

  /// Whether the segments' variables have blocks of their sizes.
  bool fit(const BlockPattern& pattern) const {
    for (const auto& robot : robots_)
      for (const auto& variable : robot.variables)
        if (variable.block >= 0 && pattern.sizes[static_cast<std::size_t>(variable.block)] != variable.size())
          return false;
    return true;
  }

  std::uint32_t blocks_ = 0;
  std::vector<Block> diagonals_, lower_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> own_;  ///< blocks of the robot that is read, and sizes
  std::vector<SkeletonSegments<Pose>> robots_;
};

}  // namespace

template <class Pose>
std::string write_rows(const SkeletonInformation<Pose>& information, std::size_t robot) {
  const SymmetricBlockMatrix& matrix = information.matrix;
  const BlockPattern& pattern = matrix.pattern();
  const std::vector<std::size_t> owner = owners(information);
  const auto is_own = [&](std::size_t block) { return owner[block] == robot; };
  OverlapFieldWriter out;
  out(number(pattern.blocks()));
  out(number(static_cast<std::size_t>(std::count(owner.begin(), owner.end(), robot))));
  for (std::size_t b = 0; b < pattern.blocks(); ++b) {
    if (!is_own(b)) continue;
    const auto& last = information.last;
    out(number(b));
    out(static_cast<std::uint32_t>(pattern.sizes[b]));
    out(std::uint32_t{std::find(last.begin(), last.end(), static_cast<std::int32_t>(b)) != last.end()});
    out.symmetric(matrix.diagonal(b));
  }
  const auto of_own_row = [&](const BlockPlace& at) { return is_own(static_cast<std::size_t>(at.row)); };
  out(number(
      static_cast<std::size_t>(std::count_if(pattern.lower.begin(), pattern.lower.end(), of_own_row))));
  for (std::size_t k = 0; k < pattern.lower.size(); ++k) {
    const BlockPlace& at = pattern.lower[k];
    if (!of_own_row(at)) continue;
    const auto values = matrix.lower(k);
    out(static_cast<std::uint32_t>(at.row));
    out(static_cast<std::uint32_t>(at.column));
    out(static_cast<std::uint32_t>(values.cols()));
    out.dense(values);
  }
  write_segments(information.robots[robot], out);
  return out.take();
}

template <class Pose>
bool is_rows(std::string_view bytes) {
  return RowReader<Pose>().read(bytes);
}

template <class Pose>
std::optional<SkeletonInformation<Pose>> read_rows(const std::vector<std::string_view>& robots) {
  RowReader<Pose> rows;
  for (const std::string_view bytes : robots)
    if (!rows.read(bytes)) return std::nullopt;
  return rows.information();
}

#define RADIOSLAM_SKELETON_MESSAGE(Pose)                                          \
  template std::string write_rows(const SkeletonInformation<Pose>&, std::size_t); \
  template bool is_rows<Pose>(std::string_view);                                  \
  template std::optional<SkeletonInformation<Pose>> read_rows(const std::vector<std::string_view>&)
RADIOSLAM_SKELETON_MESSAGE(SE2);
RADIOSLAM_SKELETON_MESSAGE(SE3);

}  // namespace radioslam
