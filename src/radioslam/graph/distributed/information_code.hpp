// Bytes of a positive semidefinite matrix of blocks: its Cholesky factor with rows scaled to unit length, in
// three bytes an entry. Rounding the factor leaves weak directions what they are, where rounding the matrix
// itself would drown them in the strong ones (an entry's error is 1e-7 of the root of an eigenvalue instead
// of the largest eigenvalue), and what is read is semidefinite again.
// Blocks of zeros, which chains of odometry leave, take a bit each. Where the factor would have so many more
// blocks than the matrix that the matrix itself is shorter, or where its product would have (see below), it
// is sent instead, in double precision. Cost of reading: memory in proportion to the bytes, since blocks of
// zeros take none, and time too: the factor stays one until its product is asked for. A factor whose product
// has many more blocks than itself is refused; no Cholesky factor has, but for blocks that were rounded to
// zero.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "radioslam/base/wire.hpp"

namespace radioslam {

/// A symmetric matrix by its blocks on or below the diagonal that are not zero, or by those of a lower
/// triangular L with L L^T.
class BlockInformation {
 public:
  struct Place {
    std::uint32_t row = 0, column = 0;
  };
  enum class Form : std::uint8_t { kMatrix, kFactor };
  using Block = Eigen::Map<Eigen::MatrixXd>;
  using ConstBlock = Eigen::Map<const Eigen::MatrixXd>;

  BlockInformation() = default;
  /// Without blocks yet: `blocks` x `blocks` of `block` x `block` scalars.
  BlockInformation(Form form, Eigen::Index blocks, Eigen::Index block)
      : form_(form), blocks_(blocks), block_(block) {}
  /// Of a symmetric matrix.
  BlockInformation(const Eigen::MatrixXd& matrix, Eigen::Index block);

  Eigen::Index blocks() const { return blocks_; }
  Eigen::Index block_rows() const { return block_; }
  /// By columns, then rows.
  const std::vector<Place>& places() const { return places_; }
  ConstBlock block(std::size_t k) const { return {values_.data() + k * scalars(), block_, block_}; }
  void reserve(std::size_t blocks);
  /// Adds a block of zeros after those that are there.
  Block add(Place place);

  /// Multiplied out, where this is a factor.
  BlockInformation matrix() const;
  /// The same, with both triangles.
  Eigen::MatrixXd dense() const;
  /// Whether the product of a factor with its transpose has not many more blocks than the factor.
  bool has_small_product() const;

 private:
  std::size_t scalars() const { return static_cast<std::size_t>(block_ * block_); }
  std::vector<std::size_t> column_begins() const;

  Form form_ = Form::kMatrix;
  Eigen::Index blocks_ = 0, block_ = 0;
  std::vector<Place> places_;
  std::vector<double> values_;
};

void write_information(WireWriter& out, const BlockInformation& information);
/// Of `blocks` blocks of `block` rows. Refused (in.good()): what `write_information` did not write.
BlockInformation read_information(WireReader& in, Eigen::Index blocks, Eigen::Index block);

}  // namespace radioslam
