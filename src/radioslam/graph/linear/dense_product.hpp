// C <- C +- A B on column-major matrices, by register tiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace radioslam::dense {

// A register tile of C <- C +- A B: at most 2 vectors x 6 columns of a column-major matrix.
//
// Every entry of C is a chain of single multiplications and additions in ascending order of the inner index,
// whatever the width of the vectors and the shape of the tiles: all instruction sets give the same bytes.
// `Simd` names a vector type (simd.hpp). Included by one source file per instruction set; nothing here may
// be shared between those, so everything is a template over Simd.

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

enum class Shape {
  kFull,
  kLowerResult,  ///< only the lower triangle of C is needed; what is above may be overwritten
};
enum class Left {
  kFull,
  kUpper,  ///< A(i, k) is zero for k < i, and not read but near the diagonal
};

struct Extent {
  std::size_t rows = 0, columns = 0, inner = 0;
};

template <std::size_t kMultiple>
constexpr std::size_t round_down(std::size_t value) {
  return value - value % kMultiple;
}

/// The tiles of a strip of kColumns columns of C, from row `first` on.
template <class Simd, Operation kOperation, std::size_t kColumns>
void compute_strip(std::size_t first, Extent extent, Left left, Columns a, Strided b, Target c,
                   const TileSolver& solver = {}) {
  constexpr std::size_t kRows = kTileVectors * Simd::kWidth;
  for (std::size_t i = first; i < extent.rows; i += kRows) {
    const std::size_t rows = i + kRows < extent.rows ? kRows : extent.rows - i;
    const std::size_t skip = left == Left::kFull ? 0 : (i < extent.inner ? i : extent.inner);
    compute_tile<Simd, kOperation, kColumns>(
        rows, extent.inner - skip, {a.data + i + skip * a.stride, a.stride},
        {b.data + skip * b.row_stride, b.row_stride, b.column_stride}, {c.data + i, c.stride}, solver);
  }
}

/// Calls body(j, width) for strips of 6, 3, 2 and 1 columns that cover [0, columns); the width is a constant.
template <class Body>
void for_each_strip(std::size_t columns, const Body& body) {
  std::size_t j = 0;
  for (; columns - j >= 6; j += 6) body(j, std::integral_constant<std::size_t, 6>{});
  for (; columns - j >= 3; j += 3) body(j, std::integral_constant<std::size_t, 3>{});
  if (columns - j == 2) body(j, std::integral_constant<std::size_t, 2>{});
  if (columns - j == 1) body(j, std::integral_constant<std::size_t, 1>{});
}

/// C <- C +- A B straight from where A and B are: for what fits the caches and their address tables.
template <class Simd, Operation kOperation>
void product_in_place(Extent extent, Shape shape, Left left, Columns a, Strided b, Target c) {
  for_each_strip(extent.columns, [&](std::size_t j, auto width) {
    constexpr std::size_t kColumns = decltype(width)::value;
    compute_strip<Simd, kOperation, kColumns>(shape == Shape::kFull ? 0 : j, extent, left, a,
                                              {b.data + j * b.column_stride, b.row_stride, b.column_stride},
                                              {c.data + j * c.stride, c.stride});
  });
}

/// What is copied together, so that the tiles read successive memory.
inline constexpr std::size_t kPackedRows = 192;
inline constexpr std::size_t kPackedDepth = 144;

/// A from row i and column k on, and its entry (i, k). In templates, as everything here.
template <class Simd>
struct Access {
  static Columns moved(Columns a, std::size_t i, std::size_t k) {
    return {a.data + i + k * a.stride, a.stride};
  }
  static PickedColumns moved(PickedColumns a, std::size_t i, std::size_t k) {
    return {a.data + i, a.stride, a.which + k};
  }
  static const double* entry(Columns a, std::size_t i, std::size_t k) { return a.data + i + k * a.stride; }
  static const double* entry(PickedColumns a, std::size_t i, std::size_t k) {
    return a.data + i + a.which[k] * a.stride;
  }
};

/// Rows of A, a tile's rows at a time: entry (i, k) of a group of T rows is at k * T + i.
template <class Simd, class Matrix>
class PackedRows {
  static constexpr std::size_t kRows = kTileVectors * Simd::kWidth;
  static_assert(kPackedRows % kRows == 0);

