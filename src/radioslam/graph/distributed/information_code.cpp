#include "radioslam/graph/distributed/information_code.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <vector>

namespace radioslam {
namespace {

/// Entries of unit rows are multiples of this.
constexpr double kUnit = 1.0 / ((1 << 23) - 1);
constexpr std::size_t kEntryBytes = 3;
/// A pivot below this share of its diagonal entry is none: the direction is free.
constexpr double kFreePivot = 1e-13;

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

/// Calls body(row, column) for the entries of the block on or below the diagonal.
template <class Body>
void for_each_entry(Eigen::Index i, Eigen::Index j, Eigen::Index block, const Body& body) {
  for (Eigen::Index c = 0; c < block; ++c)
    for (Eigen::Index r = i == j ? c : 0; r < block; ++r) body(i * block + r, j * block + c);
}

/// Per block on or below the diagonal, by columns: whether it is there.
class BlockMap {
 public:
  BlockMap(const Eigen::MatrixXd& matrix, Eigen::Index block, double zero) : n_(matrix.rows() / block) {
    for (Eigen::Index j = 0; j < n_; ++j)
      for (Eigen::Index i = j; i < n_; ++i)
        there_.push_back(matrix.block(i * block, j * block, block, block).cwiseAbs().maxCoeff() > zero);
  }

  /// Blocks of the Cholesky factor.
  std::size_t blocks_with_fill() const {
    std::vector<std::set<Eigen::Index>> below(static_cast<std::size_t>(n_));
    std::size_t place = 0, blocks = 0;
    for (Eigen::Index j = 0; j < n_; ++j)
      for (Eigen::Index i = j; i < n_; ++i)
        if (there_[place++] && i > j) below[static_cast<std::size_t>(j)].insert(i);
    for (auto& rows : below) {  // what eliminating a column leaves goes to the first row below it
      blocks += rows.size() + 1;
      if (rows.empty()) continue;
      auto& parent = below[static_cast<std::size_t>(*rows.begin())];
      parent.insert(std::next(rows.begin()), rows.end());
    }
    return blocks;
  }
  std::size_t blocks() const {
    return static_cast<std::size_t>(std::count(there_.begin(), there_.end(), true));
  }

  void write(WireWriter& out) const {
    for (std::size_t k = 0; k < there_.size(); k += 8) {
      unsigned bits = 0;
      for (std::size_t b = k; b < std::min(k + 8, there_.size()); ++b) bits |= unsigned{there_[b]} << (b - k);
      out.byte(static_cast<std::uint8_t>(bits));
    }
  }
  bool operator[](std::size_t place) const { return there_[place]; }

 private:
  Eigen::Index n_;
  std::vector<bool> there_;
};

/// The matrix itself, in double precision: where the factor would fill up.
void write_plain(WireWriter& out, const Eigen::MatrixXd& information, Eigen::Index block,
                 const BlockMap& there) {
  there.write(out);
  std::size_t place = 0;
  for (Eigen::Index j = 0; j < information.rows() / block; ++j)
    for (Eigen::Index i = j; i < information.rows() / block; ++i)
      if (there[place++])
        for_each_entry(i, j, block, [&](Eigen::Index r, Eigen::Index c) { out.f64(information(r, c)); });
}

}  // namespace

void write_information(WireWriter& out, const Eigen::MatrixXd& information, Eigen::Index block) {
  const Eigen::Index n = information.rows() / block;
  const BlockMap blocks(information, block, 0);
  const bool plain = blocks.blocks() * sizeof(double) < blocks.blocks_with_fill() * kEntryBytes;
  out.byte(plain ? 1 : 0);
  if (plain) return write_plain(out, information, block, blocks);
  Eigen::MatrixXd l = semidefinite_factor(information);
  for (Eigen::Index k = 0; k < l.rows(); ++k) {
    const auto scale = static_cast<float>(l.row(k).norm());
    out.f32(scale);
    if (scale > 0) l.row(k) /= static_cast<double>(scale);
  }
  const BlockMap there(l, block, kUnit / 2);
  there.write(out);
  std::size_t place = 0;
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i)
      if (there[place++])
        for_each_entry(i, j, block, [&](Eigen::Index r, Eigen::Index c) { write_entry(out, l(r, c)); });
}

Eigen::MatrixXd read_information(WireReader& in, Eigen::Index blocks, Eigen::Index block) {
  const bool plain = in.byte() != 0;
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(blocks * block);
  if (!plain)
    for (double& s : scale) s = static_cast<double>(in.f32());
  const auto pairs = static_cast<std::size_t>(blocks * (blocks + 1) / 2);
  const std::string_view there = in.take((pairs + 7) / 8);
  if (!in.good()) return {};
  Eigen::MatrixXd l = Eigen::MatrixXd::Zero(scale.size(), scale.size());
  std::size_t place = 0;
  for (Eigen::Index j = 0; j < blocks && in.good(); ++j)
    for (Eigen::Index i = j; i < blocks; ++i, ++place)
      if ((static_cast<unsigned char>(there[place / 8]) >> (place % 8) & 1U) != 0)
        for_each_entry(i, j, block, [&](Eigen::Index r, Eigen::Index c) {
          l(r, c) = plain ? in.f64() : read_entry(in) * scale[r];
        });
  if (plain) return l.selfadjointView<Eigen::Lower>();
  return l.triangularView<Eigen::Lower>() * l.transpose();
}

}  // namespace radioslam
