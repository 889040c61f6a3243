#include "radioslam/graph/distributed/information_code.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <numeric>
#include <set>
#include <string_view>

namespace radioslam {
namespace {

/// Entries of unit rows are multiples of this.
constexpr double kUnit = 1.0 / ((1 << 23) - 1);
constexpr std::size_t kEntryBytes = 3;
/// A pivot below this share of its diagonal entry is none: the direction is free.
constexpr double kFreePivot = 1e-13;
/// A product may have so many blocks per block of its factor, and so many in any case.
constexpr std::size_t kProductGrowth = 4, kFreeProduct = 1024;

/// L with L L^T = A, columns of free directions zero.
Eigen::MatrixXd semidefinite_factor(const Eigen::MatrixXd& a) {
  Eigen::MatrixXd l = a.triangularView<Eigen::Lower>();
  const Eigen::Index n = a.rows();
  for (Eigen::Index k = 0; k < n; ++k) {
    if (l(k, k) <= kFreePivot * a(k, k) || !(l(k, k) > 0)) {
      l.col(k).tail(n - k).setZero();
      continue;
    }
    l(k, k) = std::sqrt(l(k, k));
    l.col(k).tail(n - k - 1) /= l(k, k);
    for (Eigen::Index c = k + 1; c < n; ++c)
      if (l(c, k) != 0) l.col(c).tail(n - c) -= l(c, k) * l.col(k).tail(n - c);
  }
  return l;
}

void write_entry(WireWriter& out, double value) {
  const auto q = static_cast<std::int32_t>(std::lround(std::clamp(value, -1.0, 1.0) / kUnit));
  for (unsigned k = 0; k < kEntryBytes; ++k)
    out.byte(static_cast<std::uint8_t>(static_cast<std::uint32_t>(q) >> (8 * k)));
}
double read_entry(WireReader& in) {
  std::uint32_t bits = 0;
  for (unsigned k = 0; k < kEntryBytes; ++k) bits |= std::uint32_t{in.byte()} << (8 * k);
  const auto q = static_cast<std::int32_t>(bits << 8U) >> 8;  // with the sign
  return q * kUnit;
}

/// Calls body(row, column) for the entries of a block that are on or below the diagonal.
template <class Body>
void for_each_entry(const BlockInformation::Place& place, Eigen::Index block, const Body& body) {
  for (Eigen::Index c = 0; c < block; ++c)
    for (Eigen::Index r = place.row == place.column ? c : 0; r < block; ++r) body(r, c);
}

bool is_set(std::string_view bits, std::size_t place) {
  return (static_cast<unsigned char>(bits[place / 8]) >> (place % 8) & 1U) != 0;
}

/// The blocks of a lower triangle with an entry above `zero`.
BlockInformation blocks_of(BlockInformation::Form form, const Eigen::MatrixXd& matrix, Eigen::Index block,
                           double zero) {
  BlockInformation out(form, matrix.rows() / block, block);
  for (Eigen::Index j = 0; j < out.blocks(); ++j)
    for (Eigen::Index i = j; i < out.blocks(); ++i) {
      const auto there = matrix.block(i * block, j * block, block, block);
      if (!(there.cwiseAbs().maxCoeff() <= zero))
        out.add({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)}) = there;
    }
  return out;
}

/// Blocks of the Cholesky factor.
std::size_t blocks_with_fill(const BlockInformation& matrix) {
  std::vector<std::set<std::uint32_t>> below(static_cast<std::size_t>(matrix.blocks()));
  for (const auto& place : matrix.places())
    if (place.row > place.column) below[place.column].insert(place.row);
  std::size_t blocks = 0;
  for (auto& rows : below) {  // what eliminating a column leaves goes to the first row below it
    blocks += rows.size() + 1;
    if (rows.empty()) continue;
    auto& parent = below[*rows.begin()];
    parent.insert(std::next(rows.begin()), rows.end());
  }
  return blocks;
}

/// A bit per block on or below the diagonal, by columns: whether it is there.
void write_places(WireWriter& out, const BlockInformation& blocks) {
  const auto n = static_cast<std::size_t>(blocks.blocks());
  std::vector<std::uint8_t> bits((n * (n + 1) / 2 + 7) / 8, 0);
  for (const auto& [row, column] : blocks.places()) {
    const std::size_t place = column * n - std::size_t{column} * (std::size_t{column} + 1) / 2 + row;
    bits[place / 8] = static_cast<std::uint8_t>(bits[place / 8] | 1U << (place % 8));
  }
  for (const std::uint8_t byte : bits) out.byte(byte);
}

template <class WriteEntry>
void write_blocks(WireWriter& out, const BlockInformation& blocks, const WriteEntry& write_entry) {
  write_places(out, blocks);
  for (std::size_t k = 0; k < blocks.places().size(); ++k) {
    const auto block = blocks.block(k);
    for_each_entry(blocks.places()[k], block.rows(),
                   [&](Eigen::Index r, Eigen::Index c) { write_entry(block(r, c)); });
  }
}

/// Zero blocks where the bytes do not hold as many entries as the bits say.
std::size_t count_blocks(WireReader& in, std::string_view there, Eigen::Index blocks, std::size_t whole,
                         std::size_t on_diagonal) {
  std::size_t count = 0, place = 0, bytes = 0;
  for (Eigen::Index j = 0; j < blocks; ++j)
    for (Eigen::Index i = j; i < blocks; ++i, ++place)
      if (is_set(there, place)) {
        ++count;
        bytes += i == j ? on_diagonal : whole;
      }
  if (bytes > in.left()) in.refuse();
  return in.good() ? count : 0;
}

}  // namespace