 public:
  PackedRows(std::size_t rows, std::size_t depth, Matrix a) : depth_(depth) {
    for (std::size_t i = 0; i < rows; i += kRows) {
      const std::size_t count = rows - i < kRows ? rows - i : kRows;
      double* const group = values_ + i * depth;
      for (std::size_t k = 0; k < depth; ++k) {
        const double* const column = Access<Simd>::entry(a, i, k);
        for (std::size_t t = 0; t < count; ++t) group[k * kRows + t] = column[t];
      }
    }
  }
  /// The group that row i begins.
  Columns group(std::size_t i) const { return {values_ + i * depth_, kRows}; }

 private:
  std::size_t depth_;
  double values_[kPackedRows * kPackedDepth];
};

/// Columns of B, entry (k, j) at k * kColumns + j.
template <class Simd, std::size_t kColumns>
class PackedStrip {
 public:
  PackedStrip(std::size_t depth, Strided b) {
    for (std::size_t k = 0; k < depth; ++k) {
      for (std::size_t j = 0; j < kColumns; ++j) {
        values_[k * kColumns + j] = b.data[k * b.row_stride + j * b.column_stride];
      }
    }
  }
  Strided from(std::size_t k) const { return {values_ + k * kColumns, kColumns, 1}; }

 private:
  double values_[kPackedDepth * kColumns];
};

/// Rows [first, first + extent.rows) of C, with an inner extent that begins at `inner_begin` of A's columns.
template <class Simd, Operation kOperation, class Matrix>
void product_of_block(std::size_t first, std::size_t inner_begin, Extent extent, Shape shape, Left left,
                      Matrix a, Strided b, Target c) {
  constexpr std::size_t kRows = kTileVectors * Simd::kWidth;
  const PackedRows<Simd, Matrix> rows(extent.rows, extent.inner, a);
  const std::size_t last = first + extent.rows;
  const std::size_t columns = shape == Shape::kFull || extent.columns < last ? extent.columns : last;
  for_each_strip(columns, [&](std::size_t j, auto width) {
    constexpr std::size_t kColumns = decltype(width)::value;
    const PackedStrip<Simd, kColumns> strip(extent.inner,
                                            {b.data + j * b.column_stride, b.row_stride, b.column_stride});
    const std::size_t begin = shape == Shape::kFull || j < first ? 0 : round_down<kRows>(j - first);
    for (std::size_t i = begin; i < extent.rows; i += kRows) {
      const std::size_t zeros = left == Left::kFull || first + i < inner_begin ? 0 : first + i - inner_begin;
      const std::size_t skip = zeros < extent.inner ? zeros : extent.inner;
      const auto group = rows.group(i);
      compute_tile<Simd, kOperation, kColumns>(
          i + kRows < extent.rows ? kRows : extent.rows - i, extent.inner - skip,
          {group.data + skip * group.stride, group.stride}, strip.from(skip),
          {c.data + first + i + j * c.stride, c.stride}, {});
    }
  });
}

constexpr Operation continued(Operation operation) {
  return operation == Operation::kAssign || operation == Operation::kAdd ? Operation::kAdd
                                                                         : Operation::kSubtract;
}

/// Rows [first, last) of C.
template <class Simd, Operation kOperation, class Matrix>
void product_of_rows(std::size_t first, std::size_t last, Extent extent, Shape shape, Left left, Matrix a,
                     Strided b, Target c) {
  for (std::size_t k = 0; k < extent.inner || k == 0; k += kPackedDepth) {
    const std::size_t depth = extent.inner - k < kPackedDepth ? extent.inner - k : kPackedDepth;
    for (std::size_t i = first; i < last; i += kPackedRows) {
      const std::size_t rows = last - i < kPackedRows ? last - i : kPackedRows;
      const Extent block{rows, extent.columns, depth};
      const Matrix a_block = Access<Simd>::moved(a, i, k);
      const Strided b_block{b.data + k * b.row_stride, b.row_stride, b.column_stride};
      if (k == 0) {
        product_of_block<Simd, kOperation>(i, k, block, shape, left, a_block, b_block, c);
      } else {
        product_of_block<Simd, continued(kOperation)>(i, k, block, shape, left, a_block, b_block, c);
      }
    }
  }
}

/// C <- C +- A B, by kOperation (not the solving one).
template <class Simd, Operation kOperation>
void product(Extent extent, Shape shape, Left left, Columns a, Strided b, Target c) {
  /// Copying A pays from about here; measured.
  constexpr std::size_t kLargeRows = 192, kManyColumns = 24;
  if (extent.rows >= kLargeRows && extent.columns >= kManyColumns) {
    product_of_rows<Simd, kOperation>(0, extent.rows, extent, shape, left, a, b, c);
  } else {
    product_in_place<Simd, kOperation>(extent, shape, left, a, b, c);
  }
}

}  // namespace radioslam::dense
