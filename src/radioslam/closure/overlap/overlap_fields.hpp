// Fields of the messages of a distributed overlap search, in the bytes of base/wire.hpp: counts and indices
// as whole numbers, everything else as 64-bit reals, so that both ends compute with the same numbers; of
// symmetric matrices the lower triangle. One list of fields, `visit(self, visitor)`, serves writing and
// reading.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "radioslam/base/wire.hpp"

namespace radioslam {

/// What one robot knows of its relation to each other robot, and what these sent it; of the robot itself
/// empty.
struct OverlapShares {
  std::vector<std::string> own, heard;
};

class OverlapFieldWriter {
 public:
  void operator()(std::uint32_t value) { out_.whole(value); }
  void operator()(double value) { out_.f64(value); }
  template <int Rows, int Columns>
  void operator()(const Eigen::Matrix<double, Rows, Columns>& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) out_.f64(m.data()[i]);
  }
  template <class Derived>
  void symmetric(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      for (Eigen::Index i = j; i < m.rows(); ++i) out_.f64(m(i, j));
  }
  template <class Derived>
  void dense(const Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      for (Eigen::Index i = 0; i < m.rows(); ++i) out_.f64(m(i, j));
  }
  std::string take() { return out_.take(); }

 private:
  WireWriter out_;
};

/// Any bytes: after what is not there, or not finite, zeros.
class OverlapFieldReader {
 public:
  explicit OverlapFieldReader(std::string_view bytes) : in_(bytes) {}

  std::uint32_t number() { return in_.whole32(); }
  void operator()(std::uint32_t& value) { value = number(); }
  void operator()(double& value) { value = in_.f64(); }
  template <int Rows, int Columns>
  void operator()(Eigen::Matrix<double, Rows, Columns>& m) {
    for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = in_.f64();
  }
  template <class Derived>
  void symmetric(Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      for (Eigen::Index i = j; i < m.rows(); ++i) m(i, j) = m(j, i) = in_.f64();
  }
  template <class Derived>
  void dense(Eigen::MatrixBase<Derived>& m) {
    for (Eigen::Index j = 0; j < m.cols(); ++j)
      for (Eigen::Index i = 0; i < m.rows(); ++i) m(i, j) = in_.f64();
  }

  void refuse_unless(bool condition) {
    if (!condition) refuse();
  }
  void refuse() { in_.refuse(); }
  bool good() const { return in_.good(); }
  /// Whether everything was there and nothing else is.
  bool is_complete() const { return in_.good() && in_.empty(); }

 private:
  WireReader in_;
};

}  // namespace radioslam