// ---- blocks ----

BlockInformation::BlockInformation(const Eigen::MatrixXd& matrix, Eigen::Index block)
    : BlockInformation(blocks_of(Form::kMatrix, matrix, block, 0)) {}

void BlockInformation::reserve(std::size_t blocks) {
  places_.reserve(blocks);
  values_.reserve(blocks * scalars());
}

BlockInformation::Block BlockInformation::add(Place place) {
  places_.push_back(place);
  values_.resize(values_.size() + scalars(), 0.0);
  return {values_.data() + values_.size() - scalars(), block_, block_};
}

std::vector<std::size_t> BlockInformation::column_begins() const {
  std::vector<std::size_t> begins(static_cast<std::size_t>(blocks_) + 1, 0);
  for (const Place& place : places_) ++begins[place.column + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  return begins;
}

/// Column c of the product: row c of the factor times the parts of its columns from there down.
BlockInformation BlockInformation::matrix() const {
  if (form_ == Form::kMatrix) return *this;
  const std::vector<std::size_t> begins = column_begins();
  std::vector<std::vector<std::size_t>> of_row(static_cast<std::size_t>(blocks_));
  for (std::size_t k = 0; k < places_.size(); ++k) of_row[places_[k].row].push_back(k);
  BlockInformation product(Form::kMatrix, blocks_, block_);
  std::vector<bool> there(of_row.size(), false);
  std::vector<std::size_t> slot(of_row.size());
  for (std::uint32_t c = 0; c < of_row.size(); ++c) {
    const auto for_each_term = [&](const auto& body) {
      for (const std::size_t k : of_row[c])
        for (std::size_t m = k; m < begins[places_[k].column + 1]; ++m) body(k, m, places_[m].row);
    };
    for_each_term([&](std::size_t, std::size_t, std::uint32_t row) { there[row] = true; });
    for (std::uint32_t row = c; row < there.size(); ++row)
      if (there[row]) {
        slot[row] = product.places_.size();
        product.add({row, c});
        there[row] = false;
      }
    for_each_term([&](std::size_t k, std::size_t m, std::uint32_t row) {
      Block sum(product.values_.data() + slot[row] * scalars(), block_, block_);
      sum += block(m).lazyProduct(block(k).transpose());
    });
  }
  return product;
}

Eigen::MatrixXd BlockInformation::dense() const {
  const BlockInformation whole = matrix();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(blocks_ * block_, blocks_ * block_);
  for (std::size_t k = 0; k < whole.places_.size(); ++k)
    dense.block(whole.places_[k].row * block_, whole.places_[k].column * block_, block_, block_) =
        whole.block(k);
  return dense.selfadjointView<Eigen::Lower>();
}

/// Counts them with a bit per pair of blocks.
bool BlockInformation::has_small_product() const {
  constexpr std::size_t kBits = 64;
  const auto n = static_cast<std::size_t>(blocks_), words = (n + kBits - 1) / kBits;
  const std::vector<std::size_t> begins = column_begins();
  std::vector<std::uint64_t> there(n * words, 0), column(words);
  for (std::size_t j = 0; j < n; ++j) {
    std::fill(column.begin(), column.end(), 0);
    for (std::size_t k = begins[j]; k < begins[j + 1]; ++k)
      column[places_[k].row / kBits] |= std::uint64_t{1} << (places_[k].row % kBits);
    for (std::size_t k = begins[j]; k < begins[j + 1]; ++k)
      for (std::size_t w = places_[k].row / kBits; w < words; ++w)
        there[places_[k].row * words + w] |= column[w];
  }
  std::size_t blocks = 0;  // both triangles
  for (const std::uint64_t word : there) blocks += static_cast<std::size_t>(std::popcount(word));
  return blocks <= kProductGrowth * places_.size() + kFreeProduct;
}

// ---- bytes ----

namespace {

void write_plain(WireWriter& out, const BlockInformation& matrix) {
  out.byte(1);
  write_blocks(out, matrix, [&](double entry) { out.f64(entry); });
}

}  // namespace

void write_information(WireWriter& out, const BlockInformation& information) {
  const BlockInformation matrix = information.matrix();
  if (matrix.places().size() * sizeof(double) < blocks_with_fill(matrix) * kEntryBytes)
    return write_plain(out, matrix);
  Eigen::MatrixXd l = semidefinite_factor(matrix.dense());
  std::vector<float> scales;
  for (Eigen::Index k = 0; k < l.rows(); ++k) {
    scales.push_back(static_cast<float>(l.row(k).norm()));
    if (scales.back() > 0) l.row(k) /= static_cast<double>(scales.back());
  }
  const BlockInformation factor =
      blocks_of(BlockInformation::Form::kFactor, l, information.block_rows(), kUnit / 2);
  if (!factor.has_small_product()) return write_plain(out, matrix);
  out.byte(0);
  for (const float scale : scales) out.f32(scale);
  write_blocks(out, factor, [&](double entry) { write_entry(out, entry); });
}

BlockInformation read_information(WireReader& in, Eigen::Index blocks, Eigen::Index block) {
  using Form = BlockInformation::Form;
  const bool plain = in.byte() != 0;
  const std::size_t entry_bytes = plain ? sizeof(double) : kEntryBytes;
  Eigen::VectorXf scales = Eigen::VectorXf::Ones(blocks * block);
  if (!plain)
    for (float& scale : scales) scale = in.f32();
  const std::string_view there = in.take((static_cast<std::size_t>(blocks * (blocks + 1) / 2) + 7) / 8);
  if (!in.good()) return {};
  const auto entries = static_cast<std::size_t>(block * block);
  const auto triangle = static_cast<std::size_t>(block * (block + 1) / 2);
  BlockInformation information(plain ? Form::kMatrix : Form::kFactor, blocks, block);
  information.reserve(count_blocks(in, there, blocks, entries * entry_bytes, triangle * entry_bytes));
  std::size_t place = 0;
  for (Eigen::Index j = 0; j < blocks && in.good(); ++j)
    for (Eigen::Index i = j; i < blocks; ++i, ++place) {
      if (!is_set(there, place)) continue;
      const BlockInformation::Place at{static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j)};
      auto values = information.add(at);
      for_each_entry(at, block, [&](Eigen::Index r, Eigen::Index c) {
        values(r, c) = plain ? in.f64() : read_entry(in) * static_cast<double>(scales[i * block + r]);
        if (plain && i == j) values(c, r) = values(r, c);
      });
    }
  if (!plain && !information.has_small_product()) in.refuse();
  return information;
}

}  // namespace radioslam
