// A register tile of C <- C +- A B: at most 2 vectors x 6 columns of a column-major matrix.
//
// Every entry of C is a chain of single multiplications and additions in ascending order of the inner index,
// whatever the width of the vectors and the shape of the tiles: all instruction sets give the same bytes.
// `Simd` names a vector type (simd.hpp). Included by one source file per instruction set; nothing here may
// be shared between those, so everything is a template over Simd.
#pragma once

#include <cstddef>
#include <cstdint>

namespace radioslam::dense {

/// Entry (i, k) is at data[i + k * stride].
struct Columns {
  const double* data = nullptr;
  std::size_t stride = 0;
};

/// Column k is column `which[k]` of another matrix.
struct PickedColumns {
  const double* data = nullptr;
  std::size_t stride = 0;
  const std::uint32_t* which = nullptr;
};

/// Entry (k, j) is at data[k * row_stride + j * column_stride].
struct Strided {
  const double* data = nullptr;
  std::size_t row_stride = 0, column_stride = 0;
};

struct Target {
  double* data = nullptr;
  std::size_t stride = 0;
};

enum class Operation {
  kAssign,           ///< C = A B
  kAdd,              ///< C += A B
  kAssignNegative,   ///< C = -A B
  kSubtract,         ///< C -= A B
  kSubtractAndSolve  ///< C = (C - A B) L^-T for a lower triangular L of the tile's width
};

/// L of kSubtractAndSolve, with the reciprocals of its diagonal.
struct TileSolver {
  const double* lower = nullptr;
  std::size_t stride = 0;
  const double* reciprocals = nullptr;
};

inline constexpr std::size_t kTileColumns = 6;
inline constexpr std::size_t kTileVectors = 2;

template <class Simd, Operation kOperation, std::size_t kVectors, std::size_t kColumns, bool kPartial>
class Tile {
  using Vector = typename Simd::Vector;
  static constexpr bool kReads = kOperation != Operation::kAssign && kOperation != Operation::kAssignNegative;
  static constexpr bool kAdds = kOperation == Operation::kAssign || kOperation == Operation::kAdd;

 public:
  /// `last` rows of the last vector count when it is partial.
  Tile(Target target, std::size_t last) : target_(target), last_(last) {
    for (std::size_t j = 0; j < kColumns; ++j) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        sum_[j][v] = kReads ? load(target.data + j * target.stride, v) : Simd::broadcast(0);
      }
    }
  }

  void multiply(std::size_t count, Columns a, Strided b) {
    for (std::size_t k = 0; k < count; ++k) {
      Vector left[kVectors];
      for (std::size_t v = 0; v < kVectors; ++v) left[v] = load(a.data + k * a.stride, v);
      const double* right = b.data + k * b.row_stride;
      for (std::size_t j = 0; j < kColumns; ++j) {
        const Vector factor = Simd::broadcast(right[j * b.column_stride]);
        for (std::size_t v = 0; v < kVectors; ++v) accumulate(sum_[j][v], left[v] * factor);
      }
    }
  }

  void solve(const TileSolver& solver) {
    for (std::size_t j = 0; j < kColumns; ++j) {
      for (std::size_t d = 0; d < j; ++d) {
        const Vector factor = Simd::broadcast(solver.lower[j + d * solver.stride]);
        for (std::size_t v = 0; v < kVectors; ++v) sum_[j][v] = sum_[j][v] - sum_[d][v] * factor;
      }
      const Vector reciprocal = Simd::broadcast(solver.reciprocals[j]);
      for (std::size_t v = 0; v < kVectors; ++v) sum_[j][v] = sum_[j][v] * reciprocal;
    }
  }

  void store() const {
    for (std::size_t j = 0; j < kColumns; ++j) {
      double* const column = target_.data + j * target_.stride;
      for (std::size_t v = 0; v < kVectors; ++v) {
        if (kPartial && v + 1 == kVectors) {
          Simd::store_first(column + v * Simd::kWidth, last_, sum_[j][v]);
        } else {
          Simd::store(column + v * Simd::kWidth, sum_[j][v]);
        }
      }
    }
  }

 private:
  Vector load(const double* column, std::size_t v) const {
    if (kPartial && v + 1 == kVectors) return Simd::load_first(column + v * Simd::kWidth, last_);
    return Simd::load(column + v * Simd::kWidth);
  }
  static void accumulate(Vector& sum, const Vector& product) { sum = kAdds ? sum + product : sum - product; }

  Target target_;
  typename Simd::Count last_;
  Vector sum_[kColumns][kVectors];
};

/// One tile of at most kTileVectors vectors by kColumns columns.
template <class Simd, Operation kOperation, std::size_t kColumns>
void compute_tile(std::size_t rows, std::size_t inner, Columns a, Strided b, Target c,
                  const TileSolver& solver) {
  const auto run = [&](auto&& tile) {
    tile.multiply(inner, a, b);
    if constexpr (kOperation == Operation::kSubtractAndSolve) tile.solve(solver);
    tile.store();
  };
  constexpr std::size_t kWidth = Simd::kWidth;
  if (rows == 2 * kWidth) {
    run(Tile<Simd, kOperation, 2, kColumns, false>(c, kWidth));
  } else if (rows > kWidth) {
    run(Tile<Simd, kOperation, 2, kColumns, true>(c, rows - kWidth));
  } else {
    run(Tile<Simd, kOperation, 1, kColumns, true>(c, rows));
  }
}

}  // namespace radioslam::dense
